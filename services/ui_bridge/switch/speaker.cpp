#include "services/ui_bridge/switch/speaker.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <system_error>
#include <utility>

extern char** environ;

namespace beckon::ui_bridge {
namespace {

constexpr Utime kLook_us = 100'000;
constexpr size_t kLongest = 2000;  // bytes of a sentence
constexpr int kNoProgram = 127;    // what a child that could not start ends with

/// Starts it with no signal blocked (the loop blocks some) and nothing on its standard output.
int Spawn(const std::vector<std::string>& words, int& error) {
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  error = posix_spawnp(&child, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  return error == 0 ? child : -1;
}

}  // namespace

Speaker::Speaker(std::vector<std::string> command, RunLoop& loop,
                 std::function<void(const std::string&)> tell)
    : command_(std::move(command)), loop_(loop), tell_(std::move(tell)) {}

Speaker::~Speaker() {
  CutOff();
  for (const int child : dying_) waitpid(child, nullptr, 0);
  if (timer_) loop_.Cancel(*timer_);
}

void Speaker::Say(const std::string& text) {
  CutOff();
  if (missing_ || command_.empty() || text.empty()) return;
  std::vector<std::string> words = command_;
  words.push_back("--");  // a sentence is no option, whatever it begins with
  words.push_back(text.substr(0, kLongest));
  int error = 0;
  child_ = Spawn(words, error);
  if (child_ < 0) {
    missing_ = true;
    return Tell(std::generic_category().message(error));
  }
  if (!timer_) timer_ = loop_.Every(kLook_us, [this] { Look(); });
}

void Speaker::CutOff() {
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  dying_.push_back(std::exchange(child_, -1));
}

void Speaker::Look() {
  std::erase_if(dying_, [](int child) { return waitpid(child, nullptr, WNOHANG) != 0; });
  int status = 0;
  if (child_ > 0 && waitpid(child_, &status, WNOHANG) == child_) {
    child_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) != 0) {
      missing_ = WEXITSTATUS(status) == kNoProgram;
      Tell(missing_ ? "it cannot be started"
                    : "it ended with " + std::to_string(WEXITSTATUS(status)));
    }
  }
  if (child_ <= 0 && dying_.empty()) loop_.Cancel(*std::exchange(timer_, std::nullopt));
}

void Speaker::Tell(const std::string& why) {
  if (std::exchange(told_, true)) return;
  tell_("There is no voice: " + command_[0] + ": " + why + ". It goes on without.");
}

}  // namespace beckon::ui_bridge
