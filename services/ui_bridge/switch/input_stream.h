// Key presses out of the bytes of an evdev device (struct input_event, as Linux lays it out on this
// machine; on 64-bit machines 24 bytes). Pure: bytes in, presses out, whatever the bytes are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/base/utime.h"

namespace beckon::ui_bridge {

struct InputEvent {
  enum class Kind {
    kKey,  // `code` went down or up
    kLost  // the kernel's queue ran over: what is held is not known
  };
  Kind kind = Kind::kKey;
  int code = 0;  // KEY_* or BTN_* of linux/input-event-codes.h
  bool down = false;
  Utime device_us = 0;  // the device's stamp, of whichever clock; only differences mean anything
};

class InputStream {
 public:
  /// What the next bytes say. Reads may end anywhere; the rest of an event is kept. A key's
  /// repetitions (value 2) are no presses. After SYN_DROPPED everything up to the next SYN_REPORT
  /// is left out. Bytes that are no event are passed over one by one until two in a
  /// row are.
  std::vector<InputEvent> Feed(std::span<const uint8_t> bytes);
  /// The stream begins anew: half an event is forgotten.
  void Reset();

  /// Bytes that were no event, since the start.
  int64_t garbage() const { return garbage_; }

 private:
  void Take(std::vector<InputEvent>& events, const uint8_t* bytes);

  std::vector<uint8_t> rest_;
  bool dropping_ = false;
  bool in_step_ = true;  // events begin where they should
  int64_t garbage_ = 0;
};

}  // namespace beckon::ui_bridge
