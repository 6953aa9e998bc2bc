// The model file: what is written is read, and nothing else is.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "services/perception/categoriser.h"
#include "services/perception/model_file.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {
namespace {

const std::vector<uint8_t>& Bytes() {
  static const std::vector<uint8_t> bytes = SerialiseModel(TrainedOnShapes().model);
  return bytes;
}

TEST(ModelFile, ReadsBackWhatItWrote) {
  const Result<Model> model = ParseModel(Bytes(), "m");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(SerialiseModel(*model), Bytes());
  std::mt19937 random(3);
  const ShapeView view = RenderCategory("Box", random);
  EXPECT_EQ(Categoriser(*model).Categorise(view.view()).probabilities,
            Categoriser(TrainedOnShapes().model).Categorise(view.view()).probabilities);
}

TEST(ModelFile, RefusesEveryTruncation) {
  for (size_t length = 0; length < Bytes().size(); length += length < 200 ? 1 : 997) {
    const std::vector<uint8_t> part(Bytes().begin(),
                                    Bytes().begin() + static_cast<int64_t>(length));
    const Result<Model> model = ParseModel(part, "m");
    ASSERT_FALSE(model) << length;
    EXPECT_NE(model.error().message.find("beckon-train"), std::string::npos);
  }
}

TEST(ModelFile, RefusesEveryFlippedBit) {
  std::mt19937 random(1);
  for (int i = 0; i < 400; ++i) {
    std::vector<uint8_t> bytes = Bytes();
    const size_t at = i < 200 ? static_cast<size_t>(i) : random() % bytes.size();
    bytes[at] ^= static_cast<uint8_t>(1U << random() % 8);
    ASSERT_FALSE(ParseModel(bytes, "m")) << at;
  }
}

TEST(ModelFile, SurvivesAlteredContentWithARightChecksum) {
  // Recomputes the CRC as an attacker would: must be refused or usable, never crash.
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    std::vector<uint8_t> bytes = Bytes();
    const size_t at = 24 + (i < 150 ? static_cast<size_t>(i) : random() % (bytes.size() - 24));
    bytes[at] = static_cast<uint8_t>(random());
    uint32_t crc = 0xFFFFFFFF;  // CRC-32, bit by bit
    for (size_t k = 24; k < bytes.size(); ++k) {
      crc ^= bytes[k];
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320U : 0);
    }
    crc = ~crc;
    for (int k = 0; k < 4; ++k)
      bytes[20 + static_cast<size_t>(k)] = static_cast<uint8_t>(crc >> 8 * k);
    const Result<Model> model = ParseModel(bytes, "m");
    if (!model) {
      EXPECT_NE(model.error().message.find("rebuild"), std::string::npos);
    }
  }
}

TEST(ModelFile, SurvivesAlteredSections) {
  const std::vector<uint8_t> sections = ModelSections(TrainedOnShapes().model);
  ASSERT_EQ(WrapSections(sections), Bytes());
  std::mt19937 random(2);
  const ShapeView view = RenderCategory("Box", random);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    std::vector<uint8_t> altered = sections;
    altered[i < 300 ? static_cast<size_t>(i) : random() % altered.size()] =
        static_cast<uint8_t>(random());
    const Result<Model> model = ParseModel(WrapSections(altered), "m");
    if (model) {  // a number is another number: of no worth, but of no harm either
      EXPECT_FALSE(Categoriser(*model).Categorise(view.view()).probabilities.empty());
      continue;
    }
    ++refused;
    EXPECT_NE(model.error().message.find("rebuild"), std::string::npos);
  }
  EXPECT_GT(refused, 50);
  for (size_t length = 0; length < sections.size(); length += length < 200 ? 1 : 997) {
    const std::vector<uint8_t> part(sections.begin(),
                                    sections.begin() + static_cast<int64_t>(length));
    EXPECT_FALSE(ParseModel(WrapSections(part), "m")) << length;
  }
}

TEST(ModelFile, RefusesToWriteWhatItWouldNotRead) {
  Model model = TrainedOnShapes().model;
  model.deciders.front().temperature = 0;
  const std::string path = testing::TempDir() + "categoriser_model_test_refused.model";
  EXPECT_FALSE(WriteModelFile(path, model));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ModelFile, NamesAnotherVersion) {
  std::vector<uint8_t> bytes = Bytes();
  bytes[8] = 9;
  const Result<Model> model = ParseModel(bytes, "some.model");
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().message.find("format 9"), std::string::npos) << model.error().message;
  EXPECT_NE(model.error().message.find("some.model"), std::string::npos);
}

TEST(ModelFile, NamesAMissingFileAndReadsAWrittenOne) {
  const Result<Categoriser> none = Categoriser::Load("/nonexistent/x.model");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("/nonexistent/x.model"), std::string::npos);
  const std::string path = testing::TempDir() + "categoriser_model_test.model";
  ASSERT_TRUE(WriteModelFile(path, TrainedOnShapes().model));
  const Result<Categoriser> loaded = Categoriser::Load(path);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->categories(), (std::vector<std::string>{"Bowl", "Box", "Can"}));
  std::filesystem::remove(path);
}

TEST(Model, RefusesACueThatMeasuresOtherThings) {
  Model model = TrainedOnShapes().model;
  model.cues[0].name = "smell";
  EXPECT_FALSE(Validate(model));
  model = TrainedOnShapes().model;
  model.cues[0].encoder.vocabulary.conservativeResize(Eigen::NoChange, 5);
  EXPECT_FALSE(Validate(model));
  model = TrainedOnShapes().model;
  model.cues[1].classifier.coefficients(0, 0) = NAN;
  EXPECT_FALSE(Validate(model));
}

TEST(Model, RefusesADeciderThatDoesNotFit) {
  const Model good = TrainedOnShapes().model;
  ASSERT_TRUE(Validate(good));
  const auto refuses = [&good](auto spoil) {
    Model model = good;
    spoil(model);
    return !Validate(model);
  };
  EXPECT_TRUE(refuses([](Model& m) { m.deciders.clear(); }));
  EXPECT_TRUE(refuses([](Model& m) { m.deciders[0].cues.pop_back(); }));
  EXPECT_TRUE(refuses([](Model& m) { m.deciders[1].cues.back() = 9; }));
  EXPECT_TRUE(refuses([](Model& m) { std::swap(m.deciders[1].cues[0], m.deciders[1].cues[1]); }));
  EXPECT_TRUE(refuses([](Model& m) { m.deciders[0].svm = {}; }));
  EXPECT_TRUE(refuses([](Model& m) { m.deciders[0].threshold = NAN; }));
  EXPECT_TRUE(refuses([](Model& m) { m.deciders[0].correction = m.deciders[1].svm; }));
  EXPECT_TRUE(refuses([](Model& m) { m.unknown_prior = 0; }));
}

}  // namespace
}  // namespace beckon::perception
