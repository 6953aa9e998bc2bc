#include "services/intention/core/interview.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "services/intention/core/answer_errors.h"

namespace beckon::intention {
Interview::Interview(const Affordances& affordances, const Policy& policy, InterviewInput input)
    : affordances_(affordances), policy_(policy), input_(std::move(input)) {
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
  if (asked_object_ >= 0) {
    steps_.emplace_back(WhatIsIt{asked_object_, offer_, ThroughErrors(likelihoods, device)});
  } else {
    const Evidence evidence = InterfaceOf(device).errors.Hear(likelihoods);
    steps_.emplace_back(Heard{question_, evidence, likelihoods, device});
  }
  Recompute();
}

void Interview::NoneOfThese(const std::string& device) {
  if (asked_object_ >= 0) {
    const auto& query = std::get<msg::Query>(outcome_);
    std::vector<double> last(query.options.size(), 0.0);
    last.back() = 1;
    return Answer(last, device);
  }
  steps_.emplace_back(std::in_place_type<RefusedAll>);
  Recompute();
}

bool Interview::Undo() {
  if (steps_.empty()) return false;
  steps_.pop_back();
  Recompute();
  return true;
}

void Interview::Recompute() {
  StartOpinions();
  evidence_.clear();
  relabelled_at_ = 0;
  refused_all_ = false;
  asked_object_ = -1;
  for (const Step& step : steps_) {
    if (const auto* heard = std::get_if<Heard>(&step)) evidence_.push_back(*heard);
    if (const auto* what = std::get_if<WhatIsIt>(&step)) Apply(*what);
    if (std::holds_alternative<RefusedAll>(step)) refused_all_ = true;
  }
  std::vector<Thing> things;
  for (size_t i = 0; i < opinions_.size(); ++i) {
    const Eigen::Vector3d& place = input_.scene.objects[i].centroid_W;
    things.push_back({opinions_[i].category, std::hypot(place.x(), place.y()), place.x()});
  }
  situation_ = MakeSituation(affordances_, things);
  const int doubtful = NextInDoubt();
  doubtful >= 0 ? AskObject(doubtful, true) : AskTask();
}

Question Interview::Resolved(Question question) const {
  for (Proposition& option : question.options) {
    if (!std::has_single_bit(option.actions) || !std::has_single_bit(option.objects)) continue;
    option.pair =
        situation_.Find(std::countr_zero(option.objects), std::countr_zero(option.actions));
  }
  return question;
}

std::unique_ptr<Dialogue> Interview::Replayed(size_t from) {
  auto dialogue =
      policy_.Begin(situation_, input_.history, InterfaceOf(input_.device), input_.seed);
  prior_ = dialogue->CurrentBelief().posterior;
  for (size_t i = from; i < evidence_.size(); ++i) {
    dialogue->Hear(Resolved(evidence_[i].question), evidence_[i].evidence);
  }
  return dialogue;
}

void Interview::AskTask() {
  auto dialogue = Replayed(0);
  auto next = dialogue->Ask();
  if (!next && !dialogue->Accepted() && relabelled_at_ > 0) {
    // What was answered before an object turned out to be something else rules everything out:
    // forget it.
    dialogue = Replayed(relabelled_at_);
    next = dialogue->Ask();
  }
  if (const auto accepted = dialogue->Accepted())
    return Accept(*accepted, dialogue->CurrentBelief());
  if (next && !refused_all_) {
    question_ = *next;
    outcome_ = TaskQuery(*next, dialogue->CurrentBelief());
    return;
  }
  if (const int object = NextToRecheck(); object >= 0) return AskObject(object, false);
  outcome_ = GaveUp{Finished(situation_.pairs.empty() ? input_.phrases.nothing_to_do
                                                      : input_.phrases.none_of_the_tasks)};
}

void Interview::Accept(int pair, const Belief& belief) {
  const Pair& wanted = situation_.pairs[pair];
  const Instance& instance = situation_.objects[wanted.object];
  outcome_ = AcceptedTask{wanted.object,
                          affordances_.categories()[instance.category].name,
                          affordances_.actions()[wanted.action].name,
                          instance.rank,
                          belief.best_pair == pair ? belief.best_posterior : 1,
                          TaskText(affordances_, situation_, wanted, input_.phrases)};
}

msg::ObjectRef Interview::Ref(int object) const {
  const int category = opinions_[object].category;
  return {
      input_.scene.objects[object].id,
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

msg::Query Interview::TaskQuery(const Question& question, const Belief& belief) const {
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
  query.n_candidates = belief.possible_pairs;
  query.expected_questions = belief.expected_questions;
  query.expected_seconds = belief.expected_seconds;
  query.best_posterior = belief.best_posterior;
  Justify(query, question, belief);
  return query;
}

void Interview::AskObject(int object, bool in_doubt) {
  asked_object_ = object;
  msg::Query query;
  query.kind = msg::QueryKind::kWhatIsIt;
  query.text = Finished(input_.phrases.what_is_it);
  query.any_object = false;
  query.objects = {Ref(object)};
  const int id = input_.scene.objects[object].id;
  offer_ = Offer(object);
  for (const int category : offer_) {
    const std::string& name = affordances_.categories()[category].name;
    query.options.push_back({ANoun(input_.phrases, name), name, {}, {id}});
  }
  query.options.push_back(
      {Finished(input_.phrases.none_of_these), msg::kUnknownCategory, {}, {id}});
  query.n_candidates = situation_.pair_count();
  query.expected_questions = 1;
  JustifyWhatIsIt(query, in_doubt);
  outcome_ = std::move(query);
}

std::vector<AnswerRecord> Interview::Answers() const {
  std::vector<AnswerRecord> answers;
  const auto* task = std::get_if<AcceptedTask>(&outcome_);
  if (task == nullptr) return answers;
  const Pair wanted{task->object, affordances_.FindAction(task->action)};
  for (const Heard& step : evidence_) {
    answers.push_back(
        {step.question.kind, step.likelihoods, step.question.Meant(wanted), step.device});
  }
  return answers;
}

std::map<std::string, int> Interview::Present() const {
  std::map<std::string, int> present;
  for (const Opinion& opinion : opinions_) {
    if (opinion.category >= 0) ++present[affordances_.categories()[opinion.category].name];
  }
  return present;
}

std::vector<GivenLabel> Interview::Labels() const {
  std::vector<GivenLabel> labels;
  for (int i = 0; i < static_cast<int>(opinions_.size()); ++i) {
    const int category = opinions_[i].category;
    // Refused so far is remembered as unknown: not asked about again before every known task is.
    const bool refused = category < 0 && !opinions_[i].refused.empty();
    if (!opinions_[i].settled && !refused) continue;
    labels.push_back(
        {i, category < 0 ? msg::kUnknownCategory : affordances_.categories()[category].name});
  }
  return labels;
}

}  // namespace beckon::intention
