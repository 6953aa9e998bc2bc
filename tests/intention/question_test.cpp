#include "services/intention/core/question.h"

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

TEST(QuestionText, IsPlainEnglish) {
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(a, {{a.FindCategory("Carton"), 0.5, 0.1},
                                        {a.FindCategory("Mug"), 0.6, 0.3},
                                        {a.FindCategory("Mug"), 0.4, -0.2},
                                        {a.FindCategory("SprayCan"), 0.9, -0.3}});
  const auto pair = [&](int object, const char* action) {
    return AskPair(s, s.Find(object, a.FindAction(action)));
  };
  EXPECT_EQ(Text(a, s, AskAction(a.FindAction("Open"))), "Do you want to open something?");
  EXPECT_EQ(Text(a, s, AskAction(a.FindAction("Drink"))), "Do you want to drink from something?");
  EXPECT_EQ(Text(a, s, AskObject(0)), "Is it about the carton?");
  EXPECT_EQ(Text(a, s, AskObject(2)), "Is it about the nearest mug?");
  EXPECT_EQ(Text(a, s, AskObject(1)), "Is it about the second mug?");
  EXPECT_EQ(Text(a, s, pair(0, "Open")), "Open the carton?");
  EXPECT_EQ(Text(a, s, pair(1, "Drink")), "Drink from the second mug?");
  EXPECT_EQ(Text(a, s, pair(3, "Grasp")), "Grasp the spray can?");
  const Question mugs = AskYesNo(QuestionKind::kCategory, {kAny, 0b0110, -1});
  EXPECT_EQ(Text(a, s, mugs), "Is it about one of the mugs?");
  EXPECT_EQ(Text(a, s, AskYesNo(QuestionKind::kSet, {kAny, 0b0101, -1})),
            "Is it one of the two objects nearest to you?");
  EXPECT_EQ(Text(a, s, AskYesNo(QuestionKind::kSet, {kAny, 0b1100, -1})),
            "Is it one of the two objects furthest to the left?");
  EXPECT_EQ(Text(a, s, AskYesNo(QuestionKind::kSet, {kAny, 0b1011, -1})),
            "Is it one of the three objects furthest from you?");
  EXPECT_EQ(ANoun(English(), "SprayCan"), "a spray can");
  EXPECT_EQ(ANoun(English(), "Apple"), "an apple");
}

TEST(Question, MeansTheFirstOptionThatHolds) {
  const Question set = AskYesNo(QuestionKind::kSet, {0b010, 0b101, -1});
  EXPECT_EQ(set.Meant({0, 1}), 0);
  EXPECT_EQ(set.Meant({2, 1}), 0);
  EXPECT_EQ(set.Meant({1, 1}), set.none());
  EXPECT_EQ(set.Meant({0, 0}), set.none());
  EXPECT_EQ(AskAction(3).Meant({63, 3}), 0);
  const Question choice{QuestionKind::kChoice, {{0b001, 0b100, 7}, {kAny, 0b100, -1}, {}}};
  EXPECT_EQ(choice.answers(), 4);
  EXPECT_EQ(choice.Meant({2, 0}), 0);
  EXPECT_EQ(choice.Meant({2, 1}), 1);
  EXPECT_EQ(choice.Meant({0, 1}), 2);
  EXPECT_EQ(choice.Accepts(0), 7);
  EXPECT_LT(choice.Accepts(1), 0);
  EXPECT_LT(choice.Accepts(choice.none()), 0);
}

}  // namespace
}  // namespace beckon::intention
