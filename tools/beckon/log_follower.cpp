#include "tools/beckon/log_follower.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "tools/beckon/log_index_text.h"

namespace beckon::tool {

namespace fs = std::filesystem;

Result<LogFollower> LogFollower::Open(const std::string& log) {
  auto reader = LogReader::Open(log);
  if (!reader) return reader.error();
  return LogFollower(log, *std::move(reader));
}

bool LogFollower::Read() {
  bool any = false;
  while (const auto message = reader_.Next()) {
    indexer_.Add(*message);
    any = true;
  }
  return any;
}

Status LogFollower::WriteIndex() const {
  const std::string beside = IndexFile() + ".new";
  std::ofstream file(beside, std::ios::binary);
  file << IndexJson(index(), fs::path(log_).filename().string());
  file.close();
  std::error_code failed;
  if (file) fs::rename(beside, IndexFile(), failed);
  if (!file || failed) return Error{IndexFile() + ": cannot be written"};
  return {};
}

std::string LogFollower::Damage() const {
  std::string text;
  if (reader_.skipped_bytes() > 0) {
    text = std::to_string(reader_.skipped_bytes()) +
           " bytes amid it belong to no message and are left out";
  }
  if (reader_.cut()) {
    text += (text.empty() ? "" : "; ") + std::string("it ends amid a message, at byte ") +
            std::to_string(reader_.position()) + ": whoever wrote it was cut off";
  }
  return text;
}

}  // namespace beckon::tool
