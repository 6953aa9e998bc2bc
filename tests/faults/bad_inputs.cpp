// A machine that is in trouble: its database damaged, its disk full or read-only, its clock put off
// by a day. The service says so clearly or carries on; it never promises what it has not stored.
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "tests/faults/room.h"
#include "tests/faults/run_until.h"

namespace beckon::faults {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;
constexpr Utime kDay = 86'400 * kSecond;
constexpr double kPatience_s = 20;

/// A room, and a small disk of its own for the history.
class Trouble {
 public:
  Trouble(Lab& lab, const TrialOptions& options, Verdict& verdict)
      : options_(options),
        verdict_(verdict),
        disk_(lab.folder(0) + "/disk"),
        room_(lab, 0, {{"ann", "switch", "Open", "Carton"}}, loop_) {
    fs::create_directories(disk_);
    if (mount("tmpfs", disk_.c_str(), "tmpfs", 0, "size=2m") != 0)
      throw std::runtime_error(std::string("no tmpfs: ") + std::strerror(errno));
  }
  ~Trouble() { umount2(disk_.c_str(), MNT_DETACH); }

  void DamagedDatabases() {
    Serve("history.db", "a new one");
    const std::string whole = Bytes(disk_ + "/history.db");
    std::mt19937 random(static_cast<unsigned>(options_.seed));
    std::string flipped = whole;
    for (int i = 0; i < 200; ++i)
      flipped[random() % flipped.size()] ^= static_cast<char>(1 << random() % 8);
    std::string noise(whole.size(), '\0');
    for (char& c : noise) c = static_cast<char>(random());
    const std::pair<const char*, std::string> damages[] = {
        {"noise", noise},
        {"half", whole.substr(0, whole.size() / 2)},
        {"header", std::string(100, '\0') + whole.substr(100)},
        {"text", "not a database\n"},
        {"flipped", flipped}};
    for (const auto& [name, bytes] : damages) {
      const std::string file = disk_ + "/" + name + ".db";
      std::ofstream(file, std::ios::binary) << bytes;
      MustRefuseOrServe(file);
      fs::remove(file);
    }
  }

  void FullDisk() {
    Serve("full.db", "an empty disk");
    Fill();
    MustNotPromise("full.db", "a full disk");
    fs::remove(disk_ + "/ballast");
    MustServe("full.db", "room on the disk again");
  }

  void ReadOnlyDisk() {
    Serve("readonly.db", "a disk that can be written");
    room_.KillService();  // a disk with files open for writing stays writable
    Remount(MS_RDONLY);
    MustRefuseOrServe(disk_ + "/readonly.db");
    Remount(0);
    Serve("readonly.db", "a disk that can be written again");
  }

  /// At once forward, and back again.
  void ClockJumps() {
    Serve("clock.db", "the right time");
    for (const Utime skew : {kDay, Utime{0}}) {
      room_.Jump(skew);
      MustServe("clock.db", skew > 0 ? "a clock a day ahead" : "a clock put back by a day");
    }
  }

 private:
  static std::string Bytes(const std::string& file) {
    std::stringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  }
  void Note(const std::string& what, const std::string& became) {
    verdict_.details["cases"][what] = became;
  }
  std::string Words(const std::string& what) { return what + ": " + room_.LastWords(); }

  void Remount(unsigned long flags) {
    sync();
    if (mount("tmpfs", disk_.c_str(), nullptr, MS_REMOUNT | flags, "size=2m") != 0)
      throw std::runtime_error(std::string("the disk cannot be remounted: ") +
                               std::strerror(errno));
  }
  void Fill() {
    std::ofstream ballast(disk_ + "/ballast", std::ios::binary);
    const std::string block(4096, 'b');
    while (ballast.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
    }
  }

  void Start(const std::string& file) {
    if (auto started = room_.StartService(options_, file); !started)
      throw std::runtime_error(started.error().message);
  }
  /// A service on this file, and a session.
  void Serve(const std::string& name, const std::string& what) {
    Start(disk_ + "/" + name);
    MustServe(name, what);
  }
  void MustServe(const std::string& name, const std::string& what) {
    const size_t before = room_.Acknowledged().size();
    room_.GoOn(true);
    const bool served = RunUntil(
        loop_, [&] { return room_.Acknowledged().size() > before || room_.Ended(); }, kPatience_s);
    room_.GoOn(false);
    RunUntil(
        loop_, [] { return false; }, 0.3);
    if (!served || room_.Ended()) {
      verdict_.Breach("no session with " + Words(what));
    } else {
      Note(what, "served");
    }
    MustHold(disk_ + "/" + name, what);
    known_ = room_.Acknowledged();
  }
  /// What was acknowledged since the file was begun is in it.
  void MustHold(const std::string& file, const std::string& what) {
    std::set<std::string> fresh;
    for (const auto& id : room_.Acknowledged())
      if (!known_.contains(id)) fresh.insert(id);
    if (const auto missing = MissingIn(file, fresh); !missing.empty())
      verdict_.Breach("session " + missing[0] + " was acknowledged and is not on disk, with " +
                      what);
  }
  void MustNotPromise(const std::string& name, const std::string& what) {
    room_.GoOn(true);
    RunUntil(
        loop_, [&] { return room_.Ended().has_value(); }, 5);
    room_.GoOn(false);
    RunUntil(
        loop_, [] { return false; }, 0.3);
    if (const auto end = room_.Ended()) verdict_.Breach(end->Text() + " with " + Words(what));
    MustHold(disk_ + "/" + name, what);
    Note(what, "lives on, promises nothing; refused for want of storage: " +
                   std::to_string(room_.Counter("refused_requests")));
  }
  /// One clear line and exit code 2, the file as it was; or service.
  void MustRefuseOrServe(const std::string& file) {
    const std::string what = "the file '" + fs::path(file).stem().string() + "'",
                      bytes = Bytes(file);
    Start(file);
    RunUntil(
        loop_, [&] { return room_.Ended() || room_.speaks(); }, kPatience_s);
    const auto end = room_.Ended();
    if (!end) {
      if (!room_.speaks()) verdict_.Breach("neither service nor error with " + what);
      room_.KillService();
      Note(what, "serves: " + room_.LastWords());
      return;
    }
    if (end->signal != 0 || end->code != kBadInput)
      verdict_.Breach(end->Text() + " with " + Words(what));
    if (room_.LastWords().find(fs::path(file).filename().string()) == std::string::npos)
      verdict_.Breach("the error does not name the file: " + Words(what));
    if (Bytes(file) != bytes) verdict_.Breach("a file that was refused was changed: " + what);
    Note(what, "refused: " + room_.LastWords());
  }

  const TrialOptions options_;
  Verdict& verdict_;
  const std::string disk_;
  RunLoop loop_;
  std::set<std::string> known_;
  Room room_;
};

}  // namespace

Result<Verdict> RunBadInputs(const TrialOptions& options) {
  if (auto there = FakeTimeIsThere(); !there) return there.error();
  auto lab = Lab::Make({{"machine"}}, options.seed);
  if (!lab) return lab.error();
  Verdict verdict;
  Trouble trouble(**lab, options, verdict);
  trouble.DamagedDatabases();
  trouble.FullDisk();
  trouble.ReadOnlyDisk();
  trouble.ClockJumps();
  if (verdict.holds) {
    verdict.found =
        "each is served, or refused by a clear error that leaves the file alone; nothing is "
        "promised that is not on disk";
  }
  return verdict;
}

}  // namespace beckon::faults
