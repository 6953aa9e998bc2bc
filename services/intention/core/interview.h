// One session's reasoning: what is asked next, given the scene, what is remembered and the answers
// so far. Everything is recomputed from the list of steps, so that undo is the removal of the last
// one.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "services/intention/core/memory.h"
#include "services/intention/core/policy.h"

namespace beckon::intention {

/// What the interview knows of a device.
struct DeviceModel {
  InterfaceKind kind = InterfaceKind::kYesNo;
  int max_options = 5;
  double seconds_per_question = 8;
  double seconds_per_option = 0;
  bool announced = false;  // false: its errors are unknown
  ErrorRates rates;
  std::vector<std::vector<float>> confusion;  // k x k for choices of k options; may be empty
};

/// An object of the session's table. Objects keep their index while it lasts.
struct TableObject {
  msg::SceneObject object;
  std::string remembered;  // category the user gave in an earlier session, or empty
  bool gone = false;       // affords nothing now; it may come back
};

struct InterviewInput {
  std::vector<TableObject> table;  // at most kMaxThings
  UserHistory history;
  std::string device;  // that requested the session
  std::map<std::string, DeviceModel> devices;
  Utime utime = 0;  // when it began; 0: not known
  uint64_t seed = 0;
  Phrases phrases = English();
};

/// The accepted task.
struct AcceptedTask {
  int object = 0;  // index in the table
  std::string category;
  std::string action;
  int instance = 1;
  double posterior = 0;
  std::string text;  // "Open the nearest carton"
};

/// Nothing fits.
struct GaveUp {
  std::string text;
  bool unclear = false;  // the answers make no sense together; it may start over
};

/// A label given in this session.
struct GivenLabel {
  int object = 0;  // index in the table
  std::string category;
};

/// Categories of the scene that the affordances do not know count as "Unknown". Objects in doubt
/// are asked about first, the likeliest categories only. One of no category affords what the
/// affordances say of unknown ones. Where no task is left, every object is asked about until it is
/// named or all categories were refused, unknown ones first.
class Interview {
 public:
  Interview(const Affordances& affordances, const Policy& policy, InterviewInput input);

  /// The query to ask (without ids, times and user), or the end.
  using Outcome = std::variant<msg::Query, AcceptedTask, GaveUp>;
  const Outcome& outcome() const { return asked_.outcome; }

  /// Changes whenever the outcome is another one, or must be put to the user anew.
  int64_t put() const { return asked_.put; }

  /// The table changed: the same objects in the same order, then new ones. Answers stay evidence
  /// about what they spoke of; the question stays where it says what it said. A task is never
  /// accepted by such a change, nor by a yes from before its object moved.
  void Look(std::vector<TableObject> table);
  /// An object may not be where it was when it was accepted: a new yes is needed.
  void Doubt(int object);
  /// Begins anew: labels are kept, answers dropped. False where that was done before.
  bool StartOver();

  /// A device announced itself (again); counts from the next step on.
  void Know(const std::string& device, const DeviceModel& model) { input_.devices[device] = model; }

  /// An answer to outcome()'s query: one likelihood an option.
  void Answer(const std::vector<double>& likelihoods, const std::string& device);
  /// Refuses all that is on offer: every task, or every category offered for an object.
  void NoneOfThese(const std::string& device);
  /// Takes the last step back; false where there is none.
  bool Undo();

  /// Answers so far that were not taken back.
  int questions() const { return static_cast<int>(steps_.size() + dropped_.size()); }
  /// The one object that the outcome asks about, or -1.
  int asked_object() const;
  bool HasMoved(const TableObject& now, int object) const;
  /// A sentence of the phrases about an object: "The nearest mug is gone."
  std::string Say(const std::string& sentence, int object) const;
  /// Once a task was accepted: the answers as evidence about errors, also the withdrawn ones.
  std::vector<AnswerRecord> Answers() const;
  std::vector<GivenLabel> Labels() const;
  /// Instances on the table, by category.
  std::map<std::string, int> Present() const;

 private:
  struct Heard {
    Question question;
    Evidence evidence;
    std::vector<double> likelihoods;  // as received; empty: none of these, by request
    std::string device;
    int look = 0;    // looks_ when it was heard
    int labels = 0;  // labels_ when it was heard
  };
  struct WhatIsIt {
    int object;
    std::vector<int> offer;           // categories, as they were offered
    std::vector<double> likelihoods;  // by option, errors of the device considered
  };
  struct RefusedAll {
    uint64_t objects;  // on the table then
  };
  using Step = std::variant<Heard, WhatIsIt, RefusedAll>;

  /// What is known of an object after the steps.
  struct Opinion {
    int category = -1;      // index in Affordances; -1: unknown, and affords nothing
    bool in_doubt = false;  // perception wants it asked about
    bool remembered =
        false;             // the user named it, or refused categories for it, in an earlier session
    bool settled = false;  // the user named it in this one, or refused all categories
    std::vector<int> refused;   // categories
    std::vector<int> offered;   // categories that `share` is about
    std::vector<double> share;  // by option of an offer that is not decided
  };

  /// The outcome and what is behind it.
  struct Asked {
    Outcome outcome;
    Question question;       // where it is about tasks
    int object = -1;         // where it is a what-is-it query
    std::vector<int> offer;  // its options but the last
    int look = 0;            // looks_ when it was put
    int64_t put = 0;
  };

  void Recompute();
  void StartOpinions();
  void Apply(const WhatIsIt& step);
  void Apply(const RefusedAll& step);
  void Refuse(int object, const std::vector<int>& categories);
  /// `category`: -1 counts as Affordances::unknown().
  void Relabel(int object, int category);
  void AskTask();
  /// `in_doubt`: before any task, not because every task was refused.
  void AskObject(int object, bool in_doubt);
  /// A question with its pairs looked up in the current situation. What was said at a look accepts
  /// nothing that moved later.
  Question Resolved(Question question, int look) const;
  std::unique_ptr<Dialogue> Replayed(size_t from);
  /// Index of the evidence from before an object was named or went.
  size_t Outdated() const;
  /// Whether an answer chose only objects that are gone.
  bool ChoseTheGone(const Heard& step) const;
  bool RefusedEverything() const;
  uint64_t OnTable() const;
  Situation SituationNow() const;
  /// Recomputes after a change of the table; `arrived`: objects that are new on it.
  void Reconsider(uint64_t arrived);
  bool StillStands(const Asked& asked, uint64_t arrived) const;
  bool TaskStillStands(const Asked& asked, uint64_t arrived) const;
  bool IsPossible(const Proposition& option) const;
  int NextInDoubt() const;
  int NextToRecheck() const;
  /// Categories that were not refused for an object, likeliest first, those without a probability
  /// last.
  std::vector<int> Left(int object) const;
  /// How many are offered before the known tasks are asked about.
  size_t FirstOffers(int object) const;
  /// Categories to offer for an object; empty once it is settled.
  std::vector<int> Offer(int object) const;
  std::vector<double> ThroughErrors(const std::vector<double>& likelihoods,
                                    const std::string& device) const;
  Interface InterfaceOf(const std::string& device) const;
  const DeviceModel& Device(const std::string& device) const;
  msg::ObjectRef Ref(int object) const;
  msg::Option OptionOf(const Proposition& option) const;
  /// Of a proposition; empty where it is any.
  std::vector<std::string> ActionNames(const Proposition& proposition) const;
  std::vector<msg::ObjectRef> ObjectRefs(uint64_t objects) const;
  /// What a query about tasks says, without numbers and reasons.
  msg::Query TaskWords(const Question& question) const;
  msg::Query TaskQuery(const Question& question, const Belief& belief) const;
  /// Says why it is asked.
  void Justify(msg::Query& query, const Question& question, const Belief& belief) const;
  void JustifyWhatIsIt(msg::Query& query, bool in_doubt) const;
  void Accept(int pair, const Belief& belief);

  const Affordances& affordances_;
  const Policy& policy_;
  InterviewInput input_;
  std::vector<Step> steps_;
  std::vector<Heard> withdrawn_;  // by undo
  std::vector<Heard> dropped_;    // when it started over
  bool started_over_ = false;
  int looks_ = 0;              // changes of the table
  int went_at_ = 0;            // looks_ when an object last went
  std::vector<int> moved_at_;  // by object: looks_ when it last came or moved

  // Recomputed from the steps.
  std::vector<Opinion> opinions_;  // by object of the table
  std::vector<Heard> evidence_;    // that still holds
  size_t relabelled_at_ = 0;       // evidence_.size() when a label last changed
  uint64_t refused_ = 0;           // objects whose tasks were all refused
  int labels_ = 0;                 // steps that spoke of what an object is
  Belief belief_;                  // behind asked_, where tasks were considered
  Situation situation_;
  std::vector<double> prior_;  // by pair, before any answer; empty where the policy has none
  Asked asked_;
};

}  // namespace beckon::intention
