// Objects that come, go, move and flicker while a session lasts.
#include "services/intention/core/scene_follower.h"

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

class SceneFollowerTest : public testing::Test {
 protected:
  /// Shows a scene at 10 Hz for a while; whether anything was believed.
  bool See(std::vector<msg::SceneObject> objects, Utime duration = kSecond / 10) {
    bool changed = false;
    for (const Utime end = now_ + duration; now_ < end;) {
      now_ += kSecond / 10;
      msg::Scene scene = SceneOf(objects);
      scene.seq = ++seq_;
      changed |= follower_.See(scene, now_);
    }
    return changed;
  }
  const Followed& At(size_t i) { return follower_.objects().at(i); }

  const msg::SceneObject carton_ = SceneObject(1, "Carton", 0.1, 0.5);
  const msg::SceneObject mug_ = SceneObject(2, "Mug", -0.1, 0.4);
  Utime now_ = 1'000'000'000;
  int64_t seq_ = 7;
  SceneFollower follower_{SceneOf({carton_, mug_}), now_};
};

TEST_F(SceneFollowerTest, BelievesTheFirstSceneAtOnce) {
  ASSERT_EQ(follower_.objects().size(), 2u);
  EXPECT_TRUE(follower_.Shows(0));
  EXPECT_FALSE(See({carton_, mug_}, 5 * kSecond));
  EXPECT_FALSE(See({mug_, carton_}, 5 * kSecond));
  EXPECT_EQ(At(0).object.category, "Carton");
}

TEST_F(SceneFollowerTest, AnObjectIsGoneOnceThatHasLasted) {
  EXPECT_FALSE(See({mug_}, 6 * kSecond / 10));
  EXPECT_FALSE(follower_.Shows(0)) << "not believed gone, but not seen either";
  EXPECT_FALSE(See({carton_, mug_}));
  EXPECT_TRUE(follower_.Shows(0));
  EXPECT_FALSE(See({mug_}, 6 * kSecond / 10)) << "counted anew";
  EXPECT_TRUE(See({mug_}, 3 * kSecond / 10));
  EXPECT_TRUE(At(0).gone);
  EXPECT_FALSE(At(1).gone);
}

TEST_F(SceneFollowerTest, FlickerNeverChangesAnything) {
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(See(i % 3 == 0 ? std::vector{carton_, mug_} : std::vector{mug_}));
    const bool ghost = i % 4 != 0;
    EXPECT_FALSE(See(ghost ? std::vector{carton_, mug_, SceneObject(9, "Box", 0.4, 0.7)}
                           : std::vector{carton_, mug_}));
  }
  EXPECT_EQ(follower_.objects().size(), 2u);
}

TEST_F(SceneFollowerTest, FewScenesAreNotEnough) {
  const auto see = [&](Utime later, int64_t seq) {
    msg::Scene scene = SceneOf({mug_});
    scene.seq = seq;
    return follower_.See(scene, now_ += later);
  };
  EXPECT_FALSE(see(kSecond, 8));
  EXPECT_FALSE(see(kSecond, 9));
  EXPECT_TRUE(see(kSecond, 10));
}

TEST_F(SceneFollowerTest, ANewObjectIsAppendedAndOneThatComesBackIsTheSame) {
  const auto box = SceneObject(3, "Box", 0.4, 0.7);
  EXPECT_TRUE(See({box, carton_, mug_}, kSecond));
  ASSERT_EQ(follower_.objects().size(), 3u);
  EXPECT_EQ(At(2).object.category, "Box");
  EXPECT_TRUE(See({carton_, mug_}, kSecond));
  EXPECT_TRUE(At(2).gone);
  auto again = box;
  again.id = 44;  // perception forgot it
  EXPECT_TRUE(See({carton_, again, mug_}, kSecond));
  ASSERT_EQ(follower_.objects().size(), 3u);
  EXPECT_FALSE(At(2).gone);
  EXPECT_EQ(At(2).object.id, 44);
}

TEST_F(SceneFollowerTest, AnObjectHasMovedOnceItStandsStillElsewhere) {
  auto moved = carton_;
  moved.centroid_W.x() += 0.04;
  EXPECT_FALSE(See({moved, mug_}, 2 * kSecond)) << "within 5 cm it has not moved";
  EXPECT_TRUE(follower_.Shows(0));
  for (int i = 0; i < 30; ++i) {  // pushed, 3 cm a scene
    moved.centroid_W.y() += 0.03;
    EXPECT_FALSE(See({moved, mug_}, kSecond / 10));
    if (i > 1) {
      EXPECT_FALSE(follower_.Shows(0));
    }
  }
  EXPECT_TRUE(See({moved, mug_}, kSecond));
  EXPECT_TRUE(follower_.Shows(0));
  EXPECT_EQ(At(0).object.centroid_W, moved.centroid_W);
  EXPECT_EQ(follower_.objects().size(), 2u);
}

TEST_F(SceneFollowerTest, KnowsObjectsOfAnotherRunByPlaceAndLooks) {
  auto carton = carton_, mug = mug_;
  std::swap(carton.id, mug.id);
  seq_ = 0;
  EXPECT_TRUE(See({mug, carton})) << "the ids are others";
  EXPECT_TRUE(follower_.Shows(0));
  EXPECT_TRUE(follower_.Shows(1));
  EXPECT_EQ(At(0).object.id, 2);
  EXPECT_EQ(At(0).object.category, "Carton");
  seq_ = 0;  // once more, and something else stands where the carton was
  auto box = SceneObject(1, "Box", 0.1, 0.5);
  box.extent_W.z() = 0.3;
  EXPECT_TRUE(See({box, mug}, kSecond));
  ASSERT_EQ(follower_.objects().size(), 3u);
  EXPECT_TRUE(At(0).gone);
  EXPECT_EQ(At(1).object.id, 1);
}

TEST_F(SceneFollowerTest, AnIdThatLooksOtherwiseElsewhereIsAnotherObject) {
  EXPECT_TRUE(See({mug_, SceneObject(1, "Box", 0.4, 0.8)}, kSecond));
  ASSERT_EQ(follower_.objects().size(), 3u);
  EXPECT_TRUE(At(0).gone);
}

TEST_F(SceneFollowerTest, TwinsAreNotConfused) {
  auto left = SceneObject(1, "Mug", -0.1, 0.5), right = SceneObject(2, "Mug", 0.0, 0.5);
  follower_.~SceneFollower();
  new (&follower_) SceneFollower(SceneOf({left, right}), now_);
  EXPECT_TRUE(See({left}, kSecond));
  EXPECT_TRUE(At(1).gone);
  EXPECT_FALSE(At(0).gone);
  auto back = right;
  back.id = 7;
  EXPECT_TRUE(See({back}, kSecond));
  EXPECT_FALSE(At(1).gone);
  EXPECT_TRUE(At(0).gone);
}

TEST_F(SceneFollowerTest, ScenesWithoutATableSayNothing) {
  msg::Scene blind = SceneOf({});
  blind.has_table = false;
  const Utime seen = follower_.seen();
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(follower_.See(blind, now_ += kSecond));
  EXPECT_TRUE(follower_.Shows(0));
  EXPECT_EQ(follower_.seen(), seen);
}

TEST_F(SceneFollowerTest, HoldsNoMoreThanAMaskCan) {
  std::vector<msg::SceneObject> many;
  for (int round = 0; round < 4; ++round) {
    many.clear();
    for (int i = 0; i < 40; ++i) {
      many.push_back(SceneObject(100 * (round + 1) + i, "Box", 0.1 * i, 1.0 + round));
    }
    See(many, kSecond);
  }
  EXPECT_EQ(follower_.objects().size(), static_cast<size_t>(kMaxThings));
}

}  // namespace
}  // namespace beckon::intention
