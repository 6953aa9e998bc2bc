// STIMULUS: what a decoder of brain signals is to decode.
#include <beckon/stimulus_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kMostRepetitions = 1'000'000;

static void Walk(Walker& w, const stimulus_t*) {
  w.Skip(8);
  w.String("device", kMaxName);
  w.Skip(8 + 8 + 4 + 1 + 4 + 4);
  const int32_t labels = w.Count("n_labels", kMaxOptions);
  for (int32_t i = 0; i < labels && w.ok(); ++i) w.String("label", kMaxText);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Stimulus& stimulus) {
  const size_t classes = static_cast<size_t>(stimulus.rows) * static_cast<size_t>(stimulus.columns);
  Rules rules("stimulus");
  rules.Time(stimulus.utime)
      .Name(stimulus.device, "device", kMaxName)
      .Require(stimulus.trial >= 1, "trial is below 1")
      .Require(stimulus.query_id >= 0, "query_id is negative")
      .Range(stimulus.repetition, "repetition", 1, kMostRepetitions)
      .Range(static_cast<int>(stimulus.mode), "mode", 1, 2)
      .Range(stimulus.rows, "rows", 1, kMaxOptions)
      .Range(stimulus.columns, "columns", 1, kMaxOptions)
      .Count(classes, "classes", kMaxOptions, 2)
      .Require(stimulus.labels.size() == classes, "labels: expected one a class")
      .Require(Check(stimulus.seal));
  for (const auto& label : stimulus.labels) rules.Text(label, "labels");
  return rules;
}

static stimulus_t ToWire(const msg::Stimulus& stimulus) {
  stimulus_t wire{};
  wire.utime = stimulus.utime;
  wire.device = stimulus.device;
  wire.trial = stimulus.trial;
  wire.query_id = stimulus.query_id;
  wire.repetition = stimulus.repetition;
  wire.mode = static_cast<int8_t>(stimulus.mode);
  wire.rows = stimulus.rows;
  wire.columns = stimulus.columns;
  wire.n_labels = static_cast<int32_t>(stimulus.labels.size());
  wire.labels = stimulus.labels;
  wire.seal = ToWire(stimulus.seal);
  return wire;
}

static Result<msg::Stimulus> FromWire(const stimulus_t& wire) {
  msg::Stimulus stimulus;
  stimulus.utime = wire.utime;
  stimulus.device = wire.device;
  stimulus.trial = wire.trial;
  stimulus.query_id = wire.query_id;
  stimulus.repetition = wire.repetition;
  stimulus.mode = static_cast<msg::StimulusMode>(wire.mode);
  stimulus.rows = wire.rows;
  stimulus.columns = wire.columns;
  stimulus.labels = wire.labels;
  stimulus.seal = FromWire(wire.seal);
  return stimulus;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Stimulus, stimulus_t)

}  // namespace beckon
