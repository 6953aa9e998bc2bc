// A machine's keys on disk: its own secret one, and the public ones of the machines it trusts.
//   node.key         this machine's: node, secret, may; readable by its owner and group alone
//   trusted/NAME.pub node, public, may
//   revoked/*.pub    never trusted again, whatever trusted/ holds
// Public files are made by `beckon keys make` on one machine and carried to the others by people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/base/trust/roles.h"
#include "services/base/trust/signing.h"

namespace beckon::trust {

/// A machine as others know it.
struct Node {
  std::string name;  // 1 .. 48 characters of [A-Za-z0-9_.-]
  PublicKey key{};
  Roles may;
};

struct OwnKey {
  Node node;
  SecretKey secret;
};

/// What the folder says of other machines.
struct Acquaintances {
  std::vector<Node> trusted;  // without those that are revoked
  std::vector<Node> revoked;
  std::vector<std::string> faults;  // files that cannot be used, with the reason
};

class KeyFolder {
 public:
  explicit KeyFolder(std::string path) : path_(std::move(path)) {}
  const std::string& path() const { return path_; }

  /// Makes node.key, refusing where there is one, and NAME.pub beside it. Returns the latter's
  /// path.
  Result<std::string> Make(const std::string& name, Roles may) const;
  /// Nothing where there is no node.key.
  Result<std::optional<OwnKey>> Own() const;
  /// All that is known; itself included, unless revoked.
  Acquaintances Others() const;
  /// Takes in a public file; `may` narrows or widens what it says. Refuses a key that was revoked,
  /// and another key for a name that is trusted.
  Result<Node> Trust(const std::string& file, std::optional<Roles> may) const;
  /// By name or key id.
  Result<Node> Revoke(const std::string& name_or_id) const;
  /// Another number after every change of the folder.
  uint64_t Version() const;

 private:
  std::string path_;
};

}  // namespace beckon::trust
