#include <limits>

#include "lcmtypes/codec.h"
#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

using Kind = msg::SessionKind;

class ConversationTest : public testing::Test {
 protected:
  void Begin(const std::string& id = "s1") {
    desk.Announce("switch");
    desk.Show(scene);
    desk.Start(id);
  }
  const msg::Scene scene =
      SceneOf({SceneObject(1, "Carton", 0.1, 0.5), SceneObject(2, "Mug", -0.1, 0.4),
               SceneObject(3, "Mug", 0.2, 0.7), SceneObject(4, "Box", 0.3, 0.6)});
  const Wish open_carton{"Open", 1, "Carton"};
  FakeMemory memory;
  Desk desk{memory};
};

TEST_F(ConversationTest, LeadsToATaskThatWasRememberedFirst) {
  EXPECT_EQ(desk.events.back().kind, Kind::kIdle);
  Begin();
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);
  ASSERT_EQ(desk.queries.size(), 1u);
  const msg::Session end = desk.Converse(open_carton);
  EXPECT_EQ(end.kind, Kind::kConfirmed);
  EXPECT_EQ(end.text, "Open the carton.");
  ASSERT_EQ(desk.tasks.size(), 1u);
  const msg::Task& task = desk.tasks[0];
  EXPECT_EQ(task.task_id, "s1");
  EXPECT_EQ(task.action, "Open");
  EXPECT_EQ(task.object.object_id, 1);
  EXPECT_EQ(task.object.category, "Carton");
  EXPECT_EQ(task.object.instance, 1);
  EXPECT_EQ(task.expires_utime, task.utime + 30 * kSecond);
  EXPECT_FALSE(task.has_pose);
  ASSERT_EQ(memory.sessions.size(), 1u);
  EXPECT_EQ(memory.sessions[0].questions, task.questions);
  EXPECT_EQ(memory.sessions[0].answers.size(), static_cast<size_t>(task.questions));
  EXPECT_EQ(memory.sessions[0].answers.back().meant, 0);
}

TEST_F(ConversationTest, AsksOnceTheSecondTime) {
  Begin();
  desk.Converse(open_carton);
  desk.Start("s2");
  ASSERT_EQ(desk.queries.back().text, "Open the carton?");
  EXPECT_EQ(desk.queries.back().kind, msg::QueryKind::kFull);
  desk.Answer(desk.queries.back(), 0);
  EXPECT_EQ(desk.events.back().kind, Kind::kConfirmed);
  EXPECT_EQ(memory.sessions[1].questions, 1);
}

TEST_F(ConversationTest, TellsFrontEndsOfAUsersPast) {
  Begin();
  desk.Converse(open_carton);
  EXPECT_TRUE(desk.profiles.empty());
  desk.Request(Kind::kRequestProfile, "", "ben");
  ASSERT_EQ(desk.profiles.size(), 1u);
  EXPECT_EQ(desk.profiles[0].user, "ben");
  EXPECT_EQ(desk.profiles[0].users, std::vector<std::string>{"ann"});
  EXPECT_EQ(desk.profiles[0].n_sessions, 0);
  desk.Request(Kind::kRequestProfile, "", "ann");
  ASSERT_EQ(desk.profiles.size(), 2u);
  ASSERT_EQ(desk.profiles[1].recent.size(), 1u);
  EXPECT_EQ(desk.profiles[1].recent[0].action, "Open");
  EXPECT_EQ(desk.profiles[1].recent[0].category, "Carton");
  EXPECT_EQ(desk.profiles[1].recent[0].questions, desk.tasks[0].questions);
}

TEST_F(ConversationTest, TellsOfThePastAgainAfterASessionThatTheUserSaw) {
  Begin();
  desk.Request(Kind::kRequestProfile, "", "ann");
  desk.Converse(open_carton);
  desk.Wait(kSecond);
  ASSERT_EQ(desk.profiles.size(), 2u);
  EXPECT_EQ(desk.profiles[0].n_sessions, 0);
  EXPECT_EQ(desk.profiles[1].n_sessions, 1);
}

TEST_F(ConversationTest, AProfileNamesNoMoreThanFitsOneDatagram) {
  for (int i = 0; i < 300; ++i) {
    SessionRecord past;
    past.session_id = "p" + std::to_string(i);
    past.user = i < 100 ? "user" + std::to_string(i) : "ann";
    past.utime = i;
    past.action = "Open";
    past.category = "Carton";
    past.device = std::string(64, 'd');
    memory.sessions.push_back(past);
  }
  desk.Request(Kind::kRequestProfile, "", "ann");
  ASSERT_EQ(desk.profiles.size(), 1u);
  EXPECT_EQ(desk.profiles[0].users.size(), static_cast<size_t>(msg::kMaxUsers));
  EXPECT_EQ(desk.profiles[0].recent.back().utime, 299);
  EXPECT_TRUE(Codec<msg::Profile>::Encode(desk.profiles[0]).ok());
}

TEST_F(ConversationTest, TaskIsNotPublishedWhereItCannotBeRemembered) {
  Begin();
  memory.fails = true;
  const msg::Session end = desk.Converse(open_carton);
  EXPECT_EQ(end.kind, Kind::kAbandoned);
  EXPECT_NE(end.text.find("the disk is full"), std::string::npos);
  EXPECT_TRUE(desk.tasks.empty());
}

TEST_F(ConversationTest, RepeatsQueryAndAnnouncement) {
  Begin();
  desk.Clear();
  desk.Wait(3 * kSecond);
  EXPECT_EQ(desk.queries.size(), 6u);
  EXPECT_EQ(desk.events.size(), 3u);
  for (const auto& query : desk.queries) EXPECT_EQ(query.id, desk.queries[0].id);
  for (const auto& event : desk.events) EXPECT_EQ(event.kind, Kind::kBegun);
}

TEST_F(ConversationTest, RefusesStaleForeignAndMisshapenAnswers) {
  Begin();
  const msg::Query first = desk.queries.back();
  desk.Answer(first, 1);
  const msg::Query second = desk.queries.back();
  ASSERT_NE(second.id, first.id);
  desk.Answer(first, 1);  // a duplicate
  EXPECT_EQ(desk.conversation->counters().stale_answers, 1);
  msg::Answer foreign = desk.AnswerTo(second, 0);
  foreign.session_id = "other";
  desk.Take(desk.conversation->OnAnswer(foreign, desk.now));
  EXPECT_EQ(desk.conversation->counters().stale_answers, 2);
  msg::Answer misshapen = desk.AnswerTo(second, 0);
  misshapen.likelihoods.push_back(1);
  desk.Take(desk.conversation->OnAnswer(misshapen, desk.now));
  EXPECT_EQ(desk.queries.back().id, second.id);
  EXPECT_EQ(desk.conversation->counters().answers, 1);
  EXPECT_EQ(desk.refusals.size(), 3u);
}

TEST_F(ConversationTest, RefusesHostileEvidence) {
  Begin();
  const msg::Query query = desk.queries.back();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  int64_t refused = desk.conversation->counters().refused;
  for (const std::vector<double>& bad : std::vector<std::vector<double>>{
           {}, {1}, {1, 0, 0}, {0, 0}, {1, -1}, {nan, 0}, {infinity, 1}}) {
    msg::Answer answer = desk.AnswerTo(query, 0);
    answer.likelihoods = bad;
    desk.Take(desk.conversation->OnAnswer(answer, desk.now));
    EXPECT_EQ(desk.conversation->counters().refused, ++refused);
  }
  EXPECT_EQ(desk.conversation->counters().answers, 0);
  EXPECT_EQ(desk.queries.back().id, query.id);
}

TEST_F(ConversationTest, TaskIsRepeatedUntilAcknowledged) {
  Begin();
  desk.Converse(open_carton);
  desk.Clear();
  desk.Wait(2 * kSecond);
  EXPECT_EQ(desk.tasks.size(), 4u);
  EXPECT_EQ(desk.events.back().kind, Kind::kConfirmed);  // still announced
  msg::TaskStatus accepted{desk.now, "s1", msg::TaskState::kAccepted, "", {}};
  desk.Take(desk.conversation->OnTaskStatus(accepted, desk.now));
  desk.Take(desk.conversation->OnTaskStatus(accepted, desk.now));
  desk.Clear();
  desk.Wait(40 * kSecond);
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_TRUE(desk.statuses.empty());
  EXPECT_EQ(memory.states.at("s1"), msg::TaskState::kAccepted);
}

TEST_F(ConversationTest, TaskThatNobodyTookExpires) {
  Begin();
  desk.Converse(open_carton);
  desk.Wait(31 * kSecond);
  ASSERT_EQ(desk.statuses.size(), 1u);
  EXPECT_EQ(desk.statuses[0].state, msg::TaskState::kExpired);
  EXPECT_EQ(memory.states.at("s1"), msg::TaskState::kExpired);
  desk.Clear();
  desk.Wait(5 * kSecond);
  EXPECT_TRUE(desk.tasks.empty());
}

TEST_F(ConversationTest, WaitsForAFreshScene) {
  desk.Start();
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);
  EXPECT_FALSE(desk.events.back().text.empty());
  EXPECT_TRUE(desk.queries.empty());
  msg::Scene bare = scene;
  bare.objects.clear();
  desk.Show(bare);
  EXPECT_EQ(desk.events.back().text, "Waiting for objects on the table.");
  desk.Show(scene);
  EXPECT_EQ(desk.events.back().text, "");
  EXPECT_EQ(desk.queries.size(), 1u);
}

TEST_F(ConversationTest, RefusesToBeginOnAnOldScene) {
  desk.Show(scene);
  desk.now += 6 * kSecond;
  desk.Start();
  EXPECT_TRUE(desk.queries.empty());
  EXPECT_NE(desk.events.back().text.find("picture"), std::string::npos);
  desk.Show(scene);
  EXPECT_EQ(desk.queries.size(), 1u);
}

TEST_F(ConversationTest, KeepsItsTableWhilePerceptionIsAway) {
  Begin();
  desk.now += 60 * kSecond;
  const msg::Session end = desk.Converse(open_carton);
  EXPECT_EQ(end.text, "Open the carton.");
}

msg::ObjectPose PoseAt(int id, double x, double y) {
  msg::ObjectPose pose;
  pose.object_id = id;
  pose.converged = true;
  pose.X_WO.translation() = Eigen::Vector3d(x, y, 0.05);
  return pose;
}

TEST_F(ConversationTest, TakesPosesByIdAndPlace) {
  msg::ObjectPose not_converged = PoseAt(4, 0.3, 0.6);
  not_converged.converged = false;
  Begin();
  desk.ShowPoses(scene,
                 {PoseAt(1, 0.12, 0.52), PoseAt(2, 0.5, 0.5) /* elsewhere */, not_converged});
  desk.Converse(open_carton);
  EXPECT_TRUE(desk.tasks.back().has_pose);
  EXPECT_EQ(desk.tasks.back().pose.object_id, 1);
  desk.Start("s2");
  desk.Converse({"Drink", 2, "Mug"});
  EXPECT_FALSE(desk.tasks.back().has_pose);
  desk.Start("s3");
  desk.Converse({"Push", 4, "Box"});
  EXPECT_FALSE(desk.tasks.back().has_pose);
}

TEST_F(ConversationTest, WaitsForThePosesOfItsScene) {
  desk.ShowSceneOnly(scene);
  desk.Start();
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);
  EXPECT_EQ(desk.events.back().text, "Waiting for the objects' poses.");
  desk.Wait(kSecond / 2);
  desk.Request(Kind::kRequestUndo);  // nothing to take back or to refuse yet
  desk.Request(Kind::kRequestNoneOfThese);
  EXPECT_TRUE(desk.queries.empty());
  desk.ShowPoses(scene, {PoseAt(1, 0.1, 0.5)});
  EXPECT_EQ(desk.events.back().text, "");
  ASSERT_EQ(desk.queries.size(), 1u);
  EXPECT_EQ(desk.queries[0].questions_asked, 0);
  desk.Converse(open_carton);
  EXPECT_TRUE(desk.tasks.back().has_pose);
}

TEST_F(ConversationTest, DoesNotWaitForPosesThatAreThere) {
  desk.Show(scene);
  desk.Start();
  EXPECT_EQ(desk.queries.size(), 1u);
  for (const auto& event : desk.events) EXPECT_EQ(event.text, "");
}

TEST_F(ConversationTest, GoesOnWithoutPosesWherePoseIsDead) {
  desk.ShowSceneOnly(scene);
  desk.Start();
  desk.Wait(kSecond - kSecond / 10);
  EXPECT_TRUE(desk.queries.empty());
  desk.Wait(2 * kSecond / 10);
  ASSERT_FALSE(desk.queries.empty());
  desk.Converse(open_carton);
  EXPECT_FALSE(desk.tasks.back().has_pose);
  desk.Start("s2");  // the scene has been there for a second
  EXPECT_EQ(desk.queries.back().session_id, "s2");
}

TEST_F(ConversationTest, TakesPosesOfALaterSceneWherePoseSkippedItsOwn) {
  desk.ShowPoses(scene);  // of a frame before
  msg::Scene second = scene, third = scene;
  second.utime = scene.utime + 1;
  third.utime = scene.utime + 2;
  desk.ShowSceneOnly(second);
  desk.Start();
  EXPECT_TRUE(desk.queries.empty());
  desk.ShowSceneOnly(third);
  EXPECT_TRUE(desk.queries.empty());
  desk.ShowPoses(third, {PoseAt(1, 0.1, 0.5)});
  ASSERT_EQ(desk.queries.size(), 1u);
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
  EXPECT_TRUE(desk.tasks.back().has_pose);
}

TEST_F(ConversationTest, CanBeCancelledAndStoppedWhileItWaitsForPoses) {
  desk.ShowSceneOnly(scene);
  desk.Start();
  desk.Request(Kind::kRequestCancel);
  EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
  desk.Start("s2");
  desk.Request(Kind::kRequestStop, "s2");
  desk.ShowPoses(scene);
  desk.Wait(2 * kSecond);
  EXPECT_TRUE(desk.queries.empty());
}

TEST_F(ConversationTest, UndoTakesTheLastAnswerBack) {
  Begin();
  const msg::Query first = desk.queries.back();
  desk.Answer(first, 1 - Desk::Honest(first, open_carton, {}));  // a slip
  desk.Request(Kind::kRequestUndo);
  const msg::Query again = desk.queries.back();
  EXPECT_EQ(again.text, first.text);
  EXPECT_NE(again.id, first.id);
  EXPECT_EQ(again.questions_asked, 0);
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
}

TEST_F(ConversationTest, DuplicatedUndoTakesOneAnswerBack) {
  Begin();
  desk.Answer(desk.queries.back(), 1);
  desk.Answer(desk.queries.back(), 1);
  desk.Request(Kind::kRequestUndo, "s1", "ann", 77);
  desk.Request(Kind::kRequestUndo, "s1", "ann", 77);
  EXPECT_EQ(desk.queries.back().questions_asked, 1);
  desk.Request(Kind::kRequestUndo, "s1", "ann", 78);
  desk.Request(Kind::kRequestUndo, "s1", "ann", 79);  // nothing left
  EXPECT_EQ(desk.queries.back().questions_asked, 0);
}

TEST_F(ConversationTest, CancelLearnsNothing) {
  Begin();
  desk.Answer(desk.queries.back(), 0);
  desk.Request(Kind::kRequestCancel);
  EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
  EXPECT_TRUE(memory.sessions.empty());
  const size_t queries = desk.queries.size();
  desk.Start("s1");  // a late duplicate of the start does not raise the dead
  EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
  desk.Request(Kind::kRequestCancel);
  EXPECT_EQ(desk.queries.size(), queries);
  desk.Start("s2");
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);
}

TEST_F(ConversationTest, OneSessionPerUser) {
  Begin();
  desk.Start("s2");
  EXPECT_EQ(desk.events.back().session_id, "s1");
  EXPECT_EQ(desk.queries.size(), 1u);
  desk.Start("b1", "bob");
  EXPECT_EQ(desk.events.back().session_id, "b1");
  EXPECT_EQ(desk.queries.back().user, "bob");
  const msg::Query to_bob = desk.queries.back();
  desk.Request(Kind::kRequestCancel, "s1", "bob");  // not his
  EXPECT_EQ(desk.conversation->counters().abandoned, 0);
  desk.Request(Kind::kRequestCancel, "s1", "ann");
  desk.Answer(to_bob, 1);
  EXPECT_EQ(desk.queries.back().session_id, "b1");
}

TEST_F(ConversationTest, StopStopsEverythingUntilResume) {
  Begin();
  desk.Converse(open_carton);
  desk.Start("s2");
  const msg::Query open = desk.queries.back();
  desk.Request(Kind::kRequestStop, "s2");
  EXPECT_EQ(desk.events.back().kind, Kind::kStopped);
  ASSERT_EQ(desk.statuses.size(), 1u);
  EXPECT_EQ(desk.statuses[0].state, msg::TaskState::kRevoked);
  desk.Clear();
  desk.Answer(open, 0);
  desk.Start("s3");
  desk.Show(scene);
  desk.Wait(3 * kSecond);
  EXPECT_TRUE(desk.queries.empty());
  EXPECT_TRUE(desk.tasks.empty());
  for (const auto& event : desk.events) EXPECT_EQ(event.kind, Kind::kStopped);
  desk.Restart();  // killing the process is no way out
  EXPECT_EQ(desk.events.back().kind, Kind::kStopped);
  desk.Request(Kind::kRequestResume);
  EXPECT_EQ(desk.events.back().kind, Kind::kIdle);
  desk.Show(scene);
  desk.Start("s2");
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);
}

TEST_F(ConversationTest, LateDuplicatesOfStopAndResumeChangeNothing) {
  Begin();
  desk.Request(Kind::kRequestResume, "s1", "ann", 50);  // nothing is stopped
  desk.Request(Kind::kRequestStop, "s1", "ann", 51);
  desk.Request(Kind::kRequestResume, "s1", "ann", 50);
  EXPECT_TRUE(desk.conversation->stopped());
  desk.Request(Kind::kRequestResume, "s1", "ann", 52);
  EXPECT_FALSE(desk.conversation->stopped());
  desk.Request(Kind::kRequestStop, "s1", "ann", 51);
  EXPECT_FALSE(desk.conversation->stopped());
  desk.Request(Kind::kRequestStop, "s1", "ann", 53);
  EXPECT_TRUE(desk.conversation->stopped());
}

TEST_F(ConversationTest, EveryMessageTwiceIsTheSameConversation) {
  desk.Announce("switch");
  for (int i = 0; i < 2; ++i) desk.Show(scene);
  for (int i = 0; i < 2; ++i) desk.Request(Kind::kRequestStart, "s1", "ann", 5);
  while (desk.events.back().kind == Kind::kBegun) {
    const msg::Query query = desk.queries.back();
    for (int i = 0; i < 2; ++i) desk.Answer(query, Desk::Honest(query, open_carton, {}));
  }
  EXPECT_EQ(desk.events.back().kind, Kind::kConfirmed);
  EXPECT_EQ(memory.sessions.size(), 1u);
  EXPECT_EQ(desk.tasks.size(), 1u);
  desk.Request(Kind::kRequestStart, "s1", "ann", 5);
  EXPECT_EQ(desk.events.back().kind, Kind::kConfirmed);
  EXPECT_EQ(desk.conversation->counters().sessions, 1);
}

TEST_F(ConversationTest, ATaskStatusOfAnUnknownTaskIsIgnored) {
  desk.Take(desk.conversation->OnTaskStatus({1, "ghost", msg::TaskState::kDone, "", {}}, desk.now));
  EXPECT_TRUE(memory.states.empty());
}

TEST_F(ConversationTest, KilledBeforeTheCommitStartsOver) {
  Begin();
  const msg::Query first = desk.queries.back();
  desk.Answer(first, 1);
  desk.Restart();
  EXPECT_EQ(desk.events.back().kind, Kind::kIdle);
  desk.Announce("switch");
  desk.Show(scene);
  desk.Start("s1");
  EXPECT_EQ(desk.queries.back().text, first.text);
  EXPECT_EQ(desk.queries.back().questions_asked, 0);
  EXPECT_GT(desk.queries.back().id, first.id);
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
  EXPECT_EQ(memory.sessions.size(), 1u);
}

TEST_F(ConversationTest, KilledAfterTheCommitPublishesTheTaskAgain) {
  Begin();
  desk.Converse(open_carton);
  const msg::Task task = desk.tasks.back();
  desk.Clear();
  desk.Restart();
  ASSERT_EQ(desk.tasks.size(), 1u);
  EXPECT_EQ(desk.tasks[0].task_id, task.task_id);
  EXPECT_EQ(desk.tasks[0].expires_utime, task.expires_utime);
  desk.Show(scene);
  desk.Start("s1");
  EXPECT_EQ(desk.events.back().kind, Kind::kConfirmed);
  EXPECT_EQ(desk.events.back().session_id, "s1");
  EXPECT_TRUE(desk.queries.empty());
  EXPECT_EQ(memory.sessions.size(), 1u);
  desk.now += 40 * kSecond;
  desk.Clear();
  desk.Restart();
  EXPECT_TRUE(desk.tasks.empty());  // expired meanwhile
  ASSERT_EQ(desk.statuses.size(), 1u);
  EXPECT_EQ(desk.statuses[0].state, msg::TaskState::kExpired);
}

TEST_F(ConversationTest, ACategoryThatTheAffordancesLackIsSaidOnceAndCountsAsUnknown) {
  const msg::Scene with_teapot =
      SceneOf({SceneObject(1, "Teapot", 0, 0.5), SceneObject(2, "Mug", 0.1, 0.5)});
  desk.Announce("switch", 0, 12);
  for (int i = 0; i < 5; ++i) desk.Show(with_teapot);
  desk.Start();
  EXPECT_EQ(desk.Converse({"Drink", 2, "Mug"}).text, "Drink from the mug.");  // still of use
  desk.Show(with_teapot);
  desk.Start("s2");
  ASSERT_EQ(desk.refusals.size(), 1u);
  EXPECT_EQ(desk.refusals[0].channel, "BECKON_SCENE");
  EXPECT_NE(desk.refusals[0].detail.find("'Teapot'"), std::string::npos);
  EXPECT_EQ(desk.conversation->counters().unknown_categories, 2);  // one a session
  desk.Request(Kind::kRequestNoneOfThese, "s2");  // no known task: what is the other thing?
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 1);
  EXPECT_EQ(desk.queries.back().objects[0].category, msg::kUnknownCategory);
  EXPECT_EQ(desk.Converse({"Move", 1, "Cup"}, {{1, "Cup"}}).text, "Move the cup.");
}

TEST_F(ConversationTest, NoisyDeviceNeedsMoreThanOneYes) {
  desk.Announce("switch", 0.15f);
  desk.Show(scene);
  desk.Start();
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
  EXPECT_GE(desk.tasks.back().posterior, 0.99);
  desk.Start("s2");
  desk.Answer(desk.queries.back(), 0);
  EXPECT_EQ(desk.events.back().kind, Kind::kBegun);  // not on one yes
}

TEST_F(ConversationTest, StartsOverOnceWhereAnswersMeanNothingAndThenGivesUp) {
  desk.Announce("switch", 0.05f);
  desk.Show(scene);
  desk.Start();
  std::vector<size_t> restarts;  // queries that say so
  while (desk.events.back().kind == Kind::kBegun && desk.queries.size() < 400) {
    const msg::Query query = desk.queries.back();
    if (query.text.starts_with("I am not sure what you want."))
      restarts.push_back(desk.queries.size());
    desk.Answer(query, 0);  // a switch that is stuck
  }
  EXPECT_EQ(restarts.size(), 1u);
  EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
  EXPECT_TRUE(desk.tasks.empty());
  EXPECT_TRUE(memory.sessions.empty());
}

TEST_F(ConversationTest, LearnsNothingOfADeviceFromBeforeItStartedOver) {
  desk.Announce("switch", 0.05f);
  desk.Show(scene);
  desk.Start();
  while (!desk.queries.back().text.starts_with("I am not sure what you want.")) {
    ASSERT_LT(desk.queries.size(), 200u);
    desk.Answer(desk.queries.back(), 0);
  }
  EXPECT_EQ(desk.Converse(open_carton).kind, Kind::kConfirmed);
  ASSERT_EQ(memory.sessions.size(), 1u);
  const auto& answers = memory.sessions[0].answers;
  EXPECT_EQ(answers.front().fate, AnswerFate::kDropped);
  EXPECT_EQ(answers.back().fate, AnswerFate::kStands);
  const UserHistory history = ToHistory(memory.sessions, desk.affordances);
  const AnswerCounts& counts = history[0].answers.at("switch");
  EXPECT_EQ(counts.meant_no_said_yes, 0);
  EXPECT_EQ(counts.meant_yes_said_no, 0);
}

}  // namespace
}  // namespace beckon::intention
