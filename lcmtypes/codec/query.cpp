// QUERY: a question.
#include <beckon/query_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {

const char* msg::Name(QueryKind kind) {
  switch (kind) {
    case QueryKind::kAction:
      return "action";
    case QueryKind::kObject:
      return "object";
    case QueryKind::kFull:
      return "full";
    case QueryKind::kCategory:
      return "category";
    case QueryKind::kSet:
      return "set";
    case QueryKind::kChoice:
      return "choice";
    case QueryKind::kWhatIsIt:
      return "what_is_it";
  }
  return "unknown";
}

namespace codec {

static void Walk(Walker& w, const option_t*) {
  w.String("option.text", kMaxText);
  w.String("option.category", kMaxName);
  const int32_t actions = w.Count("option.n_actions", kMaxOptions);
  for (int32_t i = 0; i < actions && w.ok(); ++i) w.String("option.action", kMaxName);
  w.Skip(static_cast<size_t>(w.Count("option.n_objects", msg::kMaxObjects)) * 4);
}

static void Walk(Walker& w, const candidate_t*) {
  w.String("candidate.action", kMaxName);
  Walk(w, static_cast<const object_ref_t*>(nullptr));
  w.Skip(8 + 8 + 4 + 4);
}

static void Walk(Walker& w, const query_t*) {
  w.Skip(8 + 8);
  w.String("session_id", kMaxName);
  w.String("user", kMaxName);
  w.Skip(1);
  w.String("text", kMaxText);
  w.Skip(1);
  const int32_t actions = w.Count("n_actions", kMaxOptions);
  for (int32_t i = 0; i < actions && w.ok(); ++i) w.String("action", kMaxName);
  w.Skip(1);
  const int32_t objects = w.Count("n_objects", msg::kMaxObjects);
  for (int32_t i = 0; i < objects && w.ok(); ++i)
    Walk(w, static_cast<const object_ref_t*>(nullptr));
  const int32_t options = w.Count("n_options", kMaxOptions);
  for (int32_t i = 0; i < options && w.ok(); ++i) Walk(w, static_cast<const option_t*>(nullptr));
  w.Skip(8 + 4 + 4 + 8 + 8 + 8);
  w.String("why", kMaxText);
  w.Skip(8);
  w.Skip(static_cast<size_t>(w.Count("n_prospects", kMaxOptions)) * 3 * 4);
  const int32_t likeliest = w.Count("n_likeliest", msg::kMaxCandidates);
  for (int32_t i = 0; i < likeliest && w.ok(); ++i)
    Walk(w, static_cast<const candidate_t*>(nullptr));
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Option& option) {
  Rules rules("option");
  rules.Name(option.text, "text", kMaxText)
      .Text(option.category, "category", kMaxName)
      .Count(option.actions.size(), "actions", kMaxOptions)
      .Count(option.objects.size(), "objects", msg::kMaxObjects);
  for (const auto& action : option.actions) rules.Name(action, "action");
  for (int id : option.objects) rules.Range(id, "objects", 1, 1e9);
  return rules;
}

static Status Check(const msg::Prospect& prospect) {
  return Rules("prospect")
      .Range(prospect.probability, "probability", 0, 1)
      .Range(prospect.questions_left, "questions_left", 0, 1e6)
      .Range(prospect.seconds_left, "seconds_left", 0, 1e9);
}

static Status Check(const msg::Candidate& candidate) {
  return Rules("candidate")
      .Name(candidate.action, "action")
      .Require(Check(candidate.object))
      .Range(candidate.prior, "prior", 0, 1)
      .Range(candidate.posterior, "posterior", 0, 1)
      .Range(candidate.times, "times", 0, 1e9)
      .Range(candidate.sessions_ago, "sessions_ago", 0, 1e9)
      .Require((candidate.times == 0) == (candidate.sessions_ago == 0),
               "times and sessions_ago do not agree");
}

static Status Check(const msg::Query& query) {
  Rules rules("query");
  rules.Time(query.utime)
      .Require(query.id >= 1, "id is below 1")
      .Name(query.session_id, "session_id")
      .Name(query.user, "user")
      .Range(static_cast<int>(query.kind), "kind", 1, 7)
      .Name(query.text, "text", kMaxText)
      .Count(query.actions.size(), "actions", kMaxOptions)
      .Count(query.objects.size(), "objects", msg::kMaxObjects)
      .Count(query.options.size(), "options", kMaxOptions, 2)
      .Require(query.scene_seq >= 1, "scene_seq is below 1")
      .Require(query.questions_asked >= 0 && query.n_candidates >= 0, "a count is negative")
      .Range(query.expected_questions, "expected_questions", 0, 1e6)
      .Range(query.expected_seconds, "expected_seconds", 0, 1e9)
      .Range(query.best_posterior, "best_posterior", 0, 1)
      .Text(query.why, "why")
      .Range(query.information_bits, "information_bits", 0, 64)
      .Require(query.prospects.empty() || query.prospects.size() == query.options.size(),
               "prospects are neither none nor one an option")
      .Count(query.likeliest.size(), "likeliest", msg::kMaxCandidates)
      .Require(query.kind != msg::QueryKind::kWhatIsIt || query.objects.size() == 1,
               "what_is_it asks about exactly one object")
      .Require(Check(query.seal));
  for (const auto& action : query.actions) rules.Name(action, "action");
  for (const auto& object : query.objects) rules.Require(Check(object));
  for (const auto& option : query.options) rules.Require(Check(option));
  for (const auto& prospect : query.prospects) rules.Require(Check(prospect));
  for (const auto& candidate : query.likeliest) rules.Require(Check(candidate));
  return rules;
}

static option_t ToWire(const msg::Option& option) {
  option_t wire{};
  wire.text = option.text;
  wire.category = option.category;
  wire.n_actions = static_cast<int32_t>(option.actions.size());
  wire.actions = option.actions;
  wire.n_objects = static_cast<int32_t>(option.objects.size());
  wire.objects = option.objects;
  return wire;
}

static prospect_t ToWire(const msg::Prospect& prospect) {
  prospect_t wire{};
  wire.probability = prospect.probability;
  wire.questions_left = prospect.questions_left;
  wire.seconds_left = prospect.seconds_left;
  return wire;
}

static candidate_t ToWire(const msg::Candidate& candidate) {
  candidate_t wire{};
  wire.action = candidate.action;
  wire.object = ToWire(candidate.object);
  wire.prior = candidate.prior;
  wire.posterior = candidate.posterior;
  wire.times = candidate.times;
  wire.sessions_ago = candidate.sessions_ago;
  return wire;
}

static query_t ToWire(const msg::Query& query) {
  query_t wire{};
  wire.utime = query.utime;
  wire.id = query.id;
  wire.session_id = query.session_id;
  wire.user = query.user;
  wire.kind = static_cast<int8_t>(query.kind);
  wire.text = query.text;
  wire.any_action = query.any_action;
  wire.n_actions = static_cast<int32_t>(query.actions.size());
  wire.actions = query.actions;
  wire.any_object = query.any_object;
  wire.n_objects = static_cast<int32_t>(query.objects.size());
  for (const auto& object : query.objects) wire.objects.push_back(ToWire(object));
  wire.n_options = static_cast<int32_t>(query.options.size());
  for (const auto& option : query.options) wire.options.push_back(ToWire(option));
  wire.scene_seq = query.scene_seq;
  wire.questions_asked = query.questions_asked;
  wire.n_candidates = query.n_candidates;
  wire.expected_questions = query.expected_questions;
  wire.expected_seconds = query.expected_seconds;
  wire.best_posterior = query.best_posterior;
  wire.why = query.why;
  wire.information_bits = query.information_bits;
  wire.n_prospects = static_cast<int32_t>(query.prospects.size());
  for (const auto& prospect : query.prospects) wire.prospects.push_back(ToWire(prospect));
  wire.n_likeliest = static_cast<int32_t>(query.likeliest.size());
  for (const auto& candidate : query.likeliest) wire.likeliest.push_back(ToWire(candidate));
  wire.seal = ToWire(query.seal);
  return wire;
}

static Result<msg::Query> FromWire(const query_t& wire) {
  if (!IsBool(wire.any_action) || !IsBool(wire.any_object))
    return Error{"a flag is neither 0 nor 1"};
  msg::Query query;
  query.utime = wire.utime;
  query.id = wire.id;
  query.session_id = wire.session_id;
  query.user = wire.user;
  query.kind = static_cast<msg::QueryKind>(wire.kind);
  query.text = wire.text;
  query.any_action = wire.any_action != 0;
  query.actions = wire.actions;
  query.any_object = wire.any_object != 0;
  for (const auto& object : wire.objects) query.objects.push_back(FromWire(object));
  for (const auto& option : wire.options) {
    query.options.push_back({option.text, option.category, option.actions, option.objects});
  }
  query.scene_seq = wire.scene_seq;
  query.questions_asked = wire.questions_asked;
  query.n_candidates = wire.n_candidates;
  query.expected_questions = wire.expected_questions;
  query.expected_seconds = wire.expected_seconds;
  query.best_posterior = wire.best_posterior;
  query.why = wire.why;
  query.information_bits = wire.information_bits;
  for (const auto& p : wire.prospects)
    query.prospects.push_back({p.probability, p.questions_left, p.seconds_left});
  for (const auto& c : wire.likeliest) {
    query.likeliest.push_back(
        {c.action, FromWire(c.object), c.prior, c.posterior, c.times, c.sessions_ago});
  }
  query.seal = FromWire(wire.seal);
  return query;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Query, query_t)

}  // namespace beckon
