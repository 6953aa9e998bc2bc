// Notices that another machine goes by one's own name: a copied disk, or two of one name.
#pragma once

#include "lcmtypes/messages.h"
#include "services/intention/core/history_sync.h"

namespace beckon::intention {

class NameWatch {
 public:
  /// `started`: when this run began, by the clock on the wall.
  NameWatch(std::string run, Utime started) : run_(std::move(run)), started_(started) {}

  /// A message of `name`'s. True once it is certain that another machine sends as well: another
  /// run says new things over a while, and of a time after this run began. Late, doubled or
  /// replayed messages of an earlier run of this machine say nothing new, or end.
  bool IsAnother(const msg::History& message, const std::string& name, const Instant& now);

 private:
  const std::string run_;
  const Utime started_;
  std::string suspect_;  // its run
  Utime first_heard_ = 0;
  Utime last_utime_ = 0;
  int heard_ = 0;
};

}  // namespace beckon::intention
