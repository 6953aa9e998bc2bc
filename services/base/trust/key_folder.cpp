#include "services/base/trust/key_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "services/base/config.h"

namespace beckon::trust {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestName = 48;  // leaves room for "/intention" in a seal's sender
constexpr mode_t kSecretMode = 0640;
constexpr mode_t kPublicMode = 0644;

Status CheckName(const std::string& name) {
  const bool fits = !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
                    std::ranges::all_of(name, [](unsigned char c) {
                      return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-');
                    });
  if (fits) return {};
  return Error{"node '" + name + "': expected 1 to 48 letters, digits, '_', '.' or '-'"};
}

std::string Quoted(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return "[" + text + "]";
}

std::string PublicText(const Node& node) {
  return "# Public key of a machine. On every other machine: beckon keys trust FILE\nnode = \"" +
         node.name + "\"\npublic = \"" + ToText(node.key) +
         "\"\nmay = " + Quoted(node.may.Names()) + "\n";
}

/// All of it or nothing: by a file beside it that is renamed.
Status WriteFile(const fs::path& path, const std::string& text, mode_t mode) {
  const std::string temporary = path.string() + ".new";
  const auto failed = [&] {
    return Error{path.string() + ": cannot be written (" + std::strerror(errno) + ")"};
  };
  unlink(temporary.c_str());
  const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (fd < 0) return failed();
  const bool written =
      write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(fd) == 0;
  close(fd);
  if (!written || rename(temporary.c_str(), path.c_str()) != 0) return failed();
  return {};
}

struct Fields {
  std::string node, key;
  Roles may;
};

Result<Fields> ReadFields(const std::string& path, const char* key) {
  auto table = ConfigTable::Load(path);
  if (!table) return table.error();
  Fields fields;
  std::vector<std::string> may;
  table->Get("node", fields.node);
  table->Get(key, fields.key);
  table->Get("may", may);
  if (auto right = table->Finish(); !right) return right.error();
  const auto roles = Roles::FromNames(may);
  if (!roles) return Error{path + ": may: " + roles.error().message};
  fields.may = *roles;
  if (auto fits = CheckName(fields.node); !fits) return Error{path + ": " + fits.error().message};
  return fields;
}

Result<Node> ReadPublic(const std::string& path) {
  auto fields = ReadFields(path, "public");
  if (!fields) return fields.error();
  const auto key = PublicKeyFromText(fields->key);
  if (!key) return Error{path + ": public: " + key.error().message};
  return Node{fields->node, *key, fields->may};
}

std::vector<Node> ReadFolder(const fs::path& folder, std::vector<std::string>& faults) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".pub") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<Node> nodes;
  for (const auto& file : files) {
    if (auto node = ReadPublic(file.string())) {
      nodes.push_back(*std::move(node));
    } else {
      faults.push_back(node.error().message);
    }
  }
  return nodes;
}

bool Contains(const std::vector<Node>& nodes, const PublicKey& key) {
  return std::ranges::any_of(nodes, [&](const Node& node) { return node.key == key; });
}

}  // namespace

Result<std::string> KeyFolder::Make(const std::string& name, Roles may) const {
  if (auto fits = CheckName(name); !fits) return fits.error();
  const fs::path file = fs::path(path_) / "node.key";
  std::error_code failed;
  fs::create_directories(fs::path(path_) / "trusted", failed);
  if (failed) return Error{path_ + ": cannot be made (" + failed.message() + ")"};
  if (fs::exists(file))
    return Error{file.string() +
                 ": this machine has a key; revoke it on all machines and remove the file first"};
  const SecretKey secret = SecretKey::Generate();
  const Node node{name, secret.public_key(), may};
  const std::string text =
      "# Secret key of this machine: whoever reads it can speak for it.\nnode = \"" + name +
      "\"\nsecret = \"" + secret.ToText() + "\"\nmay = " + Quoted(may.Names()) + "\n";
  if (auto written = WriteFile(file, text, kSecretMode); !written) return written.error();
  const fs::path carried = fs::path(path_) / (name + ".pub");
  if (auto written = WriteFile(carried, PublicText(node), kPublicMode); !written)
    return written.error();
  return carried.string();
}

Result<std::optional<OwnKey>> KeyFolder::Own() const {
  const std::string file = (fs::path(path_) / "node.key").string();
  struct stat info {};
  if (stat(file.c_str(), &info) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return std::optional<OwnKey>();
    return Error{file + ": cannot be read (" + std::strerror(errno) + ")"};
  }
  if ((info.st_mode & 0007) != 0)
    return Error{file + ": everybody on this machine can read the secret key: chmod o-rwx " + file};
  auto fields = ReadFields(file, "secret");
  if (!fields) return fields.error();
  auto secret = SecretKey::FromText(fields->key);
  if (!secret) return Error{file + ": secret: " + secret.error().message};
  return std::optional<OwnKey>(OwnKey{{fields->node, secret->public_key(), fields->may}, *secret});
}

Acquaintances KeyFolder::Others() const {
  Acquaintances others;
  others.revoked = ReadFolder(fs::path(path_) / "revoked", others.faults);
  auto nodes = ReadFolder(fs::path(path_) / "trusted", others.faults);
  if (const auto own = Own(); own && *own && !Contains(nodes, (*own)->node.key))
    nodes.insert(nodes.begin(), (*own)->node);
  for (auto& node : nodes) {
    if (!Contains(others.revoked, node.key)) others.trusted.push_back(std::move(node));
  }
  return others;
}

Result<Node> KeyFolder::Trust(const std::string& file, std::optional<Roles> may) const {
  auto node = ReadPublic(file);
  if (!node) return node.error();
  if (may) node->may = *may;
  const auto others = Others();
  if (Contains(others.revoked, node->key))
    return Error{file + ": this key of " + node->name + " was revoked; make another one there"};
  for (const auto& known : others.trusted) {
    if (known.name == node->name && known.key != node->key)
      return Error{file + ": another key is trusted for " + known.name + " (" +
                   ToText(IdOf(known.key)) + "); revoke that first: beckon keys revoke " +
                   known.name};
  }
  const fs::path folder = fs::path(path_) / "trusted";
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (auto written = WriteFile(folder / (node->name + ".pub"), PublicText(*node), kPublicMode);
      !written)
    return written.error();
  return node;
}

Result<Node> KeyFolder::Revoke(const std::string& name_or_id) const {
  for (const auto& node : Others().trusted) {
    const std::string id = ToText(IdOf(node.key));
    if (node.name != name_or_id && id != name_or_id) continue;
    const fs::path folder = fs::path(path_) / "revoked";
    std::error_code failed;
    fs::create_directories(folder, failed);
    // First the one that ends the trust.
    if (auto written =
            WriteFile(folder / (node.name + "-" + id + ".pub"), PublicText(node), kPublicMode);
        !written) {
      return written.error();
    }
    fs::remove(fs::path(path_) / "trusted" / (node.name + ".pub"), failed);
    return node;
  }
  return Error{"'" + name_or_id + "': no key of this name or id is trusted; see beckon keys list"};
}

uint64_t KeyFolder::Version() const {
  uint64_t version = 14695981039346656037ULL;  // FNV-1a
  const auto mix = [&](uint64_t value) { version = (version ^ value) * 1099511628211ULL; };
  for (const char* part : {"node.key", "trusted", "revoked"}) {
    struct stat info {};
    if (stat((fs::path(path_) / part).c_str(), &info) != 0) continue;
    mix(static_cast<uint64_t>(info.st_ino));
    mix(static_cast<uint64_t>(info.st_mtim.tv_sec));
    mix(static_cast<uint64_t>(info.st_mtim.tv_nsec));
  }
  return version;
}

}  // namespace beckon::trust
