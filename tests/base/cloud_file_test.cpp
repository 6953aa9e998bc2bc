// Cloud files: every format in, what is damaged refused with the file's name.
#include "services/base/cloud_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <liblzf/lzf.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <tuple>

#include "services/base/pcd_file.h"
#include "services/base/ply_file.h"

namespace beckon {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class CloudFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("cloud_file_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Put(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  Result<Cloud> Read(const std::string& name, const std::string& bytes) {
    return ReadCloudFile(Put(name, bytes));
  }
  /// The error message of reading such a file; fails where it reads.
  std::string Refusal(const std::string& name, const std::string& bytes) {
    const auto cloud = Read(name, bytes);
    EXPECT_FALSE(cloud.ok()) << name;
    if (cloud.ok()) return "";
    EXPECT_THAT(cloud.error().message, HasSubstr(name));
    EXPECT_EQ(cloud.error().message.find('\n'), std::string::npos);
    return cloud.error().message;
  }

  fs::path folder_;
};

template <typename T>
void Append(std::string& bytes, T value, bool swap = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (swap) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string PcdHeader(const std::string& data, int width = 2, int height = 1) {
  const std::string n = std::to_string(width * height);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS label x skipped y z rgb\nSIZE 2 4 1 8 4 4\nTYPE U F I F "
         "F F\n"
         "COUNT 1 1 3 1 1 1\nWIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

/// Two points: (1 2 3), red 10 green 20 blue 30, label 7; then one without a position.
std::string PcdRows() {
  std::string rows;
  for (int i = 0; i < 2; ++i) {
    Append<uint16_t>(rows, 7);
    Append<float>(rows, i == 0 ? 1 : kNan);
    rows += "abc";
    Append<double>(rows, i == 0 ? 2 : kNan);
    Append<float>(rows, i == 0 ? 3 : kNan);
    Append<uint32_t>(rows, 0x0a141e);
  }
  return rows;
}

std::string PcdColumns() {
  std::string columns;
  for (int i = 0; i < 2; ++i) Append<uint16_t>(columns, 7);
  Append<float>(columns, 1), Append<float>(columns, kNan);
  columns += "abcabc";
  Append<double>(columns, 2), Append<double>(columns, kNan);
  Append<float>(columns, 3), Append<float>(columns, kNan);
  for (int i = 0; i < 2; ++i) Append<uint32_t>(columns, 0x0a141e);
  return columns;
}

std::string CompressedPcd() {
  std::string columns = PcdColumns(), packed(columns.size() + 64, '\0');
  const unsigned size = lzf_compress(columns.data(), columns.size(), packed.data(), packed.size());
  std::string bytes = PcdHeader("binary_compressed");
  Append<uint32_t>(bytes, size);
  Append<uint32_t>(bytes, columns.size());
  return bytes + packed.substr(0, size);
}

std::string AsciiPcd() {
  // The bits of 0x0a141e as a float.
  return PcdHeader("ascii") + "7 1 97 98 99 2.0 3e0 9.255717e-40\n7 nan 97 98 99 nan nan 660510\n";
}

std::string AsciiPly() {
  return "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement camera 1\r\nproperty float "
         "view_px\r\n"
         "element vertex 2\r\nproperty float x\r\nproperty list uchar int extra\r\nproperty double "
         "y\r\n"
         "property float z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n"
         "property ushort label\r\nelement face 1\r\nproperty list uchar int "
         "vertex_indices\r\nend_header\r\n"
         "0.5\r\n1 2 9 9 2 3 10 20 30 7\r\nnan 0 nan nan 10 20 30 7\r\n3 0 1 0\r\n";
}

std::string BinaryPly(bool big) {
  std::string bytes =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\nelement camera 1\nproperty float view_px\nelement vertex 2\n"
      "property float x\nproperty list uchar int extra\nproperty double y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty ushort label\n"
      "end_header\n";
  Append<float>(bytes, 0.5f, big);
  for (int i = 0; i < 2; ++i) {
    Append<float>(bytes, i == 0 ? 1 : kNan, big);
    Append<uint8_t>(bytes, i == 0 ? 1 : 0);
    if (i == 0) Append<int32_t>(bytes, 99, big);
    Append<double>(bytes, i == 0 ? 2 : kNan, big);
    Append<float>(bytes, i == 0 ? 3 : kNan, big);
    bytes += "\x0a\x14\x1e";
    Append<uint16_t>(bytes, 7, big);
  }
  return bytes;
}

void ExpectTwoPoints(const Result<Cloud>& cloud) {
  ASSERT_TRUE(cloud.ok()) << cloud.error().message;
  ASSERT_EQ(cloud->points.size(), 2u);
  EXPECT_EQ(cloud->width, 2);
  EXPECT_EQ(cloud->height, 1);
  EXPECT_EQ(cloud->points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(std::isnan(cloud->points[1].x()) && std::isnan(cloud->points[1].z()));
  ASSERT_EQ(cloud->colours.size(), 2u);
  EXPECT_EQ(cloud->colours[0], (Rgb{10, 20, 30}));
  ASSERT_EQ(cloud->labels.size(), 2u);
  EXPECT_EQ(cloud->labels[0], 7u);
}

TEST_F(CloudFileTest, ReadsEveryFormatAlike) {
  ExpectTwoPoints(Read("a.pcd", AsciiPcd()));
  ExpectTwoPoints(Read("b.PCD", PcdHeader("binary") + PcdRows()));
  ExpectTwoPoints(Read("c.pcd", CompressedPcd()));
  ExpectTwoPoints(Read("d.ply", AsciiPly()));
  ExpectTwoPoints(Read("e.ply", BinaryPly(false)));
  ExpectTwoPoints(Read("f.ply", BinaryPly(true)));
}

TEST_F(CloudFileTest, ReadsXyzText) {
  const auto cloud = Read("a.xyz", "# x y z\n1 2 3\n\n4,5,6,0.1\r\n7;8;9");
  ASSERT_TRUE(cloud.ok()) << cloud.error().message;
  ASSERT_EQ(cloud->points.size(), 3u);
  EXPECT_EQ(cloud->points[2], Eigen::Vector3f(7, 8, 9));
  EXPECT_THAT(Refusal("b.xyz", "1 2 3\n4 five 6\n"), HasSubstr("line 2"));
  EXPECT_THAT(Refusal("c.xyz", "1 2\n"), HasSubstr("three numbers"));
}

TEST_F(CloudFileTest, WritesWhatItReads) {
  Cloud cloud;
  cloud.width = 3;
  cloud.height = 2;
  for (int i = 0; i < 6; ++i) {
    cloud.points.emplace_back(i, -i, 1);
    cloud.colours.push_back({uint8_t(i), uint8_t(255 - i), 128});
    cloud.labels.push_back(uint32_t(i * 10));
  }
  cloud.points[4].setConstant(kNan);
  const std::string path = (folder_ / "out.pcd").string();
  ASSERT_TRUE(WritePcdFile(path, cloud).ok());
  const auto again = ReadCloudFile(path);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_TRUE(again->organised());
  EXPECT_EQ(again->width, 3);
  EXPECT_EQ(again->colours, cloud.colours);
  EXPECT_EQ(again->labels, cloud.labels);
  EXPECT_EQ(again->points[5], cloud.points[5]);
  EXPECT_TRUE(std::isnan(again->points[4].y()));
  cloud.labels.pop_back();
  EXPECT_FALSE(WritePcdFile(path, cloud).ok());
  cloud.labels.clear();
  EXPECT_FALSE(WritePcdFile((folder_ / "no" / "out.pcd").string(), cloud).ok());
}

TEST_F(CloudFileTest, OrganisesPlyByItsViewport) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "element camera 1\nproperty int viewportx\nproperty int viewporty\nend_header\n";
  for (int i = 0; i < 6; ++i) text += "1 2 3\n";
  const auto organised = Read("a.ply", text + "3 2\n");
  ASSERT_TRUE(organised.ok());
  EXPECT_EQ(organised->width, 3);
  EXPECT_EQ(organised->height, 2);
  const auto list = Read("b.ply", text + "6 1\n");
  ASSERT_TRUE(list.ok());
  EXPECT_FALSE(list->organised());
}

Result<Cloud> Parse(const std::string& name, std::string_view bytes) {
  return name.ends_with(".pcd") ? cloud::ParsePcd(bytes) : cloud::ParsePly(bytes);
}

TEST(CloudBytesTest, RefusesEveryTruncation) {
  // In text the last number may be shorter without being wrong.
  const std::tuple<std::string, std::string, size_t> files[] = {
      {"a.pcd", PcdHeader("binary") + PcdRows(), 1},
      {"b.pcd", CompressedPcd(), 1},
      {"c.pcd", AsciiPcd(), 8},
      {"d.ply", BinaryPly(false), 1},
      {"e.ply", BinaryPly(true), 1},
      {"f.ply", AsciiPly(), 4}};
  for (const auto& [name, bytes, spare] : files) {
    for (size_t n = 0; n + spare <= bytes.size(); ++n) {
      const auto cloud = Parse(name, std::string_view(bytes).substr(0, n));
      EXPECT_FALSE(cloud.ok()) << name << " cut to " << n << " bytes";
    }
  }
}

TEST(CloudBytesTest, SurvivesAnyDamage) {
  std::mt19937 random(7);
  const std::pair<std::string, std::string> files[] = {{"a.pcd", PcdHeader("binary") + PcdRows()},
                                                       {"b.pcd", CompressedPcd()},
                                                       {"c.pcd", AsciiPcd()},
                                                       {"d.ply", BinaryPly(false)},
                                                       {"e.ply", AsciiPly()}};
  for (const auto& [name, bytes] : files) {
    for (int round = 0; round < 20'000; ++round) {
      std::string damaged = bytes;
      for (uint32_t k = random() % 4 + 1; k > 0; --k) {
        damaged[random() % damaged.size()] = static_cast<char>(random());
      }
      const auto cloud = Parse(name, damaged);
      if (!cloud) continue;
      EXPECT_EQ(cloud->points.size(), size_t(cloud->width) * size_t(cloud->height));
      EXPECT_TRUE(cloud->labels.empty() || cloud->labels.size() == cloud->points.size());
      EXPECT_TRUE(cloud->colours.empty() || cloud->colours.size() == cloud->points.size());
    }
  }
}

TEST_F(CloudFileTest, RefusesSizesThatTheFileCannotHold) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string pcd = PcdHeader("binary") + PcdRows();
  EXPECT_THAT(
      Refusal("a.pcd", with(with(pcd, "WIDTH 2", "WIDTH 40000000"), "POINTS 2", "POINTS 40000000")),
      HasSubstr("truncated"));
  EXPECT_THAT(Refusal("b.pcd", with(pcd, "WIDTH 2", "WIDTH 99999999999")), HasSubstr("50 million"));
  EXPECT_THAT(Refusal("c.pcd", with(pcd, "HEIGHT 1", "HEIGHT 3")), HasSubstr("POINTS"));
  EXPECT_THAT(Refusal("d.pcd", with(pcd, "WIDTH 2", "WIDTH -2")), HasSubstr("header"));
  EXPECT_THAT(Refusal("e.pcd", with(pcd, "COUNT 1 1 3", "COUNT 1 1 99999999999999999999")),
              HasSubstr("COUNT"));
  EXPECT_THAT(Refusal("f.pcd", with(pcd, "SIZE 2", "SIZE 3")), HasSubstr("SIZE"));
  EXPECT_THAT(Refusal("g.pcd", with(pcd, " y ", " w ")), HasSubstr("x, y and z"));
  EXPECT_THAT(Refusal("h.pcd", with(pcd, "DATA binary", "DATA zipped")), HasSubstr("DATA"));
  const std::string ply = BinaryPly(false);
  EXPECT_THAT(Refusal("i.ply", with(ply, "vertex 2", "vertex 49000000")), HasSubstr("truncated"));
  EXPECT_THAT(Refusal("j.ply", with(ply, "camera 1", "camera 18446744073709551615")),
              HasSubstr("truncated"));
  EXPECT_THAT(Refusal("k.ply", with(ply, "float x", "quad x")), HasSubstr("property"));
  EXPECT_THAT(Refusal("l.ply", with(ply, "vertex 2", "vertices 2")), HasSubstr("vertex"));
  std::string bomb = PcdHeader("binary_compressed", 40000, 1000);
  Append<uint32_t>(bomb, 4);
  Append<uint32_t>(bomb, 40000u * 1000u * 25u);
  EXPECT_THAT(Refusal("m.pcd", bomb + "abcd"), HasSubstr("damaged"));
}

TEST_F(CloudFileTest, RefusesWhatIsNoCloud) {
  EXPECT_THAT(ReadCloudFile((folder_ / "missing.pcd").string()).error().message,
              HasSubstr("missing.pcd"));
  EXPECT_FALSE(ReadCloudFile(folder_.string()).ok());
  fs::create_directories(folder_ / "folder.pcd");
  EXPECT_THAT(ReadCloudFile((folder_ / "folder.pcd").string()).error().message,
              HasSubstr("regular file"));
  EXPECT_THAT(Refusal("empty.ply", ""), HasSubstr("empty"));
  EXPECT_THAT(Refusal("a.jpg", "whatever"), HasSubstr(".pcd"));
  EXPECT_THAT(Refusal("text.pcd", "This is no cloud.\n"), HasSubstr("keyword"));
  EXPECT_THAT(Refusal("text.ply", "This is no cloud.\n"), HasSubstr("ply"));
  EXPECT_THAT(Refusal("nan.xyz", "nan nan nan\nnan 1 2\n1e30 0 0\n"), HasSubstr("finite"));
  std::string zero = PcdHeader("ascii");
  zero.replace(zero.find("WIDTH 2"), 7, "WIDTH 0").replace(zero.find("POINTS 2"), 8, "POINTS 0");
  EXPECT_THAT(Refusal("zero.pcd", zero), HasSubstr("empty"));
}

}  // namespace
}  // namespace beckon
