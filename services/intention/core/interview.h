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

struct InterviewInput {
  msg::Scene scene;
  std::vector<std::string> remembered;  // by scene object: category the user gave earlier, or empty
  UserHistory history;
  std::string device;  // that requested the session
  std::map<std::string, DeviceModel> devices;
  uint64_t seed = 0;
  Phrases phrases = English();
};

/// The accepted task.
struct AcceptedTask {
  int object = 0;  // index in scene.objects
  std::string category;
  std::string action;
  int instance = 1;
  double posterior = 0;
  std::string text;  // "Open the nearest carton"
};

/// Nothing fits.
struct GaveUp {
  std::string text;
};

/// A label given in this session.
struct GivenLabel {
  int object = 0;  // index in scene.objects
  std::string category;
};

/// Categories of the scene that the affordances do not know count as "Unknown". Objects in doubt
/// are asked about first, the likeliest categories only. Where no known task is left, every object
/// is asked about until it is named or all categories were refused, unknown ones first.
class Interview {
 public:
  Interview(const Affordances& affordances, const Policy& policy, InterviewInput input);

  /// The query to ask (without ids, times and user), or the end.
  using Outcome = std::variant<msg::Query, AcceptedTask, GaveUp>;
  const Outcome& outcome() const { return outcome_; }

  /// A device announced itself (again); counts from the next step on.
  void Know(const std::string& device, const DeviceModel& model) { input_.devices[device] = model; }

  /// An answer to outcome()'s query: one likelihood an option.
  void Answer(const std::vector<double>& likelihoods, const std::string& device);
  /// Refuses all that is on offer: every task, or every category offered for an object.
  void NoneOfThese(const std::string& device);
  /// Takes the last step back; false where there is none.
  bool Undo();

  /// Steps so far.
  int questions() const { return static_cast<int>(steps_.size()); }
  /// Once a task was accepted: the answers as evidence about errors.
  std::vector<AnswerRecord> Answers() const;
  std::vector<GivenLabel> Labels() const;
  /// Instances on the table, by category.
  std::map<std::string, int> Present() const;

 private:
  struct Heard {
    Question question;
    Evidence evidence;
    std::vector<double> likelihoods;  // as received
    std::string device;
  };
  struct WhatIsIt {
    int object;
    std::vector<int> offer;           // categories, as they were offered
    std::vector<double> likelihoods;  // by option, errors of the device considered
  };
  struct RefusedAll {};
  using Step = std::variant<Heard, WhatIsIt, RefusedAll>;

  /// What is known of an object after the steps.
  struct Opinion {
    int category = -1;      // index in Affordances, -1 unknown
    bool in_doubt = false;  // perception wants it asked about
    bool remembered =
        false;             // the user named it, or refused categories for it, in an earlier session
    bool settled = false;  // the user named it in this one, or refused all categories
    std::vector<int> refused;   // categories
    std::vector<int> offered;   // categories that `share` is about
    std::vector<double> share;  // by option of an offer that is not decided
  };

  void Recompute();
  void StartOpinions();
  void Apply(const WhatIsIt& step);
  void Refuse(int object, const std::vector<int>& categories);
  void Relabel(int object, int category);
  void AskTask();
  /// `in_doubt`: before any task, not because every task was refused.
  void AskObject(int object, bool in_doubt);
  /// A question with its pair looked up in the current situation.
  Question Resolved(Question question) const;
  std::unique_ptr<Dialogue> Replayed(size_t from);
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
  msg::Query TaskQuery(const Question& question, const Belief& belief) const;
  /// Says why it is asked.
  void Justify(msg::Query& query, const Question& question, const Belief& belief) const;
  void JustifyWhatIsIt(msg::Query& query, bool in_doubt) const;
  void Accept(int pair, const Belief& belief);

  const Affordances& affordances_;
  const Policy& policy_;
  InterviewInput input_;
  std::vector<Step> steps_;

  // Recomputed from the steps.
  std::vector<Opinion> opinions_;  // by scene object
  std::vector<Heard> evidence_;    // that still holds
  size_t relabelled_at_ = 0;       // evidence_.size() when a label last changed
  bool refused_all_ = false;
  Situation situation_;
  std::vector<double> prior_;  // by pair, before any answer; empty where the policy has none
  Question question_;          // behind outcome_, where it is about tasks
  int asked_object_ = -1;      // behind outcome_, where it is a what-is-it query
  std::vector<int> offer_;     // its options but the last
  Outcome outcome_;
};

}  // namespace beckon::intention
