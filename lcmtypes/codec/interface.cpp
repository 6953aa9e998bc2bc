// INTERFACE: what a front end can do.
#include <beckon/interface_t.hpp>
#include <cmath>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static void Walk(Walker& w, const interface_t*) {
  w.Skip(8);
  w.String("device", kMaxName);
  w.Skip(1 + 4 + 4 * 4);
  const auto k = static_cast<size_t>(w.Count("n_confusion", kMaxOptions));
  w.Skip(k * k * 4);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Interface& interface) {
  Rules rules("interface");
  rules.Time(interface.utime)
      .Name(interface.device, "device")
      .Range(static_cast<int>(interface.kind), "kind", 1, 4)
      .Range(interface.max_options, "max_options", 2, kMaxOptions)
      .Range(interface.seconds_per_question, "seconds_per_question", 1e-3, 3600)
      .Range(interface.seconds_per_option, "seconds_per_option", 0, 3600)
      .Range(interface.false_yes, "false_yes", 0, 0.5)
      .Range(interface.false_no, "false_no", 0, 0.5)
      .Count(interface.confusion.size(), "confusion", kMaxOptions)
      .Require(Check(interface.seal));
  for (const auto& row : interface.confusion) {
    rules.Require(row.size() == interface.confusion.size(), "confusion is not square");
    double sum = 0;
    for (float p : row) {
      rules.Range(p, "confusion", 0, 1);
      sum += p;
    }
    rules.Require(std::abs(sum - 1) < 1e-3, "a row of confusion does not sum to 1");
  }
  return rules;
}

static interface_t ToWire(const msg::Interface& interface) {
  interface_t wire{};
  wire.utime = interface.utime;
  wire.device = interface.device;
  wire.kind = static_cast<int8_t>(interface.kind);
  wire.max_options = interface.max_options;
  wire.seconds_per_question = interface.seconds_per_question;
  wire.seconds_per_option = interface.seconds_per_option;
  wire.false_yes = interface.false_yes;
  wire.false_no = interface.false_no;
  wire.n_confusion = static_cast<int32_t>(interface.confusion.size());
  wire.confusion = interface.confusion;
  wire.seal = ToWire(interface.seal);
  return wire;
}

static Result<msg::Interface> FromWire(const interface_t& wire) {
  msg::Interface interface;
  interface.utime = wire.utime;
  interface.device = wire.device;
  interface.kind = static_cast<msg::InterfaceKind>(wire.kind);
  interface.max_options = wire.max_options;
  interface.seconds_per_question = wire.seconds_per_question;
  interface.seconds_per_option = wire.seconds_per_option;
  interface.false_yes = wire.false_yes;
  interface.false_no = wire.false_no;
  interface.confusion = wire.confusion;
  interface.seal = FromWire(wire.seal);
  return interface;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Interface, interface_t)

}  // namespace beckon
