// ANSWER: evidence for each option of a question.
#include <algorithm>
#include <beckon/answer_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static void Walk(Walker& w, const answer_t*) {
  w.Skip(8 + 8);
  w.String("session_id", kMaxName);
  w.String("device", kMaxName);
  w.Skip(static_cast<size_t>(w.Count("n_likelihoods", kMaxOptions)) * 8);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Answer& answer) {
  Rules rules("answer");
  rules.Time(answer.utime)
      .Require(answer.query_id >= 1, "query_id is below 1")
      .Name(answer.session_id, "session_id")
      .Name(answer.device, "device")
      .Count(answer.likelihoods.size(), "likelihoods", kMaxOptions, 2)
      .Require(Check(answer.seal));
  for (double likelihood : answer.likelihoods) rules.Range(likelihood, "likelihood", 0, 1e12);
  rules.Require(std::ranges::any_of(answer.likelihoods, [](double l) { return l > 0; }),
                "every likelihood is zero");
  return rules;
}

static answer_t ToWire(const msg::Answer& answer) {
  answer_t wire{};
  wire.utime = answer.utime;
  wire.query_id = answer.query_id;
  wire.session_id = answer.session_id;
  wire.device = answer.device;
  wire.n_likelihoods = static_cast<int32_t>(answer.likelihoods.size());
  wire.likelihoods = answer.likelihoods;
  wire.seal = ToWire(answer.seal);
  return wire;
}

static Result<msg::Answer> FromWire(const answer_t& wire) {
  msg::Answer answer;
  answer.utime = wire.utime;
  answer.query_id = wire.query_id;
  answer.session_id = wire.session_id;
  answer.device = wire.device;
  answer.likelihoods = wire.likelihoods;
  answer.seal = FromWire(wire.seal);
  return answer;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Answer, answer_t)

}  // namespace beckon
