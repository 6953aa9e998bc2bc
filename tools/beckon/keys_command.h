// `beckon keys`: the keys by which machines sign what they say.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"

namespace CLI {
class App;
}

namespace beckon::tool {

struct KeysOptions {
  std::string folder;            // of keys; empty = this user's
  std::string node;              // name of this machine; empty = its host name
  std::string file;              // public key of another machine
  std::string revoked;           // name or id
  std::vector<std::string> may;  // roles; empty = all, or what the file says
};

/// Adds `keys` with make, list, trust and revoke to `app`.
void AddKeys(CLI::App& app, KeysOptions& options);

/// Runs what was chosen, and prints what was done.
Status RunKeys(const CLI::App& app, const KeysOptions& options);

}  // namespace beckon::tool
