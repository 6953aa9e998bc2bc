#include "tools/beckon/keys_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "services/base/status_reporter.h"
#include "services/base/trust/key_folder.h"

namespace beckon::tool {
namespace {

using trust::KeyFolder;
using trust::Node;
using trust::Roles;

/// Where a machine that has no keys yet gets them.
std::string FolderToMake() {
  if (geteuid() == 0) return "/etc/beckon/keys";
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  const std::filesystem::path own =
      config != nullptr && *config != '\0'
          ? std::filesystem::path(config)
          : std::filesystem::path(home == nullptr ? "." : home) / ".config";
  return (own / "beckon" / "keys").string();
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void PrintNode(const Node& node, const char* state) {
  std::printf("%-20s %s  %-9s %s\n", node.name.c_str(),
              trust::ToText(trust::IdOf(node.key)).c_str(), state,
              Joined(node.may.Names()).c_str());
}

Status Make(const KeyFolder& folder, const KeysOptions& options, Roles may) {
  const std::string node = options.node.empty() ? HostName() : options.node;
  auto file = folder.Make(node, may);
  if (!file) return file.error();
  std::printf("%s/node.key    the secret key of %s; never copy it\n", folder.path().c_str(),
              node.c_str());
  std::printf("%s    its public key; on every other machine: beckon keys trust %s.pub\n",
              file->c_str(), node.c_str());
  return {};
}

Status List(const KeyFolder& folder) {
  const auto own = folder.Own();
  if (!own) return own.error();
  const auto others = folder.Others();
  std::printf("%-20s %-16s  %-9s may\n", "node", "key", "state");
  for (const auto& node : others.trusted) {
    const bool itself = *own && (*own)->node.key == node.key;
    PrintNode(node, itself ? "itself" : "trusted");
  }
  for (const auto& node : others.revoked) PrintNode(node, "revoked");
  for (const auto& fault : others.faults)
    std::fprintf(stderr, "cannot be used: %s\n", fault.c_str());
  if (!*own) std::printf("%s: this machine has no key: beckon keys make\n", folder.path().c_str());
  return {};
}

}  // namespace

void AddKeys(CLI::App& app, KeysOptions& o) {
  auto* keys = app.add_subcommand(
      "keys",
      "The keys by which machines sign what they say, so that nobody else can answer for a "
      "user or move the robot; in --keys DIR (default: /etc/beckon/keys for root, else "
      "~/.config/beckon/keys)");
  keys->require_subcommand(1);
  keys->fallthrough();
  const std::string roles = "What it may say: " + Joined(Roles::All().Names());
  auto* make = keys->add_subcommand(
      "make", "Makes this machine's key, and a public file to carry to the others");
  make->add_option("--node", o.node, "Name of this machine (default: its host name)");
  make->add_option("--may", o.may, roles + " (default: all)")->delimiter(',');
  keys->add_subcommand("list", "The keys that are trusted here, and those that were revoked");
  auto* trust = keys->add_subcommand("trust", "Trusts another machine by its public file");
  trust->add_option("FILE", o.file, "NAME.pub of beckon keys make")->required();
  trust->add_option("--may", o.may, roles + " (default: what the file says)")->delimiter(',');
  keys->add_subcommand("revoke",
                       "Never trusts a key again; running services notice within a second")
      ->add_option("NODE", o.revoked, "Name or key id, as beckon keys list shows")
      ->required();
}

Status RunKeys(const CLI::App& app, const KeysOptions& options) {
  const CLI::App& keys = *app.get_subcommand("keys");
  const KeyFolder folder(options.folder.empty() ? FolderToMake() : options.folder);
  const auto roles = Roles::FromNames(options.may);
  if (!roles) return Error{"--may: " + roles.error().message};
  if (keys.got_subcommand("make"))
    return Make(folder, options, options.may.empty() ? Roles::All() : *roles);
  if (keys.got_subcommand("list")) return List(folder);
  const auto node =
      keys.got_subcommand("trust")
          ? folder.Trust(options.file, options.may.empty() ? std::nullopt : std::optional(*roles))
          : folder.Revoke(options.revoked);
  if (!node) return node.error();
  PrintNode(*node, keys.got_subcommand("trust") ? "trusted" : "revoked");
  return {};
}

}  // namespace beckon::tool
