// Several hosts on one machine: a network, keys and a folder each, joined by a relay that makes
// faults.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "services/base/bus.h"
#include "services/base/trust/key_folder.h"
#include "tests/faults/relay.h"
#include "tools/beckon/child_process.h"
#include "tools/beckon/run_folder.h"

namespace beckon::faults {

/// What a host may say, as `beckon keys` would have it.
struct HostSpec {
  std::string name;
  trust::Roles may = trust::Roles::All();
  bool trusted = true;  // by the others
};

/// Makes this process root of namespaces of its own (network, mounts), by executing itself again
/// through unshare(1). Call first of all; the error says why that is not possible here.
Status EnterLabNamespaces(char** argv);

class Lab {
 public:
  /// `mtu` is of every link: with 65535 each datagram is one frame.
  static Result<std::unique_ptr<Lab>> Make(const std::vector<HostSpec>& hosts, uint64_t seed,
                                           int mtu = 1500);
  ~Lab();
  Lab(const Lab&) = delete;
  Lab& operator=(const Lab&) = delete;

  size_t size() const { return hosts_.size(); }
  Relay& relay() { return *relay_; }
  std::string folder(size_t host) const { return hosts_[host].folder; }
  trust::KeyFolder keys(size_t host) const;
  static std::string LcmUrl();

  /// The same program at a host: in its network, with its keys, and with `environment`
  /// ("NAME=VALUE").
  tool::ProcessSpec At(size_t host, const tool::ProcessSpec& spec,
                       const std::vector<std::string>& environment = {}) const;
  /// Calls `work` in the host's network; sockets made there stay there.
  void In(size_t host, const std::function<void()>& work) const;
  /// A bus at a host, signing as `program` with its key. `set_up` subscribes (LCM opens its sockets
  /// at the first subscription). `clock` must outlive the bus.
  std::unique_ptr<Bus> OpenBus(size_t host, const std::string& program, const Clock& clock,
                               const std::function<void(Bus&)>& set_up) const;

 private:
  struct Host {
    std::string name, folder;
    int network = -1;  // file descriptor of its network namespace
  };

  explicit Lab(tool::RunFolder folder) : folder_(std::move(folder)) {}
  Status AddHost(const HostSpec& spec, int mtu);
  Status Introduce(const std::vector<HostSpec>& specs);

  tool::RunFolder folder_;
  int outside_ = -1;  // the network in which the relay is
  std::vector<Host> hosts_;
  std::unique_ptr<Relay> relay_;
};

}  // namespace beckon::faults
