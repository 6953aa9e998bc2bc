#include "services/intention/core/name_watch.h"

namespace beckon::intention {
namespace {

constexpr int kMessages = 3;
constexpr Utime kFor = 2 * kSecond;

}  // namespace

bool NameWatch::IsAnother(const msg::History& message, const std::string& name,
                          const Instant& now) {
  if (message.machine != name || message.run == run_ || message.utime <= started_) return false;
  if (message.run != suspect_) {
    suspect_ = message.run;
    first_heard_ = now.steady;
    last_utime_ = 0;
    heard_ = 0;
  }
  if (message.utime <= last_utime_) return false;
  last_utime_ = message.utime;
  ++heard_;
  return heard_ >= kMessages && now.steady - first_heard_ >= kFor;
}

}  // namespace beckon::intention
