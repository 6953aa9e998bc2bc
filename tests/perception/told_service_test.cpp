// LABEL on an in-process bus: what the user said shows in the next scenes, over restarts too.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <functional>

#include "lcmtypes/frame_image.h"
#include "services/perception/service.h"
#include "tests/intention/temporary_folder.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

class ToldServiceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto bus = Bus::Open("memq://");
    ASSERT_TRUE(bus) << bus.error().message;
    bus_ = *std::move(bus);
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    bus_->Subscribe<msg::Scene>([this](msg::Scene scene) {
      scene_ = std::move(scene);
      ++n_scenes_;
      loop_.Stop();
    });
    world_ = ThreeBoxes();
    world_.boxes[1].colour = {220, 30, 30};
    world_.boxes[2].colour = {30, 220, 30};
    world_.boxes[3].colour = {30, 30, 220};
    Restart();
  }
  /// A new process: what is not in the folder is forgotten.
  void Restart() {
    service_.reset();
    service_ = std::make_unique<Service>(*bus_, loop_, PerceiverConfig{}, std::nullopt,
                                         ToldStoreConfig{.folder = folder_path_});
  }
  const msg::Scene& See() {
    msg::Frame frame;
    frame.seq = ++seq_;
    frame.utime = 1'000'000 * seq_;
    frame.source = "test";
    EXPECT_TRUE(EncodeImage(world_.Render(), 0.0001, 95, frame));
    EXPECT_TRUE(bus_->Publish(frame));
    const int before = n_scenes_;
    const auto timer = loop_.After(10 * kSecond, [this] { loop_.Stop(); });
    loop_.Run();
    loop_.Cancel(timer);
    EXPECT_EQ(n_scenes_, before + 1);
    return scene_;
  }
  msg::Label LabelOf(int object, const std::string& category, Utime utime = 1) const {
    msg::Label label;
    label.utime = utime;
    label.label_id = "s/label/" + std::to_string(object);
    label.session_id = "s";
    label.category = category;
    label.source = scene_.source;
    label.scene_seq = scene_.seq;
    label.scene_utime = scene_.utime;
    label.object_id = scene_.objects[object].id;
    return label;
  }
  /// Published; waits for the scene that shows it.
  void Send(const msg::Label& label) {
    const int before = n_scenes_;
    Await([&] { return n_scenes_ > before; }, label);
    EXPECT_EQ(n_scenes_, before + 1);
  }
  /// Published; waits until the service received it. It makes no scene.
  void SendInVain(const msg::Label& label) {
    const int64_t before = service_->counters().labels;
    Await([&] { return service_->counters().labels > before; }, label);
  }
  void Await(const std::function<bool()>& done, const msg::Label& label) {
    ASSERT_TRUE(bus_->Publish(label));
    const auto poll = loop_.Every(1000, [&] {
      if (done()) loop_.Stop();
    });
    const auto timer = loop_.After(10 * kSecond, [this] { loop_.Stop(); });
    loop_.Run();
    loop_.Cancel(poll);
    loop_.Cancel(timer);
  }
  const msg::SceneObject& Object(int id) const {
    return *std::ranges::find(scene_.objects, id, &msg::SceneObject::id);
  }
  int Examples() const {
    int n = 0;
    if (!std::filesystem::exists(folder_path_)) return 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_path_))
      n += entry.path().extension() == ".pcd" ? 1 : 0;
    return n;
  }

  RunLoop loop_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Service> service_;
  BoxWorld world_;
  intention::TemporaryFolder folder_;
  std::string folder_path_ = (folder_ / "examples").string();
  msg::Scene scene_;
  int n_scenes_ = 0;
  int64_t seq_ = 0;
};

TEST_F(ToldServiceTest, TheNextScenesShowWhatTheUserSaid) {
  See();
  const int id = scene_.objects[0].id, other = scene_.objects[1].id;
  EXPECT_TRUE(Object(id).ask_user);
  Send(LabelOf(0, "Mug"));
  for (int frame = 0; frame < 3; ++frame) {
    if (frame > 0) See();
    EXPECT_EQ(Object(id).category, "Mug");
    EXPECT_FALSE(Object(id).ask_user);
    EXPECT_GT(Object(id).probabilities.front().probability, 0.9f);
    EXPECT_LT(Object(id).probabilities.front().probability, 1.0f);
    EXPECT_TRUE(Object(other).ask_user);
  }
  EXPECT_EQ(service_->counters().labels_taken, 1);
  EXPECT_EQ(service_->counters().computed, 2);
  EXPECT_EQ(Examples(), 1);
}

TEST_F(ToldServiceTest, ARepeatedLabelChangesNothing) {
  See();
  const msg::Label label = LabelOf(0, "Mug");
  Send(label);
  for (int i = 0; i < 4; ++i) SendInVain(label);
  See();
  SendInVain(label);
  See();
  EXPECT_EQ(service_->counters().labels, 6);
  EXPECT_EQ(service_->counters().labels_taken, 1);
  EXPECT_EQ(Examples(), 1);
}

TEST_F(ToldServiceTest, UndoTakesItBackAndALateCopyDoesNotBringItAgain) {
  See();
  const int id = scene_.objects[0].id;
  const msg::Label label = LabelOf(0, "Mug", 5);
  Send(label);
  msg::Label back = label;
  back.state = msg::LabelState::kRetracted;
  back.utime = 6;
  Send(back);
  EXPECT_TRUE(Object(id).ask_user);
  EXPECT_EQ(Examples(), 0);
  SendInVain(label);
  See();
  EXPECT_TRUE(Object(id).ask_user);
  Send(LabelOf(0, "Tin", 7));
  EXPECT_EQ(Object(id).category, "Tin");
  EXPECT_EQ(Examples(), 1);
}

TEST_F(ToldServiceTest, AnotherAnswerTakesThePlaceOfTheFirst) {
  See();
  const int id = scene_.objects[0].id;
  Send(LabelOf(0, "Mug", 5));
  See();
  msg::Label later = LabelOf(0, "Tin", 9);
  later.label_id = "s2/label/0";
  later.object_id = id;
  Send(later);
  See();
  EXPECT_EQ(Object(id).category, "Tin");
  EXPECT_EQ(Examples(), 1);
  EXPECT_TRUE(std::filesystem::exists(folder_path_ + "/Tin"));
}

TEST_F(ToldServiceTest, AfterARestartTheObjectIsKnownAgain) {
  See();
  Send(LabelOf(0, "Mug"));
  const Eigen::Vector3d place_W = scene_.objects[0].centroid_W;
  See();
  ASSERT_EQ(Examples(), 1);
  Restart();
  See();
  EXPECT_EQ(service_->counters().examples, 1);
  for (const auto& object : scene_.objects) {
    const bool is_it = (object.centroid_W - place_W).norm() < 0.01;
    EXPECT_EQ(object.category == "Mug", is_it);
    EXPECT_EQ(object.ask_user, !is_it);
  }
}

TEST_F(ToldServiceTest, ALabelOfAnEarlierRunIsRefused) {
  See();
  See();
  const msg::Label label = LabelOf(0, "Mug");
  Restart();
  See();
  SendInVain(label);
  See();
  EXPECT_EQ(service_->counters().labels_stale, 1);
  EXPECT_EQ(service_->counters().labels_taken, 0);
  for (const auto& object : scene_.objects) EXPECT_EQ(object.category, msg::kUnknownCategory);
}

TEST_F(ToldServiceTest, AnObjectThatIsNotThereIsCounted) {
  See();
  msg::Label label = LabelOf(0, "Mug");
  label.object_id = 99;
  SendInVain(label);
  See();
  EXPECT_EQ(service_->counters().labels_unmatched, 1);
}

TEST_F(ToldServiceTest, AFullDiskIsCountedAndWhatWasSaidHolds) {
  See();
  const int id = scene_.objects[0].id;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, SIG_IGN);
  const rlimit full{100, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  Send(LabelOf(0, "Mug"));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(service_->counters().examples_failed, 1);
  EXPECT_EQ(service_->counters().examples_kept, 0);
  EXPECT_EQ(Object(id).category, "Mug");
  EXPECT_FALSE(Object(id).ask_user);
  EXPECT_EQ(Examples(), 0);
}

TEST_F(ToldServiceTest, AFolderOfNoUseIsCountedAndPerceptionLivesOn) {
  folder_path_ = "/dev/null/examples";
  Restart();
  EXPECT_EQ(service_->counters().examples_failed, 1);
  See();
  const int id = scene_.objects[0].id;
  Send(LabelOf(0, "Mug"));
  See();
  EXPECT_EQ(Object(id).category, "Mug");
}

}  // namespace
}  // namespace beckon::perception
