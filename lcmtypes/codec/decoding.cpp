// DECODING: what a decoder of brain signals made of a trial.
#include <beckon/decoding_t.hpp>
#include <cmath>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static void Walk(Walker& w, const decoding_t*) {
  w.Skip(8);
  w.String("decoder", kMaxName);
  w.String("device", kMaxName);
  w.Skip(8);
  w.Skip(static_cast<size_t>(w.Count("n_probabilities", kMaxOptions)) * 8);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Decoding& decoding) {
  Rules rules("decoding");
  rules.Time(decoding.utime)
      .Name(decoding.decoder, "decoder", kMaxName)
      .Name(decoding.device, "device", kMaxName)
      .Require(decoding.trial >= 1, "trial is below 1")
      .Count(decoding.probabilities.size(), "probabilities", kMaxOptions, 2)
      .Require(Check(decoding.seal));
  double sum = 0;
  for (const double p : decoding.probabilities) {
    rules.Range(p, "probabilities", 0, 1 + 1e-3);
    sum += p;
  }
  rules.Require(std::abs(sum - 1) <= 1e-3, "probabilities do not sum to 1");
  return rules;
}

static decoding_t ToWire(const msg::Decoding& decoding) {
  decoding_t wire{};
  wire.utime = decoding.utime;
  wire.decoder = decoding.decoder;
  wire.device = decoding.device;
  wire.trial = decoding.trial;
  wire.n_probabilities = static_cast<int32_t>(decoding.probabilities.size());
  wire.probabilities = decoding.probabilities;
  wire.seal = ToWire(decoding.seal);
  return wire;
}

static Result<msg::Decoding> FromWire(const decoding_t& wire) {
  msg::Decoding decoding;
  decoding.utime = wire.utime;
  decoding.decoder = wire.decoder;
  decoding.device = wire.device;
  decoding.trial = wire.trial;
  decoding.probabilities = wire.probabilities;
  decoding.seal = FromWire(wire.seal);
  return decoding;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Decoding, decoding_t)

}  // namespace beckon
