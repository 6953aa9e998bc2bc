// Every message: what is sent arrives, what is damaged is refused, nothing crashes.
#include "lcmtypes/codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <beckon/answer_t.hpp>
#include <beckon/decoding_t.hpp>
#include <beckon/frame_t.hpp>
#include <beckon/highlight_t.hpp>
#include <beckon/history_t.hpp>
#include <beckon/interface_t.hpp>
#include <beckon/label_t.hpp>
#include <beckon/lease_t.hpp>
#include <beckon/poses_t.hpp>
#include <beckon/profile_t.hpp>
#include <beckon/query_t.hpp>
#include <beckon/scene_t.hpp>
#include <beckon/session_t.hpp>
#include <beckon/status_t.hpp>
#include <beckon/stimulus_t.hpp>
#include <beckon/task_status_t.hpp>
#include <beckon/task_t.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "tests/lcmtypes/examples.h"

namespace beckon {
namespace {

using ::testing::HasSubstr;

using Bytes = std::vector<uint8_t>;

/// Calls check(value, bytes) for a valid value of each type.
template <typename Check>
void ForEachType(Check check) {
  std::apply(
      [&](const auto&... example) {
        (
            [&] {
              const auto bytes = Codec<std::decay_t<decltype(example)>>::Encode(example);
              ASSERT_TRUE(bytes.ok()) << bytes.error().message;
              SCOPED_TRACE(Codec<std::decay_t<decltype(example)>>::kChannel);
              check(example, *bytes);
            }(),
            ...);
      },
      msg::AllExamples());
}

TEST(Codec, WhatIsSentArrives) {
  ForEachType([](const auto& value, const Bytes& bytes) {
    using T = std::decay_t<decltype(value)>;
    const auto decoded = Codec<T>::Decode(bytes);
    ASSERT_TRUE(decoded.ok()) << decoded.error().message;
    const auto again = Codec<T>::Encode(*decoded);
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(*again, bytes);
  });
}

TEST(Codec, RefusesEveryTruncationAndTrailingByte) {
  ForEachType([](const auto& value, const Bytes& bytes) {
    using T = std::decay_t<decltype(value)>;
    for (size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(Codec<T>::Decode(std::span(bytes).first(size)).ok()) << size;
    }
    Bytes longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(Codec<T>::Decode(longer).ok());
  });
}

TEST(Codec, EveryFlippedBitIsRefusedOrHarmless) {
  ForEachType([](const auto& value, const Bytes& bytes) {
    using T = std::decay_t<decltype(value)>;
    for (size_t i = 0; i < bytes.size() * 8; ++i) {
      Bytes flipped = bytes;
      flipped[i / 8] ^= static_cast<uint8_t>(1 << (i % 8));
      const auto decoded = Codec<T>::Decode(flipped);
      EXPECT_FALSE(i < 64 && decoded.ok()) << "fingerprint bit " << i;
      // What is let through keeps the rules: it can be sent again.
      EXPECT_TRUE(!decoded.ok() || Codec<T>::Encode(*decoded).ok()) << i;
    }
  });
}

TEST(Codec, HostileLengthsAndRandomBytesAreRefused) {
  std::mt19937 random(1);
  ForEachType([&](const auto& value, const Bytes& bytes) {
    using T = std::decay_t<decltype(value)>;
    for (int round = 0; round < 2000; ++round) {
      Bytes hostile = bytes;
      // A length is four bytes somewhere; a huge or negative one may stand anywhere.
      const size_t at = 8 + random() % (hostile.size() - 11);
      const uint32_t length = round % 2 == 0 ? 0x7fffffff : 0x80000000 + random() % 1000;
      for (int i = 0; i < 4; ++i) hostile[at + i] = static_cast<uint8_t>(length >> (24 - 8 * i));
      const auto decoded = Codec<T>::Decode(hostile);
      EXPECT_TRUE(!decoded.ok() || Codec<T>::Encode(*decoded).ok());
      Bytes noise(bytes.begin(), bytes.begin() + 8);
      for (size_t i = random() % 200; i > 0; --i) noise.push_back(static_cast<uint8_t>(random()));
      EXPECT_FALSE(Codec<T>::Decode(noise).ok());
    }
  });
}

TEST(Codec, ADamagedFrameIsToldByItsChecksum) {
  Bytes bytes = *Codec<msg::Frame>::Encode(msg::ExampleFrame());
  bytes[bytes.size() / 2] ^= 1;
  const auto decoded = Codec<msg::Frame>::Decode(bytes);
  ASSERT_FALSE(decoded.ok());
  EXPECT_THAT(decoded.error().message, HasSubstr("checksum"));
}

TEST(Codec, ScenePointsKeepATenthOfAMillimetre) {
  const msg::Scene scene = msg::ExampleScene();
  const auto decoded = Codec<msg::Scene>::Decode(*Codec<msg::Scene>::Encode(scene));
  ASSERT_TRUE(decoded.ok());
  for (size_t i = 0; i < scene.objects[0].points_C.size(); ++i) {
    EXPECT_LT((decoded->objects[0].points_C[i] - scene.objects[0].points_C[i]).norm(), 1e-4);
  }
}

// A row that was damaged, or that no store would take, is left out; the good ones arrive.
TEST(Codec, ADamagedRowSpoilsNoGoodOne) {
  msg::History history = msg::ExampleHistory();
  history.rows = {{"kitchen", 1, 5, "note", "{\"first\":1}"},
                  {"kitchen", 2, 5, "note", "{\"second\":2}"},
                  {"kitchen", 3, 5, "note", "{\"third\":3}"}};
  Bytes bytes = *Codec<msg::History>::Encode(history);
  const std::string second = "second";
  const auto at = std::search(bytes.begin(), bytes.end(), second.begin(), second.end());
  ASSERT_NE(at, bytes.end());
  *at ^= 1;
  const auto decoded = Codec<msg::History>::Decode(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  ASSERT_EQ(decoded->rows.size(), 2u);
  EXPECT_EQ(decoded->rows[0].seq, 1);
  EXPECT_EQ(decoded->rows[1].seq, 3);
  EXPECT_EQ(decoded->refused_rows, 1);
  *at = 0x1b;  // would steer a terminal
  EXPECT_EQ(Codec<msg::History>::Decode(bytes)->refused_rows, 1);
}

TEST(Codec, AControlMessageFitsADatagram) {
  msg::History history = msg::ExampleHistory();
  history.rows.assign(100, history.rows[0]);
  for (auto& row : history.rows) row.body = std::string(1000, 'x');
  const auto bytes = Codec<msg::History>::Encode(history);
  ASSERT_FALSE(bytes.ok());
  EXPECT_THAT(bytes.error().message, HasSubstr("60000"));
}

// Every option of the most there may be names every object and eight actions.
TEST(Codec, TheLargestChoiceFitsADatagram) {
  msg::Query query = msg::ExampleQuery();
  query.kind = msg::QueryKind::kChoice;
  query.why = std::string(1024, 'w');
  const std::string name(24, 'n');
  query.objects.assign(msg::kMaxObjects, {.object_id = 1, .category = name, .instance = 1});
  query.likeliest.assign(msg::kMaxCandidates, {.action = name, .object = query.objects[0]});
  query.prospects.assign(64, {});
  query.options.assign(64, {.text = std::string(200, 't'),
                            .category = "",
                            .actions = std::vector<std::string>(8, name),
                            .objects = std::vector<int>(msg::kMaxObjects, 1)});
  const auto bytes = Codec<msg::Query>::Encode(query);
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  EXPECT_LT(bytes->size(), msg::kMaxDatagram);
  EXPECT_EQ(Codec<msg::Query>::Decode(*bytes)->options.size(), 64u);
}

TEST(Codec, ARimArrivesToATenthOfAMillimetreWithoutSamplesToo) {
  msg::Scene scene = msg::ExampleScene();
  scene.objects[0].points_C.clear();
  const auto bytes = Codec<msg::Scene>::Encode(scene);
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  const auto decoded = Codec<msg::Scene>::Decode(*bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  for (size_t i = 0; i < 2; ++i) {
    const auto &sent = scene.objects[i].rim_C, &arrived = decoded->objects[i].rim_C;
    ASSERT_EQ(arrived.size(), sent.size());
    for (size_t k = 0; k < sent.size(); ++k) {
      EXPECT_LT((arrived[k].point - sent[k].point).cwiseAbs().maxCoeff(), 0.51e-4);
      EXPECT_EQ(arrived[k].beyond, sent[k].beyond);
    }
  }
}

TEST(Codec, RefusesValuesThatBreakTheRules) {
  const auto refused = []<typename T>(T value, auto break_it) {
    break_it(value);
    return !Codec<T>::Encode(value).ok();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(msg::ExampleAnswer(), [](auto& a) { a.likelihoods = {0, 0}; }));
  EXPECT_TRUE(refused(msg::ExampleAnswer(), [](auto& a) { a.likelihoods = {-1, 1}; }));
  EXPECT_TRUE(refused(msg::ExampleAnswer(), [&](auto& a) { a.likelihoods = {nan, 1}; }));
  EXPECT_TRUE(refused(msg::ExampleAnswer(), [](auto& a) { a.likelihoods = {1}; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.options.clear(); }));
  EXPECT_TRUE(
      refused(msg::ExampleQuery(), [](auto& q) { q.kind = static_cast<msg::QueryKind>(99); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.text = "\x1b[2J"; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [&](auto& q) { q.expected_seconds = nan; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.why = "\x1b[2J"; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.why = std::string(1025, 'x'); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.information_bits = -1; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.prospects.pop_back(); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.prospects[0].probability = 1.1f; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.prospects[1].questions_left = -1; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(),
                      [&](auto& q) { q.prospects[1].seconds_left = static_cast<float>(nan); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.likeliest[0].prior = 1.5; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [&](auto& q) { q.likeliest[0].posterior = nan; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.likeliest[0].action.clear(); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.likeliest[0].object.instance = 0; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.likeliest[0].sessions_ago = 0; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.likeliest[1].times = -1; }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.likeliest.resize(9, q.likeliest[0]); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.options[0].actions[1].clear(); }));
  EXPECT_TRUE(refused(msg::ExampleQuery(), [](auto& q) { q.options[0].objects[0] = 0; }));
  EXPECT_TRUE(refused(msg::ExampleSession(), [](auto& s) { s.user = "../../etc"; }));
  EXPECT_TRUE(
      refused(msg::ExampleSession(), [](auto& s) { s.kind = static_cast<msg::SessionKind>(8); }));
  EXPECT_TRUE(refused(msg::ExampleTask(), [](auto& t) { t.expires_utime = t.utime; }));
  EXPECT_TRUE(refused(msg::ExampleTask(), [&](auto& t) { t.centroid_W.x() = nan; }));
  EXPECT_TRUE(refused(msg::ExampleTask(), [&](auto& t) { t.pose.X_WO.linear() *= 2; }));
  EXPECT_TRUE(refused(msg::ExampleScene(), [](auto& s) { s.objects[1].id = s.objects[0].id; }));
  EXPECT_TRUE(refused(msg::ExampleScene(), [](auto& s) { s.objects[0].points_C[0].x() = 9; }));
  EXPECT_TRUE(refused(msg::ExampleScene(), [](auto& s) { s.has_table = false; }));
  EXPECT_TRUE(refused(msg::ExampleScene(), [](auto& s) { s.objects[0].rim_C[1].point.y() = -9; }));
  EXPECT_TRUE(refused(msg::ExampleScene(),
                      [&](auto& s) { s.objects[0].rim_C[1].point.x() = static_cast<float>(nan); }));
  EXPECT_TRUE(refused(msg::ExampleScene(),
                      [](auto& s) { s.objects[0].rim_C[0].beyond = static_cast<Beyond>(5); }));
  EXPECT_TRUE(refused(msg::ExampleScene(),
                      [](auto& s) { s.objects[0].rim_C.resize(97, s.objects[0].rim_C[0]); }));
  EXPECT_TRUE(refused(msg::ExampleScene(), [](auto& s) { s.intrinsics.fy = 0; }));
  EXPECT_TRUE(refused(msg::ExampleScene(), [&](auto& s) { s.intrinsics.cx = nan; }));
  EXPECT_TRUE(refused(msg::ExamplePoses(), [](auto& p) { p.poses[0].semi_axes[1] = 0; }));
  EXPECT_TRUE(
      refused(msg::ExamplePoses(), [](auto& p) { p.poses[0].alternatives[0].epsilon[0] = 3; }));
  EXPECT_TRUE(
      refused(msg::ExamplePoses(), [&](auto& p) { p.poses[0].parts[1].semi_axes[2] = nan; }));
  EXPECT_TRUE(refused(msg::ExamplePoses(), [](auto& p) { p.poses[0].parts.pop_back(); }));
  EXPECT_TRUE(refused(msg::ExamplePoses(), [](auto& p) {
    p.poses[0].alternatives.resize(5, p.poses[0].alternatives[0]);
  }));
  EXPECT_TRUE(refused(msg::ExamplePoses(),
                      [](auto& p) { p.poses[0].parts.resize(9, p.poses[0].parts[0]); }));
  EXPECT_TRUE(refused(msg::ExampleInterface(), [](auto& i) { i.confusion[0][0] = 0.5f; }));
  EXPECT_TRUE(refused(msg::ExampleInterface(), [](auto& i) { i.seconds_per_question = 0; }));
  EXPECT_TRUE(refused(msg::ExampleLabel(), [](auto& l) { l.label_id.clear(); }));
  EXPECT_TRUE(refused(msg::ExampleLabel(), [](auto& l) { l.category.clear(); }));
  EXPECT_TRUE(refused(msg::ExampleLabel(), [](auto& l) { l.category = "../../etc"; }));
  EXPECT_TRUE(refused(msg::ExampleLabel(), [](auto& l) { l.user = "../../etc"; }));
  EXPECT_TRUE(refused(msg::ExampleLabel(), [](auto& l) { l.object_id = 0; }));
  EXPECT_TRUE(refused(msg::ExampleLabel(), [](auto& l) { l.scene_seq = 0; }));
  EXPECT_TRUE(
      refused(msg::ExampleLabel(), [](auto& l) { l.state = static_cast<msg::LabelState>(3); }));
  EXPECT_TRUE(refused(msg::ExampleProfile(), [](auto& p) { p.users[1] = "../../etc"; }));
  EXPECT_TRUE(refused(msg::ExampleProfile(), [](auto& p) { p.n_sessions = 1; }));
  EXPECT_TRUE(refused(msg::ExampleProfile(), [](auto& p) { p.recent[0].questions = -1; }));
  EXPECT_TRUE(refused(msg::ExampleProfile(), [](auto& p) { p.recent[1].action.clear(); }));
  EXPECT_TRUE(refused(msg::ExampleHighlight(), [](auto& h) { h.options[1] = 64; }));
  EXPECT_TRUE(refused(msg::ExampleHighlight(), [](auto& h) { h.dwell_ms = -1; }));
  EXPECT_TRUE(refused(msg::ExampleHighlight(), [](auto& h) { h.user = "../../etc"; }));
  EXPECT_TRUE(refused(msg::ExampleStimulus(), [](auto& s) { s.rows = 2; }));
  EXPECT_TRUE(refused(msg::ExampleStimulus(), [](auto& s) { s.columns = -3; }));
  EXPECT_TRUE(refused(msg::ExampleStimulus(), [](auto& s) { s.labels.pop_back(); }));
  EXPECT_TRUE(refused(msg::ExampleDecoding(), [](auto& d) { d.probabilities[0] = 0.4; }));
  EXPECT_TRUE(refused(msg::ExampleDecoding(), [&](auto& d) { d.probabilities[0] = nan; }));
  EXPECT_TRUE(refused(msg::ExampleDecoding(), [](auto& d) { d.probabilities = {-0.5, 1.5}; }));
  EXPECT_TRUE(refused(msg::ExampleFrame(), [](auto& f) { f.width = 0; }));
  EXPECT_TRUE(refused(msg::ExampleFrame(), [&](auto& f) { f.intrinsics.fx = nan; }));
}

// A type that has been logged is superseded, never edited: these numbers do not change.
TEST(Codec, FingerprintsAreLocked) {
  const std::map<std::string, uint64_t> now = {{"frame_t", frame_t::getHash()},
                                               {"scene_t", scene_t::getHash()},
                                               {"poses_t", poses_t::getHash()},
                                               {"interface_t", interface_t::getHash()},
                                               {"query_t", query_t::getHash()},
                                               {"answer_t", answer_t::getHash()},
                                               {"session_t", session_t::getHash()},
                                               {"task_t", task_t::getHash()},
                                               {"task_status_t", task_status_t::getHash()},
                                               {"history_t", history_t::getHash()},
                                               {"status_t", status_t::getHash()},
                                               {"label_t", label_t::getHash()},
                                               {"profile_t", profile_t::getHash()},
                                               {"highlight_t", highlight_t::getHash()},
                                               {"stimulus_t", stimulus_t::getHash()},
                                               {"decoding_t", decoding_t::getHash()},
                                               {"lease_t", lease_t::getHash()}};
  const std::map<std::string, uint64_t> locked = {
      {"answer_t", 0xa22727a8afbaf8c6},      {"frame_t", 0x5b22eba1617c64a5},
      {"history_t", 0x5b6155e75aae3d83},     {"interface_t", 0x5bb9d9cb715a4dfe},
      {"label_t", 0x7d3b00c4161fd9b2},       {"poses_t", 0xf16bbccc2d13ec4a},
      {"query_t", 0xcacf0cc24ccdf064},       {"scene_t", 0xfe744959b9a7ce73},
      {"session_t", 0x1e39e1f4c26e2b7c},     {"status_t", 0x11a1e4a40922e1e7},
      {"task_status_t", 0xc7536171eaec0f69}, {"task_t", 0xc938a574d229bb67},
      {"decoding_t", 0x25ccf6a5129af706},    {"highlight_t", 0x143881ce4f651b17},
      {"profile_t", 0x8c1023ee4c26e13a},     {"stimulus_t", 0x2458e8d2e03de2e2},
      {"lease_t", 0x2b8d439eb12e876f}};
  EXPECT_EQ(now, locked);
}

}  // namespace
}  // namespace beckon
