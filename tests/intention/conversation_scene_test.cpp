// Conversations about a table that changes: objects that go, come and move while the user is asked,
// answers, confirms, and until a robot has taken the task.
#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

using Kind = msg::SessionKind;
using Objects = std::vector<msg::SceneObject>;

class ConversationSceneTest : public testing::Test {
 protected:
  void Begin(const Objects& objects, const std::string& id = "s1", float error = 0) {
    desk.Announce("switch", error);
    desk.Watch(objects, kSecond / 10);
    desk.Start(id);
  }
  /// Answers until the full question about a wish stands.
  void AskedFully(const Wish& wish) {
    for (int i = 0; i < 50; ++i) {
      const msg::Query query = desk.queries.back();
      if (query.kind == msg::QueryKind::kFull && Desk::Honest(query, wish, {}) == 0) return;
      desk.Answer(query, Desk::Honest(query, wish, {}));
      ASSERT_EQ(desk.events.back().kind, Kind::kBegun);
    }
    FAIL() << "never asked";
  }
  void Confirm() { desk.Answer(desk.queries.back(), 0); }
  static Objects Without(Objects objects, int id) {
    std::erase_if(objects, [&](const auto& o) { return o.id == id; });
    return objects;
  }
  static Objects Moved(Objects objects, int id, double x) {
    for (auto& object : objects) object.centroid_W.x() += object.id == id ? x : 0;
    return objects;
  }

  const Objects table{SceneObject(1, "Carton", 0.1, 0.5), SceneObject(2, "Mug", -0.1, 0.4),
                      SceneObject(3, "Mug", 0.2, 0.7), SceneObject(4, "Box", 0.3, 0.6)};
  const Wish open_carton{"Open", 1, "Carton"};
  FakeMemory memory;
  Desk desk{memory};
};

TEST_F(ConversationSceneTest, AnUnchangedTableNeverDisturbsTheQuestion) {
  Begin(table);
  const msg::Query asked = desk.queries.back();
  for (int i = 0; i < 100; ++i)
    desk.Watch(i % 3 == 0 ? Without(table, 1) : Moved(table, 1, 0.01 * (i % 4)), kSecond / 10);
  EXPECT_EQ(desk.queries.back().id, asked.id);
}

TEST_F(ConversationSceneTest, AGoneObjectIsNotAskedAboutAnyMore) {
  Begin(table);
  AskedFully(open_carton);
  const msg::Query asked = desk.queries.back();
  desk.Watch(Without(table, 1));
  const msg::Query next = desk.queries.back();
  EXPECT_NE(next.id, asked.id);
  EXPECT_TRUE(next.text.starts_with("The carton is gone. ")) << next.text;
  desk.Answer(asked, 0);  // too late
  EXPECT_EQ(desk.conversation->counters().stale_answers, 1);
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_EQ(desk.Converse({"Push", 4, "Box"}).text, "Push the box.");
}

TEST_F(ConversationSceneTest, AnswersAboutWhatIsStillThereStayEvidence) {
  Begin(table);
  const msg::Query first = desk.queries.back();
  desk.Answer(first, Desk::Honest(first, {"Drink", 2, "Mug"}, {}));
  const int asked = desk.queries.back().questions_asked;
  const int candidates = desk.queries.back().n_candidates;
  desk.Watch(Without(table, 4));
  EXPECT_EQ(desk.queries.back().questions_asked, asked);
  EXPECT_LE(desk.queries.back().n_candidates, candidates);
  EXPECT_EQ(desk.Converse({"Drink", 2, "Mug"}).text, "Drink from the nearest mug.");
}

TEST_F(ConversationSceneTest, AnObjectThatComesCanBeWanted) {
  Begin(Without(table, 4));
  const msg::Query first = desk.queries.back();
  desk.Answer(first, Desk::Honest(first, {"Push", 4, "Box"}, {}));
  desk.Watch(table);
  EXPECT_EQ(desk.Converse({"Push", 4, "Box"}).text, "Push the box.");
}

TEST_F(ConversationSceneTest, WordsStayTrueWhenATwinComes) {
  Begin(Without(Without(table, 3), 4));
  AskedFully({"Drink", 2, "Mug"});
  const msg::Query asked = desk.queries.back();
  EXPECT_EQ(asked.text, "Drink from the mug?");
  desk.Watch(Without(table, 4));
  EXPECT_NE(desk.queries.back().id, asked.id);
  EXPECT_NE(desk.queries.back().text, asked.text);
  EXPECT_EQ(desk.Converse({"Drink", 2, "Mug"}).text, "Drink from the nearest mug.");
}

TEST_F(ConversationSceneTest, RanksFollowAMoveAndTheMovedObjectIsAskedAboutAnew) {
  Begin(table);
  AskedFully({"Drink", 2, "Mug"});
  const msg::Query asked = desk.queries.back();
  EXPECT_EQ(asked.text, "Drink from the nearest mug?");
  Objects swapped = table;
  swapped[1].centroid_W.y() = 0.9;
  desk.Watch(swapped);
  EXPECT_NE(desk.queries.back().id, asked.id);
  desk.Answer(asked, 0);
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_EQ(desk.Converse({"Drink", 2, "Mug"}).text, "Drink from the second mug.");
}

TEST_F(ConversationSceneTest, PerceptionThatComesBackWithOtherIdsIsFollowed) {
  Begin(table);
  AskedFully(open_carton);
  const msg::Query asked = desk.queries.back();
  Objects renamed = table;
  for (auto& object : renamed) object.id = 5 - object.id;
  desk.seq = 0;
  desk.Watch(renamed, kSecond / 10);
  ASSERT_NE(desk.queries.back().id, asked.id) << "it named the object by its old id";
  EXPECT_EQ(desk.queries.back().text, asked.text);
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 4);
  Confirm();
  ASSERT_EQ(desk.tasks.size(), 1u);
  EXPECT_EQ(desk.tasks[0].object.object_id, 4);
}

TEST_F(ConversationSceneTest, ALateCopyOfAnOldSceneIsLeftOut) {
  Begin(table);
  AskedFully(open_carton);
  msg::Scene old = SceneOf(Without(table, 1));
  old.seq = desk.seq - 1;
  old.utime = desk.now - kSecond;
  desk.Show(old);
  EXPECT_EQ(desk.conversation->counters().late_scenes, 1);
  Confirm();
  EXPECT_EQ(desk.tasks.size(), 1u);
}

TEST_F(ConversationSceneTest, NothingIsConfirmedWhileItsObjectIsNotSeen) {
  Begin(table);
  AskedFully(open_carton);
  desk.Watch(Without(table, 1), kSecond / 10);
  Confirm();
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_TRUE(memory.sessions.empty());
  EXPECT_EQ(desk.events.back().text, "Making sure that the carton is still there.");
  desk.Watch(table, kSecond / 10);  // it was a flicker
  ASSERT_EQ(desk.tasks.size(), 1u);
  EXPECT_EQ(desk.events.back().kind, Kind::kConfirmed);
}

TEST_F(ConversationSceneTest, AnObjectThatVanishesAtTheConfirmationIsNeverATask) {
  Begin(table);
  AskedFully(open_carton);
  desk.Watch(Without(table, 1), kSecond / 10);
  Confirm();
  desk.Watch(Without(table, 1));
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_TRUE(memory.sessions.empty());
  EXPECT_TRUE(desk.queries.back().text.starts_with("The carton is gone. "));
  EXPECT_EQ(desk.events.back().text, "");
  EXPECT_EQ(desk.Converse({"Push", 4, "Box"}).text, "Push the box.");
}

TEST_F(ConversationSceneTest, AnObjectThatMovesAtTheConfirmationIsAskedAboutAtItsNewPlace) {
  Begin(table);
  AskedFully(open_carton);
  const msg::Query asked = desk.queries.back();
  const Objects moved = Moved(table, 1, -0.2);
  desk.Watch(moved, kSecond / 10);
  Confirm();
  EXPECT_TRUE(desk.tasks.empty());
  desk.Watch(moved);
  EXPECT_EQ(desk.queries.back().text,
            "The carton has moved. Once more, to be sure: open the carton?");
  EXPECT_NE(desk.queries.back().id, asked.id);
  Confirm();
  ASSERT_EQ(desk.tasks.size(), 1u);
  EXPECT_NEAR(desk.tasks[0].centroid_W.x(), -0.1, 1e-9);
}

TEST_F(ConversationSceneTest, TheTaskSaysWhereTheObjectWasLastSeen) {
  Begin(table);
  AskedFully(open_carton);
  desk.Watch(Moved(table, 1, 0.03), kSecond / 10);
  Confirm();
  ASSERT_EQ(desk.tasks.size(), 1u);
  EXPECT_NEAR(desk.tasks[0].centroid_W.x(), 0.13, 1e-9);
}

TEST_F(ConversationSceneTest, WhereNobodyLooksAnyMoreTheUserIsAskedAgain) {
  Begin(table);
  AskedFully(open_carton);
  desk.Watch(Without(table, 1), kSecond / 10);
  Confirm();
  desk.Wait(6 * kSecond);
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_EQ(desk.queries.back().text,
            "The carton is out of sight. Once more, to be sure: open the carton?");
  Confirm();
  EXPECT_EQ(desk.tasks.size(), 1u) << "the user can see it";
}

TEST_F(ConversationSceneTest, UndoNoneAndCancelWorkWhileItIsLookedFor) {
  for (const Kind kind : {Kind::kRequestUndo, Kind::kRequestNoneOfThese, Kind::kRequestCancel}) {
    const std::string id = "u" + std::to_string(static_cast<int>(kind));
    Begin(table, id);
    AskedFully(open_carton);
    desk.Watch(Without(table, 1), kSecond / 10);
    Confirm();
    desk.Request(kind, id);
    desk.Watch(table);
    EXPECT_TRUE(desk.tasks.empty()) << id;
    desk.Request(Kind::kRequestCancel, id);
  }
}

TEST_F(ConversationSceneTest, AnEmptiedTableIsWaitedFor) {
  Begin(table);
  const msg::Query asked = desk.queries.back();
  desk.Watch({});
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);
  EXPECT_NE(desk.events.back().text.find("Waiting for objects on the table."), std::string::npos);
  desk.Clear();
  desk.Wait(3 * kSecond);
  EXPECT_TRUE(desk.queries.empty());
  desk.Watch(table);
  EXPECT_EQ(desk.events.back().text, "");
  EXPECT_GT(desk.queries.back().id, asked.id);
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
}

TEST_F(ConversationSceneTest, UndoReachesBackBehindAChangeOfTheTable) {
  Begin(table);
  const msg::Query first = desk.queries.back();
  desk.Answer(first, 1 - Desk::Honest(first, open_carton, {}));  // a slip
  desk.Watch(Without(table, 4));
  desk.Request(Kind::kRequestUndo);
  EXPECT_EQ(desk.queries.back().questions_asked, 0);
  for (const auto& object : desk.queries.back().objects) EXPECT_NE(object.object_id, 4);
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
}

TEST_F(ConversationSceneTest, ATaskIsNeverAcceptedByAChangeOfTheTable) {
  Begin(table, "s1", 0.15f);
  AskedFully(open_carton);
  Confirm();  // not enough on a noisy device
  ASSERT_TRUE(desk.tasks.empty());
  desk.Watch({table[0]}, 3 * kSecond);
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
}

TEST_F(ConversationSceneTest, NoneOfTheseDoesNotRefuseWhatComesLater) {
  Begin(Without(table, 4));
  desk.Request(Kind::kRequestNoneOfThese);
  desk.Watch(table);
  EXPECT_EQ(
      desk.Converse({"Push", 4, "Box"}, {{1, "Carton"}, {2, "Mug"}, {3, "Mug"}, {4, "Box"}}).text,
      "Push the box.");
}

TEST_F(ConversationSceneTest, ANewDoubtfulObjectWaitsForItsTurn) {
  Begin(Without(table, 4));
  const msg::Query asked = desk.queries.back();
  Objects doubtful = table;
  doubtful[3].ask_user = true;
  desk.Watch(doubtful);
  EXPECT_EQ(desk.queries.back().id, asked.id);
  desk.Answer(asked, 1);
  EXPECT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 4);
}

TEST_F(ConversationSceneTest, AnObjectAskedAboutThatGoesIsNotNamed) {
  Objects doubtful = table;
  doubtful[3].ask_user = true;
  Begin(doubtful);
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  desk.Watch(Without(doubtful, 4));
  EXPECT_NE(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_TRUE(desk.queries.back().text.starts_with("The unknown object is gone. "));
}

TEST_F(ConversationSceneTest, ATaskThatNoRobotTookIsTakenBackWhenItsObjectGoes) {
  for (const bool gone : {true, false}) {
    desk.Clear();
    const std::string id = gone ? "gone" : "moved";
    Begin(table, id);
    desk.Converse(open_carton);
    const Objects changed = gone ? Without(table, 1) : Moved(table, 1, 0.3);
    desk.Watch(changed, 5 * kSecond / 10);
    const size_t tasks = desk.tasks.size();
    EXPECT_TRUE(desk.statuses.empty());
    desk.Watch(changed, 3 * kSecond);
    EXPECT_EQ(desk.tasks.size(), tasks) << "not repeated";
    ASSERT_FALSE(desk.statuses.empty());
    EXPECT_EQ(desk.statuses[0].state, msg::TaskState::kRevoked);
    EXPECT_EQ(desk.statuses[0].text, gone ? "The carton is gone." : "The carton has moved.");
    EXPECT_EQ(memory.states.at(id), msg::TaskState::kRevoked);
    EXPECT_GT(desk.statuses.size(), 3u) << "a robot may not have heard the first";
    desk.Take(desk.conversation->OnTaskStatus(desk.statuses[0], desk.now));  // our own word
    desk.Take(desk.conversation->OnTaskStatus(
        {desk.now, id, msg::TaskState::kFailed, "revoked", {}}, desk.now));
    desk.Clear();
    desk.Watch(changed, 40 * kSecond);
    EXPECT_TRUE(desk.statuses.empty());
    EXPECT_TRUE(desk.tasks.empty());
  }
}

TEST_F(ConversationSceneTest, ATaskOfAnEarlierRunIsTakenBackToo) {
  Begin(table);
  desk.Converse(open_carton);
  desk.Clear();
  desk.Restart();
  EXPECT_EQ(desk.tasks.size(), 1u);
  Objects renamed = table;
  for (auto& object : renamed) object.id += 10;
  desk.Watch(renamed, 2 * kSecond);
  EXPECT_TRUE(desk.statuses.empty());
  EXPECT_GT(desk.tasks.size(), 2u);
  desk.Watch(Without(renamed, 11));
  ASSERT_FALSE(desk.statuses.empty());
  EXPECT_EQ(memory.states.at("s1"), msg::TaskState::kRevoked);
}

TEST_F(ConversationSceneTest, ATaskThatWasTakenIsLeftAlone) {
  Begin(table);
  desk.Converse(open_carton);
  desk.Take(desk.conversation->OnTaskStatus({desk.now, "s1", msg::TaskState::kAccepted, "", {}},
                                            desk.now));
  desk.Watch(Without(table, 1), 3 * kSecond);
  EXPECT_TRUE(desk.statuses.empty());
}

TEST_F(ConversationSceneTest, AnAnswerThatWasTakenBackIsRememberedAsASlip) {
  Begin(table);
  const msg::Query first = desk.queries.back();
  const size_t slip = 1 - Desk::Honest(first, open_carton, {});
  desk.Answer(first, slip);
  desk.Request(Kind::kRequestUndo);
  desk.Converse(open_carton);
  ASSERT_EQ(memory.sessions.size(), 1u);
  const auto& answers = memory.sessions[0].answers;
  ASSERT_EQ(answers.size(), static_cast<size_t>(memory.sessions[0].questions) + 1);
  EXPECT_EQ(answers[0].fate, AnswerFate::kWithdrawn);
  EXPECT_NE(answers[0].meant, static_cast<int>(slip));
  const auto history = ToHistory(memory.sessions, desk.affordances);
  const AnswerCounts& counts = history[0].answers.at("switch");
  EXPECT_EQ(counts.meant_yes_said_no + counts.meant_no_said_yes, 1);
}

}  // namespace
}  // namespace beckon::intention
