// What passes through a process's bus, channel by channel: for STATUS, and for tests.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "services/base/utime.h"

namespace beckon {

/// One channel's messages. Counts are since the start; peaks since the last ForgetPeaks.
struct ChannelTraffic {
  int64_t received = 0;
  int64_t received_bytes = 0;
  int64_t sent = 0;
  int64_t sent_bytes = 0;
  int64_t lost = 0;                        // by gaps in `seq`, of channels that have one
  std::map<std::string, int64_t> refused;  // by reason

  Utime age_us_max = 0;      // from a message's stamp to its handling, of channels with `seq`
  Utime wait_us_max = 0;     // from its arrival in this process to its handling
  Utime handler_us_max = 0;  // a handler's time

  int64_t newest_seq = 0;  // 0 = none yet

  /// Counts what is missing between the newest and `seq`. A lower number, or one that leaps, is a
  /// sender that started anew.
  void NoteSeq(int64_t seq);
  int64_t Refused() const;
  void ForgetPeaks();
};

using BusTraffic = std::map<std::string, ChannelTraffic>;  // by channel

}  // namespace beckon
