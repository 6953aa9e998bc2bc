// What the front ends need of a machine: a voice, ears, input devices, the page and its port.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "services/base/app.h"
#include "tools/beckon/doctor.h"
#include "tools/beckon/page_socket.h"

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;

constexpr char kSpeechModel[] = "/usr/share/pocketsphinx/model/en-us/en-us";

Finding CheckVoice() {
  const std::string what = "voice";
  if (!IsInPath("espeak-ng")) {
    return {Grade::kWarn, what, "no espeak-ng: nothing is spoken", "apt-get install espeak-ng"};
  }
  if (!IsInPath("aplay")) {
    return {Grade::kWarn, what, "espeak-ng is here, but nothing to play with",
            "apt-get install alsa-utils, or name another player in the configuration"};
  }
  return {Grade::kOk, what, "espeak-ng and aplay", {}};
}

Finding CheckEars() {
  const std::string what = "speech recognition";
  if (!fs::exists(kSpeechModel)) {
    return {Grade::kWarn, what, std::string("no model (") + kSpeechModel + ")",
            "apt-get install pocketsphinx-en-us"};
  }
  if (!IsInPath("arecord")) {
    return {Grade::kWarn, what, "the model is here, but nothing to record with",
            "apt-get install alsa-utils, or name another recorder in the configuration"};
  }
  return {Grade::kOk, what, "its model and arecord", {}};
}

Finding CheckSwitches() {
  const std::string what = "switches";
  int devices = 0, readable = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/input", ignored)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    ++devices;
    readable += access(entry.path().c_str(), R_OK) == 0;
  }
  const std::string found =
      std::to_string(readable) + " of " + std::to_string(devices) + " input devices can be read";
  if (devices > 0 && readable == 0) {
    return {Grade::kWarn, what, found, "add this user to the group 'input', and log in again"};
  }
  return {Grade::kOk, what, devices == 0 ? "no input device is attached" : found, {}};
}

Finding CheckPage() {
  const std::string what = "page";
  if (!fs::exists(SharedFile("web/index.html"))) {
    return {Grade::kWarn, what, SharedFile("web/index.html") + " is not there",
            "install the files that ship with Beckon"};
  }
  const int port = PageSocket::kDefaultPort;
  if (!PageSocket::Listen(port)) {
    return {Grade::kWarn, what, "port " + std::to_string(port) + " is taken",
            "fine where Beckon has it; else choose another by --port"};
  }
  return {Grade::kOk, what, "its files, and port " + std::to_string(port) + " is free", {}};
}

}  // namespace

bool IsInPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  const std::string folders = path != nullptr ? path : "/usr/bin";
  for (size_t at = 0; at <= folders.size();) {
    const size_t end = std::min(folders.find(':', at), folders.size());
    if (access((folders.substr(at, end - at) + "/" + program).c_str(), X_OK) == 0) return true;
    at = end + 1;
  }
  return false;
}

std::vector<Finding> CheckFrontEnds() {
  return {CheckVoice(), CheckEars(), CheckSwitches(), CheckPage()};
}

}  // namespace beckon::tool
