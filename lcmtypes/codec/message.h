// The frame every codec fits in. A message type brings four functions:
//   void Walk(Walker&, const Wire*)           its layout, in the order of the .lcm file
//   Status Check(const msg::T&)               its rules, for what we send and for what we receive
//   Wire ToWire(const msg::T&)                for a value that passed Check
//   Result<msg::T> FromWire(const Wire&)      for bytes that passed Walk
#pragma once

#include <span>
#include <vector>

#include "lcmtypes/codec/walker.h"
#include "lcmtypes/messages.h"
#include "services/base/result.h"

namespace beckon::codec {

template <typename Wire, typename T>
Result<std::vector<uint8_t>> EncodeMessage(const T& value, Status (*check)(const T&),
                                           Wire (*to_wire)(const T&),
                                           size_t max_bytes = msg::kMaxDatagram) {
  if (Status checked = check(value); !checked) return checked.error();
  const Wire wire = to_wire(value);
  std::vector<uint8_t> bytes(static_cast<size_t>(wire.getEncodedSize()));
  if (bytes.size() > max_bytes) {
    return Error{std::string(Wire::getTypeName()) + ": " + std::to_string(bytes.size()) +
                 " bytes encoded, at most " + std::to_string(max_bytes) + " may be sent"};
  }
  wire.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

template <typename Wire, typename T>
Result<T> DecodeMessage(std::span<const uint8_t> bytes, void (*walk)(Walker&, const Wire*),
                        Result<T> (*from_wire)(const Wire&), Status (*check)(const T&)) {
  const auto refuse = [](const std::string& why) {
    return Error{std::string(Wire::getTypeName()) + ": " + why};
  };
  Walker walker(bytes);
  walker.Fingerprint(Wire::getHash());
  walk(walker, nullptr);
  walker.End();
  if (!walker.ok()) return refuse(walker.error());
  Wire wire;
  if (wire.decode(bytes.data(), 0, static_cast<int>(bytes.size())) !=
      static_cast<int>(bytes.size())) {
    return refuse("does not decode");
  }
  Result<T> value = from_wire(wire);
  if (!value) return refuse(value.error().message);
  if (Status checked = check(*value); !checked) return checked.error();
  return value;
}

}  // namespace beckon::codec

/// Codec<msg::Type> out of the four functions; for all but frames, which carry a checksum.
#define BECKON_DEFINE_CODEC(Type, wire_t)                                               \
  Result<std::vector<uint8_t>> Codec<msg::Type>::Encode(const msg::Type& value) {       \
    return codec::EncodeMessage<wire_t>(value, codec::Check, codec::ToWire);            \
  }                                                                                     \
  Result<msg::Type> Codec<msg::Type>::Decode(std::span<const uint8_t> bytes) {          \
    return codec::DecodeMessage<wire_t, msg::Type>(bytes, codec::Walk, codec::FromWire, \
                                                   codec::Check);                       \
  }
