#include "services/intention/core/interview.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "services/intention/core/answer_errors.h"

namespace beckon::intention {
namespace {

/// Of a session; a row of the history fits one datagram.
constexpr size_t kMostWithdrawn = 64;

}  // namespace

Interview::Interview(const Affordances& affordances, const Policy& policy, InterviewInput input)
    : affordances_(affordances),
      policy_(policy),
      input_(std::move(input)),
      moved_at_(input_.table.size(), 0) {
  Recompute();
}

const DeviceModel& Interview::Device(const std::string& device) const {
  static const DeviceModel kUnannounced;
  const auto found = input_.devices.find(device);
  return found == input_.devices.end() ? kUnannounced : found->second;
}

Interface Interview::InterfaceOf(const std::string& device) const {
  const DeviceModel& model = Device(device);
  const ErrorModel start =
      model.announced ? ErrorModel::Announced(model.rates, model.confusion) : ErrorModel::Unknown();
  return {model.kind, model.max_options, model.seconds_per_question, model.seconds_per_option,
          start.Learnt(PastAnswers(input_.history, device))};
}

std::vector<double> Interview::ThroughErrors(const std::vector<double>& likelihoods,
                                             const std::string& device) const {
  const DeviceModel& model = Device(device);
  const size_t k = likelihoods.size();
  const double error = model.announced ? (model.rates.false_yes + model.rates.false_no) / 2 : 0.02;
  std::vector<double> meant(k, 0.0);
  for (size_t row = 0; row < k; ++row) {
    for (size_t decoded = 0; decoded < k; ++decoded) {
      double p = row == decoded ? 1 - error : error / static_cast<double>(k - 1);
      if (model.confusion.size() == k) p = model.confusion[row][decoded];
      meant[row] += likelihoods[decoded] * p;
    }
  }
  return meant;
}

void Interview::Answer(const std::vector<double>& likelihoods, const std::string& device) {
  if (asked_.object >= 0) {
    steps_.emplace_back(WhatIsIt{asked_.object, asked_.offer, ThroughErrors(likelihoods, device)});
  } else {
    const Evidence evidence = InterfaceOf(device).errors.Hear(likelihoods);
    steps_.emplace_back(Heard{asked_.question, evidence, likelihoods, device, looks_, labels_});
  }
  Recompute();
}

void Interview::NoneOfThese(const std::string& device) {
  if (asked_.object >= 0) {
    const auto& query = std::get<msg::Query>(asked_.outcome);
    std::vector<double> last(query.options.size(), 0.0);
    last.back() = 1;
    return Answer(last, device);
  }
  steps_.emplace_back(RefusedAll{OnTable()});
  Recompute();
}

bool Interview::Undo() {
  if (steps_.empty()) return false;
  const auto* heard = std::get_if<Heard>(&steps_.back());
  if (heard != nullptr && withdrawn_.size() < kMostWithdrawn) withdrawn_.push_back(*heard);
  steps_.pop_back();
  Recompute();
  return true;
}

void Interview::Recompute() {
  StartOpinions();
  evidence_.clear();
  relabelled_at_ = 0;
  refused_ = 0;
  labels_ = 0;
  belief_ = {};
  prior_.clear();
  for (const Step& step : steps_) {
    if (const auto* heard = std::get_if<Heard>(&step)) evidence_.push_back(*heard);
    if (const auto* what = std::get_if<WhatIsIt>(&step)) Apply(*what);
    if (const auto* refused = std::get_if<RefusedAll>(&step)) Apply(*refused);
  }
  situation_ = SituationNow();
  asked_ = {.look = looks_, .put = asked_.put + 1};
  const int doubtful = NextInDoubt();
  doubtful >= 0 ? AskObject(doubtful, true) : AskTask();
}

Question Interview::Resolved(Question question, int look) const {
  for (Proposition& option : question.options) {
    option.pair = -1;
    if (!std::has_single_bit(option.actions) || !std::has_single_bit(option.objects)) continue;
    const int object = std::countr_zero(option.objects);
    if (moved_at_[object] > look) continue;
    option.pair = situation_.Find(object, std::countr_zero(option.actions));
  }
  return question;
}

std::unique_ptr<Dialogue> Interview::Replayed(size_t from) {
  auto dialogue =
      policy_.Begin(situation_, input_.history, InterfaceOf(input_.device), input_.seed);
  prior_ = dialogue->CurrentBelief().posterior;
  for (size_t i = from; i < evidence_.size(); ++i) {
    const Heard& heard = evidence_[i];
    if (ChoseTheGone(heard)) continue;
    dialogue->Hear(Resolved(heard.question, heard.look), heard.evidence);
  }
  return dialogue;
}

void Interview::AskTask() {
  auto dialogue = Replayed(0);
  auto next = dialogue->Ask();
  if (const size_t outdated = Outdated(); !next && !dialogue->Accepted() && outdated > 0) {
    // What was answered before an object turned out to be something else, or went, rules
    // everything out: forget it.
    dialogue = Replayed(outdated);
    next = dialogue->Ask();
  }
  belief_ = dialogue->CurrentBelief();
  const bool refused = RefusedEverything();
  if (const auto accepted = dialogue->Accepted(); accepted && !refused)
    return Accept(*accepted, belief_);
  if (next && !refused) {
    asked_.question = *next;
    asked_.outcome = TaskQuery(*next, belief_);
    return;
  }
  if (dialogue->End() == Ending::kUnclear) {
    asked_.outcome = GaveUp{Finished(input_.phrases.start_again), true};
    return;
  }
  if (const int object = NextToRecheck(); object >= 0) return AskObject(object, false);
  asked_.outcome = GaveUp{Finished(situation_.pairs.empty() ? input_.phrases.nothing_to_do
                                                            : input_.phrases.none_of_the_tasks)};
}

void Interview::Accept(int pair, const Belief& belief) {
  const Pair& wanted = situation_.pairs[pair];
  const Instance& instance = situation_.objects[wanted.object];
  asked_.outcome = AcceptedTask{wanted.object,
                                affordances_.categories()[instance.category].name,
                                affordances_.actions()[wanted.action].name,
                                instance.rank,
                                belief.best_pair == pair ? belief.best_posterior : 1,
                                TaskText(affordances_, situation_, wanted, input_.phrases)};
}

msg::ObjectRef Interview::Ref(int object) const {
  const int category = opinions_[object].category;
  return {
      input_.table[object].object.id,
      category < 0 ? std::string(msg::kUnknownCategory) : affordances_.categories()[category].name,
      std::max(1, situation_.objects[object].rank)};
}

msg::Option Interview::OptionOf(const Proposition& option) const {
  msg::Option shown;
  shown.text = OptionText(affordances_, situation_, option, input_.phrases);
  shown.actions = ActionNames(option);
  for (const msg::ObjectRef& object : ObjectRefs(option.objects))
    shown.objects.push_back(object.object_id);
  return shown;
}

std::vector<std::string> Interview::ActionNames(const Proposition& proposition) const {
  std::vector<std::string> names;
  if (proposition.actions == kAny) return names;
  for (size_t i = 0; i < affordances_.actions().size(); ++i) {
    if (proposition.actions >> i & 1) names.push_back(affordances_.actions()[i].name);
  }
  return names;
}

std::vector<msg::ObjectRef> Interview::ObjectRefs(uint64_t objects) const {
  std::vector<msg::ObjectRef> refs;
  if (objects == kAny) return refs;
  for (size_t i = 0; i < situation_.objects.size(); ++i) {
    if (objects >> i & 1) refs.push_back(Ref(static_cast<int>(i)));
  }
  return refs;
}

msg::Query Interview::TaskWords(const Question& question) const {
  msg::Query query;
  switch (question.kind) {
    case QuestionKind::kAction:
      query.kind = msg::QueryKind::kAction;
      break;
    case QuestionKind::kObject:
      query.kind = msg::QueryKind::kObject;
      break;
    case QuestionKind::kFull:
      query.kind = msg::QueryKind::kFull;
      break;
    case QuestionKind::kCategory:
      query.kind = msg::QueryKind::kCategory;
      break;
    case QuestionKind::kSet:
      query.kind = msg::QueryKind::kSet;
      break;
    case QuestionKind::kChoice:
      query.kind = msg::QueryKind::kChoice;
      break;
  }
  const bool again = std::any_of(evidence_.begin(), evidence_.end(),
                                 [&](const Heard& heard) { return heard.question == question; });
  query.text = (again ? TextAgain : Text)(affordances_, situation_, question, input_.phrases);
  if (question.kind == QuestionKind::kChoice) {
    uint64_t named = 0;
    for (const Proposition& option : question.options) {
      query.options.push_back(OptionOf(option));
      if (option.objects != kAny) named |= option.objects;
    }
    query.objects = ObjectRefs(named);
    query.options.push_back({.text = Finished(input_.phrases.none_of_these)});
  } else {
    const Proposition& asked = question.options.front();
    query.any_action = asked.actions == kAny;
    query.actions = ActionNames(asked);
    query.any_object = asked.objects == kAny;
    query.objects = ObjectRefs(asked.objects);
    query.options = {{.text = Finished(input_.phrases.yes)}, {.text = Finished(input_.phrases.no)}};
  }
  return query;
}

msg::Query Interview::TaskQuery(const Question& question, const Belief& belief) const {
  msg::Query query = TaskWords(question);
  query.n_candidates = belief.possible_pairs;
  query.expected_questions = belief.expected_questions;
  query.expected_seconds = belief.expected_seconds;
  query.best_posterior = belief.best_posterior;
  Justify(query, question, belief);
  return query;
}

void Interview::AskObject(int object, bool in_doubt) {
  asked_.object = object;
  msg::Query query;
  query.kind = msg::QueryKind::kWhatIsIt;
  query.text = Finished(input_.phrases.what_is_it);
  query.any_object = false;
  query.objects = {Ref(object)};
  const int id = input_.table[object].object.id;
  asked_.offer = Offer(object);
  for (const int category : asked_.offer) {
    const std::string& name = affordances_.categories()[category].name;
    query.options.push_back({ANoun(input_.phrases, name), name, {}, {id}});
  }
  query.options.push_back(
      {Finished(input_.phrases.none_of_these), msg::kUnknownCategory, {}, {id}});
  query.n_candidates = situation_.pair_count();
  query.expected_questions = 1;
  JustifyWhatIsIt(query, in_doubt);
  asked_.outcome = std::move(query);
}

std::vector<AnswerRecord> Interview::Answers() const {
  std::vector<AnswerRecord> answers;
  const auto* task = std::get_if<AcceptedTask>(&asked_.outcome);
  if (task == nullptr) return answers;
  const Pair wanted{task->object, affordances_.FindAction(task->action)};
  const auto record = [&](const Heard& step, AnswerFate fate) {
    if (step.likelihoods.empty() || ChoseTheGone(step)) return;
    // An answer that no longer stands tells of errors only where all is called what it was.
    if (fate != AnswerFate::kStands && step.labels != labels_) return;
    answers.push_back(
        {step.question.kind, step.likelihoods, step.question.Meant(wanted), step.device, fate});
  };
  for (const Heard& step : dropped_) record(step, AnswerFate::kDropped);
  for (const Heard& step : withdrawn_) record(step, AnswerFate::kWithdrawn);
  for (const Heard& step : evidence_) record(step, AnswerFate::kStands);
  return answers;
}

std::map<std::string, int> Interview::Present() const {
  std::map<std::string, int> present;
  for (const Instance& object : situation_.objects) {
    if (object.category >= 0) ++present[affordances_.categories()[object.category].name];
  }
  return present;
}

std::vector<GivenLabel> Interview::Labels() const {
  std::vector<GivenLabel> labels;
  for (int i = 0; i < static_cast<int>(opinions_.size()); ++i) {
    const int category = opinions_[i].category;
    // Refused so far is remembered as unknown: not asked about again before every known task is.
    const bool named = affordances_.IsNamed(category);
    const bool refused = !named && !opinions_[i].refused.empty();
    if (!opinions_[i].settled && !refused) continue;
    labels.push_back({i, named ? affordances_.categories()[category].name : msg::kUnknownCategory});
  }
  return labels;
}

}  // namespace beckon::intention
