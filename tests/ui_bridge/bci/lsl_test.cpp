// Class probabilities from Lab Streaming Layer, by a liblsl of our own.
#include <dlfcn.h>

#include "tests/ui_bridge/bci/front_end_fixture.h"

namespace beckon::ui_bridge::bci {
namespace {

using ::testing::HasSubstr;

class LslTest : public FrontEndTest {
 protected:
  void SetUp() override {
    FrontEndTest::SetUp();
    library_ = dlopen(BECKON_STUB_LSL, RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library_, nullptr) << dlerror();
  }
  void TearDown() override {
    Call<void()>("stub_lose")();
    FrontEndTest::TearDown();
    EXPECT_EQ(Call<int32_t()>("stub_inlets")(), 0);
  }

  template <typename Function>
  Function* Call(const char* name) {
    return reinterpret_cast<Function*>(dlsym(library_, name));
  }
  void Offer(int channels) { Call<void(const char*, int32_t)>("stub_offer")("p300", channels); }
  void Push(const std::vector<double>& values, double age_s = 0) {
    Call<void(const double*, int32_t, double)>("stub_push")(
        values.data(), static_cast<int32_t>(values.size()), age_s);
  }
  static std::string Config(const std::string& library = BECKON_STUB_LSL) {
    return Quick() + "lsl = \"p300\"\nlsl_library = \"" + library + "\"\n";
  }

  void* library_ = nullptr;
};

TEST_F(LslTest, ASampleIsOfTheTrialInWhichItWasRecorded) {
  Offer(4);
  on_begun_ = [this] { Ask(1); };
  decode_ = [this](const msg::Stimulus& stimulus) {
    if (stimulus.query_id != 0) Push({0.1, 0.7, 0.1, 0.1});
  };
  ASSERT_TRUE(Start(Config()));
  Until([this] { return !answers_.empty(); });
  EXPECT_GT(answers_[0].likelihoods[1], 0.9);
}

TEST_F(LslTest, OneFromBeforeTheTrialIsRefused) {
  Offer(4);
  on_begun_ = [this] { Ask(1); };
  int pushed = 0;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id != 0 && pushed++ == 0) Push({0.01, 0.97, 0.01, 0.01}, 5);
  };
  ASSERT_TRUE(Start(Config()));
  Until([this] { return RefusedDecodings() == 1; });
  EXPECT_TRUE(answers_.empty());
}

TEST_F(LslTest, ALastChannelNamesTheTrial) {
  Offer(5);
  on_begun_ = [this] { Ask(1); };
  int asked = 0;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0) return;
    ++asked;
    const auto trial = static_cast<double>(stimulus.trial);
    Push({0.97, 0.01, 0.01, 0.01, trial - 1});
    Push({0.97, 0.01, 0.01, 0.01, NAN});
    Push({0.1, 0.1, 0.7, 0.1, trial}, 5);
  };
  ASSERT_TRUE(Start(Config()));
  Until([this] { return !answers_.empty(); });
  EXPECT_GT(answers_[0].likelihoods[2], 0.9);
  EXPECT_GE(RefusedDecodings(), asked);
}

TEST_F(LslTest, SamplesThatAreNoProbabilitiesAreRefused) {
  Offer(4);
  on_begun_ = [this] { Ask(1); };
  int asked = 0;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0 || ++asked > 1) return;
    Push({NAN, 0.5, 0.3, 0.2});
    Push({-1, 1, 0.5, 0.5});
    Push({30, 12, -4, 0.1});
  };
  ASSERT_TRUE(Start(Config()));
  Until([this] { return RefusedDecodings() == 3; });
  EXPECT_TRUE(answers_.empty());
}

TEST_F(LslTest, AStreamThatIsLostIsLookedForAgain) {
  Offer(4);
  on_begun_ = [this] { Ask(1); };
  bool lost = false;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0) return;
    if (!std::exchange(lost, true)) {
      Call<void()>("stub_lose")();
      loop_.After(kSecond / 2, [this] { Offer(4); });
      return;
    }
    Push({0.1, 0.7, 0.1, 0.1});
  };
  ASSERT_TRUE(Start(Config()));
  Until([this] { return !answers_.empty(); });
  EXPECT_GT(answers_[0].likelihoods[1], 0.9);
}

TEST_F(LslTest, WithoutALibraryTheStartFailsAndSaysWhatToDo) {
  for (const char* wrong : {"/nowhere/liblsl.so", BECKON_STUB_LSL_HALF}) {
    const auto started = Start(Config(wrong));
    ASSERT_FALSE(started);
    EXPECT_THAT(started.error().message, HasSubstr("[bci] lsl"));
  }
  EXPECT_THAT(Start(Config("/nowhere/liblsl.so")).error().message, HasSubstr("install liblsl"));
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
