#include "services/intention/affordances_file.h"

#include <unistd.h>

#include "services/base/config.h"

namespace beckon::intention {

Result<Affordances> ReadAffordances(const std::string& path) {
  if (access(path.c_str(), R_OK) != 0) {
    return Error{path + ": cannot read the affordances; check --affordances"};
  }
  auto file = ConfigTable::Load(path);
  if (!file) return file.error();
  std::vector<Action> actions;
  ConfigTable action_table = file->Section("actions");
  for (const std::string& name : action_table.Keys()) {
    Action action{name, ""};
    action_table.Get(name, action.words);
    actions.push_back(std::move(action));
  }
  std::vector<Affordances::Entry> entries;
  ConfigTable category_table = file->Section("categories");
  for (const std::string& name : category_table.Keys()) {
    Affordances::Entry entry{name, {}};
    category_table.Get(name, entry.actions);
    entries.push_back(std::move(entry));
  }
  std::vector<std::string> unknown;
  if (file->Has("unknown")) file->Section("unknown").Get("actions", unknown);
  if (Status read = file->Finish(); !read) return read.error();
  auto made = Affordances::Make(std::move(actions), std::move(entries), std::move(unknown));
  if (!made) return Error{path + ": " + made.error().message};
  return made;
}

}  // namespace beckon::intention
