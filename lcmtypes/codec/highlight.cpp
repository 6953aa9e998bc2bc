// HIGHLIGHT: what a scanning front end points at.
#include <beckon/highlight_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kMaxControls = 16;
constexpr int kLongestDwell_ms = 3'600'000;

static void Walk(Walker& w, const highlight_t*) {
  w.Skip(8);
  w.String("device", kMaxName);
  w.String("user", kMaxName);
  w.Skip(8);
  w.Skip(static_cast<size_t>(w.Count("n_options", kMaxOptions)) * 4);
  const int32_t controls = w.Count("n_controls", kMaxControls);
  for (int32_t i = 0; i < controls && w.ok(); ++i) w.String("control", kMaxName);
  w.Skip(1 + 1 + 4);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Highlight& highlight) {
  Rules rules("highlight");
  rules.Time(highlight.utime)
      .Name(highlight.device, "device", kMaxName)
      .Text(highlight.user, "user", kMaxName)
      .Require(IsUserName(highlight.user), "user: expected letters, digits, '_', '.' or '-'")
      .Require(highlight.query_id >= 0, "query_id is negative")
      .Count(highlight.options.size(), "options", kMaxOptions)
      .Count(highlight.controls.size(), "controls", kMaxControls)
      .Range(highlight.dwell_ms, "dwell_ms", 0, kLongestDwell_ms)
      .Require(Check(highlight.seal));
  for (const int option : highlight.options) rules.Range(option, "options", 0, kMaxOptions - 1);
  for (const auto& control : highlight.controls) rules.Name(control, "controls", kMaxName);
  return rules;
}

static highlight_t ToWire(const msg::Highlight& highlight) {
  highlight_t wire{};
  wire.utime = highlight.utime;
  wire.device = highlight.device;
  wire.user = highlight.user;
  wire.query_id = highlight.query_id;
  wire.n_options = static_cast<int32_t>(highlight.options.size());
  wire.options.assign(highlight.options.begin(), highlight.options.end());
  wire.n_controls = static_cast<int32_t>(highlight.controls.size());
  wire.controls = highlight.controls;
  wire.pressed = static_cast<int8_t>(highlight.pressed);
  wire.paused = static_cast<int8_t>(highlight.paused);
  wire.dwell_ms = highlight.dwell_ms;
  wire.seal = ToWire(highlight.seal);
  return wire;
}

static Result<msg::Highlight> FromWire(const highlight_t& wire) {
  if (!IsBool(wire.pressed) || !IsBool(wire.paused)) return Error{"a boolean is neither 0 nor 1"};
  msg::Highlight highlight;
  highlight.utime = wire.utime;
  highlight.device = wire.device;
  highlight.user = wire.user;
  highlight.query_id = wire.query_id;
  highlight.options.assign(wire.options.begin(), wire.options.end());
  highlight.controls = wire.controls;
  highlight.pressed = wire.pressed != 0;
  highlight.paused = wire.paused != 0;
  highlight.dwell_ms = wire.dwell_ms;
  highlight.seal = FromWire(wire.seal);
  return highlight;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Highlight, highlight_t)

}  // namespace beckon
