#include "tests/faults/lab.h"

#include <fcntl.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace beckon::faults {
namespace {

namespace fs = std::filesystem;

constexpr char kEntered[] = "BECKON_FAULTS_ENTERED";
constexpr char kOwnNetwork[] = "/proc/thread-self/ns/net";
constexpr int kPatience_ms = 10'000;

Error SystemError(const std::string& what) { return Error{what + ": " + std::strerror(errno)}; }

/// A line of sh, to its end.
Status Shell(const std::string& folder, const std::string& line) {
  const std::string log = folder + "/shell.log";
  auto process = tool::ChildProcess::Start({.name = "sh",
                                            .program = "/bin/sh",
                                            .args = {"-ec", line},
                                            .log_file = log,
                                            .stdin_file = {}});
  if (!process) return process.error();
  const auto exit = process->Wait(kPatience_ms);
  if (exit && exit->signal == 0 && exit->code == 0) return {};
  return Error{"'" + line + "': " + (exit ? exit->Text() : "not done in time") + ": " +
               tool::LastLine(log)};
}

/// Frames of a virtual link carry no checksums unless the sender is told to make them, and the
/// relay makes none.
Status MakeChecksums(const char* interface) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return SystemError("no socket");
  ethtool_value off{.cmd = ETHTOOL_STXCSUM, .data = 0};
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  request.ifr_data = reinterpret_cast<char*>(&off);
  const bool done = ioctl(fd, SIOCETHTOOL, &request) == 0;
  const Error failed = SystemError(std::string(interface) + ": checksums cannot be had");
  close(fd);
  if (!done) return failed;
  return {};
}

}  // namespace

Status EnterLabNamespaces(char** argv) {
  if (std::getenv(kEntered) != nullptr) return {};
  // A child may fail where exec would leave nothing to tell of it.
  auto trial = tool::ChildProcess::Start(
      {.name = "unshare", .program = "unshare", .args = {"-rnm", "true"}, .stdin_file = {}});
  const auto exit = trial ? trial->Wait(kPatience_ms) : std::nullopt;
  if (!exit || exit->signal != 0 || exit->code != 0)
    return Error{"user namespaces are not allowed here (unshare -rnm true fails)"};
  setenv(kEntered, "1", 1);
  std::error_code none;
  std::string self = fs::read_symlink("/proc/self/exe", none).string();
  std::string unshare = "unshare", flags = "-rnm";
  std::vector<char*> args{unshare.data(), flags.data(), self.data()};
  for (char** arg = argv + 1; *arg != nullptr; ++arg) args.push_back(*arg);
  args.push_back(nullptr);
  execvp(args[0], args.data());
  return SystemError("unshare");
}

Result<std::unique_ptr<Lab>> Lab::Make(const std::vector<HostSpec>& hosts, uint64_t seed, int mtu) {
  auto folder = tool::RunFolder::Make("", "beckon-faults");
  if (!folder) return folder.error();
  std::unique_ptr<Lab> lab(new Lab(*std::move(folder)));
  lab->outside_ = open(kOwnNetwork, O_RDONLY | O_CLOEXEC);
  if (lab->outside_ < 0) return SystemError(kOwnNetwork);
  std::vector<std::string> ports;
  for (const auto& host : hosts) {
    if (auto added = lab->AddHost(host, mtu); !added) return added.error();
    ports.push_back("port" + std::to_string(ports.size()));
  }
  if (auto introduced = lab->Introduce(hosts); !introduced) return introduced.error();
  auto relay = Relay::Start(ports, seed);
  if (!relay) return relay.error();
  lab->relay_ = *std::move(relay);
  return lab;
}

Lab::~Lab() {
  relay_.reset();
  for (const Host& host : hosts_) close(host.network);
  // Links go with the networks of the hosts, but later than this.
  for (size_t i = 0; i < hosts_.size(); ++i)
    (void)Shell(folder_.path(), "ip link del port" + std::to_string(i));
  if (outside_ >= 0) close(outside_);
}

Status Lab::AddHost(const HostSpec& spec, int mtu) {
  Host host{spec.name, folder_.path() + "/" + spec.name};
  fs::create_directories(host.folder);
  if (unshare(CLONE_NEWNET) != 0) return SystemError("no network for " + spec.name);
  host.network = open(kOwnNetwork, O_RDONLY | O_CLOEXEC);
  if (setns(outside_, CLONE_NEWNET) != 0 || host.network < 0)
    throw std::runtime_error("cannot return to the relay's network");
  hosts_.push_back(host);
  const std::string index = std::to_string(hosts_.size() - 1), port = "port" + index,
                    mtu_is = " mtu " + std::to_string(mtu);
  const std::string network =
      "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(host.network);
  auto linked =
      Shell(host.folder,
            "ip link add " + port + mtu_is + " type veth peer name eth0" + mtu_is + " netns " +
                network + " && ip link set " + port + " up && nsenter --net=" + network +
                " sh -ec 'ip link set lo up; ip addr add 10.76.0." + std::to_string(hosts_.size()) +
                "/24 dev eth0; ip link set eth0 up; "
                "ip route add 224.0.0.0/4 dev eth0'");
  if (!linked) return linked;
  Status made;
  In(hosts_.size() - 1, [&] { made = MakeChecksums("eth0"); });
  return made;
}

Status Lab::Introduce(const std::vector<HostSpec>& specs) {
  std::vector<std::string> files;
  for (size_t i = 0; i < specs.size(); ++i) {
    auto file = keys(i).Make(specs[i].name, specs[i].may);
    if (!file) return file.error();
    files.push_back(*file);
  }
  for (size_t to = 0; to < specs.size(); ++to) {
    for (size_t of = 0; of < specs.size(); ++of) {
      if (of == to || !specs[of].trusted) continue;
      if (auto taken = keys(to).Trust(files[of], std::nullopt); !taken) return taken.error();
    }
  }
  return {};
}

trust::KeyFolder Lab::keys(size_t host) const {
  return trust::KeyFolder(hosts_[host].folder + "/keys");
}

std::string Lab::LcmUrl() { return "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=2097152"; }

tool::ProcessSpec Lab::At(size_t host, const tool::ProcessSpec& spec,
                          const std::vector<std::string>& environment) const {
  const Host& at = hosts_[host];
  tool::ProcessSpec wrapped = spec;
  wrapped.program = "nsenter";
  wrapped.args = {"--net=/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(at.network),
                  "env", "BECKON_KEYS=" + keys(host).path(), "XDG_DATA_HOME=" + at.folder};
  wrapped.args.insert(wrapped.args.end(), environment.begin(), environment.end());
  wrapped.args.push_back(spec.program);
  wrapped.args.insert(wrapped.args.end(), spec.args.begin(), spec.args.end());
  return wrapped;
}

void Lab::In(size_t host, const std::function<void()>& work) const {
  if (setns(hosts_[host].network, CLONE_NEWNET) != 0)
    throw std::runtime_error("cannot enter the network of " + hosts_[host].name);
  work();
  if (setns(outside_, CLONE_NEWNET) != 0)
    throw std::runtime_error("cannot return to the relay's network");
}

std::unique_ptr<Bus> Lab::OpenBus(size_t host, const std::string& program, const Clock& clock,
                                  const std::function<void(Bus&)>& set_up) const {
  static const SteadyClock steady;
  const auto own = keys(host).Own();
  if (!own || !*own) throw std::runtime_error(hosts_[host].name + " has no key");
  std::unique_ptr<Bus> bus;
  In(host, [&] {
    auto opened = Bus::Open(
        LcmUrl(),
        std::make_unique<trust::Guard>(keys(host), **own,
                                       hosts_[host].folder + "/counter." + program, clock, steady));
    if (!opened) throw std::runtime_error(opened.error().message);
    bus = *std::move(opened);
    set_up(*bus);
  });
  return bus;
}

}  // namespace beckon::faults
