// LCM logs that tests write.
#pragma once

#include <lcm/eventlog.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "lcmtypes/codec.h"

namespace beckon::tool {

class WrittenLog {
 public:
  explicit WrittenLog(const std::string& path) : log_(lcm_eventlog_create(path.c_str(), "w")) {}
  ~WrittenLog() { lcm_eventlog_destroy(log_); }
  WrittenLog(const WrittenLog&) = delete;
  WrittenLog& operator=(const WrittenLog&) = delete;

  void AddBytes(Utime utime, std::string channel, std::vector<uint8_t> data) {
    lcm_eventlog_event_t event{};
    event.timestamp = utime;
    event.channellen = static_cast<int32_t>(channel.size());
    event.datalen = static_cast<int32_t>(data.size());
    event.channel = channel.data();
    event.data = data.data();
    lcm_eventlog_write_event(log_, &event);
  }
  template <typename T>
  void Add(Utime utime, const T& message) {
    AddBytes(utime, Codec<T>::kChannel, *Codec<T>::Encode(message));
  }

 private:
  lcm_eventlog_t* log_;
};

inline std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void WriteFile(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace beckon::tool
