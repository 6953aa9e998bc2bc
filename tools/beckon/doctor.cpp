#include "tools/beckon/doctor.h"

#include <lcm/lcm.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "lcmtypes/codec.h"
#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "tools/beckon/catalogue.h"
#include "tools/beckon/child_process.h"
#include "tools/beckon/private_bus.h"
#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;

constexpr long kWantedBuffer = 2'097'152;  // bytes
constexpr int kProgramPatience_ms = 20'000;

Finding Ok(const std::string& what, const std::string& detail) {
  return {Grade::kOk, what, detail, {}};
}
Finding Warn(const std::string& what, const std::string& detail, const std::string& remedy) {
  return {Grade::kWarn, what, detail, remedy};
}
Finding Fail(const std::string& what, const std::string& detail, const std::string& remedy) {
  return {Grade::kFail, what, detail, remedy};
}

Finding CheckLcm() {
  const std::string version = std::to_string(LCM_MAJOR_VERSION) + "." +
                              std::to_string(LCM_MINOR_VERSION) + "." +
                              std::to_string(LCM_MICRO_VERSION);
  for (const char* tool : {"lcm-logger", "lcm-logplayer"}) {
    if (!IsInPath(tool)) {
      return Warn("LCM", version + ", but no " + tool + ": nothing can be recorded or replayed",
                  "apt-get install liblcm-bin");
    }
  }
  return Ok("LCM", version + " with logger and player");
}

/// A message to ourselves: needs the multicast route.
Finding CheckBus(const std::string& lcm_url) {
  auto bus = Bus::Open(lcm_url);
  const std::string remedy =
      "ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo (as root)";
  if (!bus) return Fail("bus", "cannot be opened at " + lcm_url, remedy);
  RunLoop loop;
  bool heard = false;
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  (*bus)->Subscribe<msg::Status>([&](const msg::Status& status) {
    if (status.service != "doctor" || status.pid != getpid()) return;
    heard = true;
    loop.Stop();
  });
  msg::Status status;
  status.utime = SystemClock().Now();
  status.service = "doctor";
  status.host = "localhost";
  status.pid = getpid();
  status.started_utime = status.utime;
  status.build = VersionString();
  if (auto sent = (*bus)->Publish(status); !sent) return Fail("bus", sent.error().message, remedy);
  loop.After(kSecond / 2, [&loop] { loop.Stop(); });
  loop.Run();
  if (!heard) return Fail("bus", "a message sent at " + lcm_url + " does not come back", remedy);
  return Ok("bus", "messages come back at " + lcm_url);
}

/// Tried in a process of its own: the network cannot be left again.
Finding CheckPrivateNetwork() {
  const pid_t child = fork();
  if (child == 0) _exit(EnterPrivateBus().isolated ? 0 : 1);
  int status = 1;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return Ok("private network", "allowed; the demo keeps to itself");
  return Warn("private network", "not allowed; the demo uses a port of its own with ttl=0 instead",
              "sysctl kernel.unprivileged_userns_clone=1, or run as root");
}

Finding CheckCamera() {
  std::string devices;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("video")) devices += (devices.empty() ? "" : ", ") + entry.path().string();
  }
  const std::string found =
      devices.empty() ? "no camera is attached" : devices + " is there, but no RGB-D source";
  return Warn("camera", found + "; this version opens no live camera (OpenNI2 is not built in)",
              "use files, logs or the embedded scene");
}

/// Runs a program to its end: what it printed, in lines, or why that is nothing.
Result<std::vector<std::string>> Ask(const std::string& program,
                                     const std::vector<std::string>& args) {
  auto folder = RunFolder::Make("", "beckon-doctor");
  if (!folder) return folder.error();
  ProcessSpec spec;
  spec.name = fs::path(program).filename();
  spec.program = program;
  spec.args = args;
  spec.log_file = folder->path() + "/log";
  auto process = ChildProcess::Start(spec);
  if (!process) return process.error();
  const auto exit = process->Wait(kProgramPatience_ms);
  if (!exit) return Error{"did not come to an end"};
  if (exit->code != 0 || exit->signal != 0)
    return Error{exit->Text() + ": " + LastLine(spec.log_file)};
  std::vector<std::string> lines;
  std::ifstream log(spec.log_file);
  for (std::string line; std::getline(log, line);) lines.push_back(line);
  return lines;
}

/// Grades a program by its exit code.
Finding CheckProgram(const std::string& what, const std::string& program,
                     const std::vector<std::string>& args, const std::string& fine,
                     const std::string& remedy) {
  const auto answer = Ask(program, args);
  return answer ? Ok(what, fine) : Fail(what, answer.error().message, remedy);
}

std::vector<Finding> CheckServices(const std::string& bin_dir) {
  std::vector<Finding> findings;
  for (const std::string name : {"capture", "perception", "pose", "intention", "ui-bridge"}) {
    const std::string program = bin_dir + "/beckon-" + name;
    if (!fs::exists(program)) {
      findings.push_back(Warn(name, "is not on this machine (" + program + ")",
                              "fine where another machine runs it"));
      continue;
    }
    findings.push_back(CheckProgram(name, program, {"--check-config"},
                                    "starts, and its configuration is right", "see its message"));
  }
  return findings;
}

Finding CheckModel() {
  const std::string file = SharedFile("categories.model");
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error)
    return Warn("category model", file + ": " + error.message(),
                "objects stay Unknown; train one with beckon-train");
  return Ok("category model", file + ", " + std::to_string(size / 1024) + " kB");
}

Finding CheckAffordances() {
  const std::string file = SharedFile("affordances.toml");
  auto catalogue = Catalogue::Load(file);
  if (!catalogue)
    return Fail("affordances", catalogue.error().message,
                "restore the file that ships with Beckon");
  return Ok("affordances", std::to_string(catalogue->pairs()) + " pairs of category and action");
}

/// The model is perception's own: perception is asked what it knows.
Finding CheckCategories(const std::string& bin_dir) {
  const std::string what = "categories";
  const std::string program = bin_dir + "/beckon-perception";
  auto catalogue = Catalogue::Load(SharedFile("affordances.toml"));
  if (!catalogue || !fs::exists(program) || !fs::exists(SharedFile("categories.model")))
    return Ok(what, "not compared: model, affordances or perception are not here");
  auto known = Ask(program, {"--model", SharedFile("categories.model"), "--list-categories"});
  if (!known)
    return Fail(what, known.error().message, "restore the model that ships, or train one anew");
  std::erase(*known, msg::kUnknownCategory);  // what can be done with it stands in [unknown]
  return CompareCategories(*known, catalogue->categories());
}

Finding CheckDatabase(const DoctorOptions& options) {
  const std::string what = "database";
  if (options.db.empty()) return Ok(what, "not asked about; name it by --db FILE");
  const fs::path file(options.db);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::exists(file)) {
    if (access(folder.c_str(), W_OK) == 0) return Ok(what, options.db + " will be made");
    return Fail(what, options.db + " is missing and its folder cannot be written",
                "make the folder writable");
  }
  if (access(file.c_str(), W_OK) != 0 || access(folder.c_str(), W_OK) != 0) {
    return Fail(what, options.db + " or its folder cannot be written",
                "give this user the right to write both");
  }
  return CheckProgram(what, options.bin_dir + "/beckon-intention", {"history", "--db", options.db},
                      options.db + " opens, and its schema is known",
                      "restore it from a copy, or choose another file");
}

}  // namespace

Finding CheckUrl(const std::string& lcm_url, const std::string& keys) {
  const std::string what = "reach";
  if (!lcm_url.starts_with("udpm:")) return Ok(what, lcm_url + " is no network");
  const size_t at = lcm_url.find("ttl=");
  const int ttl = at == std::string::npos ? 0 : std::atoi(lcm_url.c_str() + at + 4);
  if (ttl == 0) return Ok(what, "ttl=0: nothing leaves this machine");
  const std::string leaves = "ttl=" + std::to_string(ttl) + ": messages leave this machine";
  if (!keys.empty()) return Ok(what, leaves + ", signed by the key in " + keys);
  return Warn(what, leaves + ", and there is no key to sign them by: the services refuse that",
              "beckon keys make, on every machine; or use ttl=0");
}

Finding CheckSocketBuffers(const std::string& lcm_url, long rmem_max) {
  const std::string what = "socket buffers";
  if (!lcm_url.starts_with("udpm:")) return Ok(what, "not used by " + lcm_url);
  if (lcm_url.find("recv_buf_size=") == std::string::npos) {
    return Fail(
        what, "the URL asks for no large buffer: most frames would be lost",
        "add recv_buf_size=" + std::to_string(kWantedBuffer) + " to --lcm-url or LCM_DEFAULT_URL");
  }
  if (rmem_max < kWantedBuffer) {
    return Warn(
        what,
        "the system gives at most " + std::to_string(rmem_max) + " bytes: large frames may be lost",
        "sysctl -w net.core.rmem_max=" + std::to_string(kWantedBuffer) + " (as root)");
  }
  return Ok(what, "up to " + std::to_string(rmem_max) + " bytes");
}

Finding CompareCategories(const std::vector<std::string>& of_model,
                          const std::vector<std::string>& of_affordances) {
  const auto only_in = [](const auto& these, const auto& those) {
    std::string names;
    for (const auto& name : these) {
      if (std::ranges::count(those, name) == 0) names += (names.empty() ? "" : ", ") + name;
    }
    return names;
  };
  const std::string unwanted = only_in(of_model, of_affordances);
  const std::string unseen = only_in(of_affordances, of_model);
  const std::string what = "categories";
  if (unwanted.empty() && unseen.empty())
    return Ok(what, "the model and affordances.toml agree on " + std::to_string(of_model.size()));
  std::string detail, remedy;
  if (!unwanted.empty()) {
    detail = "the model knows " + unwanted + ", but nothing can be done with it";
    remedy = "name it and its actions in affordances.toml [categories]";
  }
  if (!unseen.empty()) {
    const char* const also = unwanted.empty() ? "" : "; ";
    detail += also + ("affordances.toml has " + unseen + ", which the model never recognises");
    remedy += also + std::string("train a model with examples of it (docs/model.md)");
  }
  return Warn(what, detail, remedy);
}

std::vector<Finding> Examine(const DoctorOptions& options) {
  long rmem_max = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> rmem_max;
  std::vector<Finding> findings{CheckLcm(),
                                CheckUrl(options.lcm_url, options.keys),
                                CheckBus(options.lcm_url),
                                CheckSocketBuffers(options.lcm_url, rmem_max),
                                CheckPrivateNetwork(),
                                CheckCamera()};
  for (auto& finding : CheckServices(options.bin_dir)) findings.push_back(std::move(finding));
  for (auto& finding : CheckFrontEnds()) findings.push_back(std::move(finding));
  findings.push_back(CheckModel());
  findings.push_back(CheckAffordances());
  findings.push_back(CheckCategories(options.bin_dir));
  findings.push_back(CheckDatabase(options));
  findings.push_back(CheckDatabaseDisk(options.db));
  return findings;
}

std::string Render(const std::vector<Finding>& findings) {
  std::string text;
  int warned = 0, failed = 0;
  for (const auto& finding : findings) {
    const char* grade = finding.grade == Grade::kOk     ? "ok  "
                        : finding.grade == Grade::kWarn ? "warn"
                                                        : "FAIL";
    warned += finding.grade == Grade::kWarn;
    failed += finding.grade == Grade::kFail;
    text += std::string(grade) + "  " + finding.what + ": " + finding.detail + "\n";
    if (!finding.remedy.empty()) text += "      -> " + finding.remedy + "\n";
  }
  text += std::to_string(findings.size()) + " checks, " + std::to_string(warned) + " warnings, " +
          std::to_string(failed) + " failures\n";
  return text;
}

int ExitCode(const std::vector<Finding>& findings) {
  return std::ranges::any_of(findings, [](const auto& f) { return f.grade == Grade::kFail; }) ? 1
                                                                                              : 0;
}

}  // namespace beckon::tool
