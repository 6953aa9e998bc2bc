#include "tools/beckon/log_tools.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <vector>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/base/status_reporter.h"
#include "tools/beckon/child_process.h"
#include "tools/beckon/log_follower.h"
#include "tools/beckon/log_index_text.h"
#include "tools/beckon/log_slice.h"
#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;

constexpr int kLoggerPatience_ms = 5000;

Status Become(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const auto& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  return Error{command[0] + " cannot be started: " + std::strerror(errno) +
               "; install the package liblcm-bin"};
}

Status CheckRecording(const std::string& log, const std::string& lcm_url) {
  if (fs::exists(log))
    return Error{"--out " + log + ": exists already; choose another name or remove it"};
  if (lcm_url.starts_with("udpm:") && lcm_url.find("recv_buf_size=") == std::string::npos) {
    return Error{"--lcm-url " + lcm_url +
                 ": without recv_buf_size=2097152 most frames are lost; add it"};
  }
  return {};
}

/// lcm-logger and the index it leaves.
class Recording {
 public:
  Recording(std::string log, RunLoop& loop, ChildProcess logger)
      : log_(std::move(log)), loop_(loop), logger_(std::move(logger)) {
    loop_.AddFd(logger_.fd(), [this] { loop_.Stop(); });
    loop_.Every(kSecond, [this] { Index(); });
  }

  /// Once the loop has ended: ends the logger, and the index. How the logger ended by itself.
  std::optional<Exit> Finish() {
    const auto early = logger_.Poll();
    if (!early) {
      logger_.Signal(SIGTERM);
      logger_.Wait(kLoggerPatience_ms);
    }
    Index();
    return early;
  }

  std::string State() const {
    if (!follower_) return "waiting for the first message, for " + log_;
    const LogIndex& index = follower_->index();
    return log_ + ": " + std::to_string(index.messages) + " messages, " +
           std::to_string(index.bytes >> 20) + " MB, " + std::to_string(index.sessions.size()) +
           " sessions";
  }

 private:
  void Index() {
    if (!follower_) {
      auto opened = LogFollower::Open(log_);
      if (!opened) return;  // not there yet
      follower_ = *std::move(opened);
    }
    if (!follower_->Read()) return;
    if (auto written = follower_->WriteIndex(); !written && !complained_) {
      complained_ = true;
      spdlog::warn("{}; the log goes on without it", written.error().message);
    }
  }

  const std::string log_;
  RunLoop& loop_;
  ChildProcess logger_;
  std::optional<LogFollower> follower_;
  bool complained_ = false;
};

/// Where the player finds what is to be played.
Result<std::string> PartOf(const std::string& log, const ReplayPart& part) {
  if (part.session.empty() && !part.from_s && !part.to_s) return log;
  auto follower = LogFollower::Open(log);
  if (!follower) return follower.error();
  follower->Read();
  const LogIndex& index = follower->index();
  LogRange range;
  if (!part.session.empty()) {
    const LoggedSession* session = index.Find(part.session);
    if (session == nullptr) {
      return Error{"--session " + part.session + ": not one of the " +
                   std::to_string(index.sessions.size()) + " sessions in " + log +
                   "; 'beckon replay LOG --list' shows them"};
    }
    range.offset = session->offset;
    range.end_offset = session->end_offset;
  }
  if (part.from_s) range.begin = index.begin + static_cast<Utime>(*part.from_s * kSecond);
  if (part.to_s) range.end = index.begin + static_cast<Utime>(*part.to_s * kSecond);
  return SliceLog(log, range);
}

/// A log with at least one message.
Status CheckLog(const std::string& log) {
  auto reader = LogReader::Open(log);
  if (!reader) return reader.error();
  if (reader->Next()) return {};
  return Error{log + ": is no LCM log; expected a log of lcm-logger or 'beckon record'"};
}

}  // namespace

Result<int> Record(const std::string& log, const std::string& lcm_url) {
  if (auto right = CheckRecording(log, lcm_url); !right) return right.error();
  RunLoop loop(/*handle_signals=*/true);
  auto bus = Bus::Open(lcm_url);
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  auto folder = RunFolder::Make("", "beckon-record");
  if (!folder) return folder.error();
  ProcessSpec spec;
  spec.name = "logger";
  spec.program = "lcm-logger";
  spec.args = {"--lcm-url=" + lcm_url, log};
  spec.log_file = folder->path() + "/lcm-logger.log";
  auto logger = ChildProcess::Start(spec);
  if (!logger) return Error{logger.error().message + "; install the package liblcm-bin"};
  std::fprintf(stderr, "Recording to %s until Ctrl-C\n", log.c_str());
  Recording recording(log, loop, *std::move(logger));
  StatusReporter reporter("recorder", **bus, loop,
                          [&recording](msg::Status& status) { status.state = recording.State(); });
  loop.Run();
  const auto early = recording.Finish();
  std::fprintf(stderr, "%s\n", recording.State().c_str());
  if (!early) return 0;
  std::fprintf(stderr, "beckon: lcm-logger ended (%s): %s\n", early->Text().c_str(),
               LastLine(spec.log_file).c_str());
  return 1;
}

Status Replay(const std::string& log, const std::string& lcm_url, double speed,
              const ReplayPart& part) {
  if (auto right = CheckLog(log); !right) return right;
  const auto played = PartOf(log, part);
  if (!played) return played.error();
  return Become(
      {"lcm-logplayer", "--speed=" + std::to_string(speed), "--lcm-url=" + lcm_url, *played});
}

Status ListLog(const std::string& log) {
  if (auto right = CheckLog(log); !right) return right;
  auto follower = LogFollower::Open(log);
  if (!follower) return follower.error();
  follower->Read();
  std::fputs(RenderIndex(follower->index()).c_str(), stdout);
  if (const std::string damage = follower->Damage(); !damage.empty())
    std::fprintf(stderr, "beckon: %s: %s\n", log.c_str(), damage.c_str());
  if (auto written = follower->WriteIndex(); !written) spdlog::info("{}", written.error().message);
  return {};
}

}  // namespace beckon::tool
