#include "services/base/config.h"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace beckon {
namespace {

std::string Joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// Levenshtein distance, to suggest the key that was meant.
size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

/// A number as people write it: 0.05, not 0.050000.
std::string Text(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

}  // namespace

struct ConfigTable::File {
  std::string name;
  toml::table root;
  std::set<std::string> known;  // dotted keys somebody asked for
  std::string first_error;

  const toml::table* Table(const std::string& path) const {
    if (path.empty()) return &root;
    return root.at_path(path).as_table();
  }

  const toml::node* Find(const std::string& path, const std::string& key) {
    known.insert(Joined(path, key));
    const toml::table* table = Table(path);
    return table == nullptr ? nullptr : table->get(key);
  }

  void Fail(const toml::node* node, const std::string& dotted, const std::string& what) {
    if (!first_error.empty()) return;
    first_error = name;
    if (node != nullptr) first_error += ":" + std::to_string(node->source().begin.line);
    first_error += ": " + dotted + ": " + what;
  }

  /// The first key nobody read, with the nearest known one as a suggestion.
  std::string UnknownKey(const toml::table& table, const std::string& path) const {
    for (const auto& [key, node] : table) {
      const std::string dotted = Joined(path, std::string(key.str()));
      if (!known.contains(dotted)) {
        std::string message =
            name + ":" + std::to_string(key.source().begin.line) + ": unknown key '" + dotted + "'";
        const auto nearest =
            std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
              return EditDistance(a, dotted) < EditDistance(b, dotted);
            });
        if (nearest != known.end()) message += "; did you mean '" + *nearest + "'?";
        return message;
      }
      if (const toml::table* inner = node.as_table()) {
        if (auto message = UnknownKey(*inner, dotted); !message.empty()) return message;
      }
    }
    return {};
  }
};

Result<ConfigTable> ConfigTable::Load(const std::string& path) {
  if (path.empty()) return Parse("", "(no file)");
  std::ifstream file(path);
  if (!file) return Error{path + ": cannot read the configuration file; check --config"};
  std::stringstream text;
  text << file.rdbuf();
  return Parse(text.str(), path);
}

Result<ConfigTable> ConfigTable::Parse(const std::string& text, const std::string& name) {
  auto file = std::make_shared<File>();
  file->name = name;
  try {
    file->root = toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    std::string what(e.description());  // quotes the file, line breaks and all
    std::replace_if(
        what.begin(), what.end(), [](char c) { return c >= 0 && c < ' '; }, '?');
    return Error{name + ":" + std::to_string(e.source().begin.line) + ": not TOML: " + what};
  }
  return ConfigTable(std::move(file), "");
}

ConfigTable ConfigTable::Section(const std::string& key) {
  const toml::node* node = file_->Find(path_, key);
  if (node != nullptr && !node->is_table())
    file_->Fail(node, Joined(path_, key), "expected a table");
  return ConfigTable(file_, Joined(path_, key));
}

void ConfigTable::Get(const std::string& key, double& value, double min, double max) {
  const toml::node* node = file_->Find(path_, key);
  if (node == nullptr) return;
  const auto number = node->value<double>();
  if (!node->is_number() || !number)
    return file_->Fail(node, Joined(path_, key), "expected a number");
  if (!(*number >= min && *number <= max)) {
    return file_->Fail(
        node, Joined(path_, key),
        Text(*number) + " is out of range, expected " + Text(min) + " .. " + Text(max));
  }
  value = *number;
}

void ConfigTable::Get(const std::string& key, int& value, int min, int max) {
  const toml::node* node = file_->Find(path_, key);
  if (node == nullptr) return;
  if (!node->is_integer()) return file_->Fail(node, Joined(path_, key), "expected a whole number");
  const int64_t number = **node->as_integer();
  if (number < min || number > max) {
    return file_->Fail(node, Joined(path_, key),
                       std::to_string(number) + " is out of range, expected " +
                           std::to_string(min) + " .. " + std::to_string(max));
  }
  value = static_cast<int>(number);
}

void ConfigTable::Get(const std::string& key, bool& value) {
  const toml::node* node = file_->Find(path_, key);
  if (node == nullptr) return;
  if (!node->is_boolean()) return file_->Fail(node, Joined(path_, key), "expected true or false");
  value = **node->as_boolean();
}

void ConfigTable::Get(const std::string& key, std::string& value) {
  const toml::node* node = file_->Find(path_, key);
  if (node == nullptr) return;
  if (!node->is_string()) return file_->Fail(node, Joined(path_, key), "expected a text in quotes");
  value = **node->as_string();
}

void ConfigTable::Get(const std::string& key, std::string& value,
                      const std::vector<std::string>& choices) {
  std::string chosen = value;
  Get(key, chosen);
  if (std::find(choices.begin(), choices.end(), chosen) != choices.end()) {
    value = chosen;
    return;
  }
  std::string expected;
  for (const auto& choice : choices) expected += (expected.empty() ? "" : ", ") + choice;
  Fail(key, "'" + chosen + "' is none of " + expected);
}

void ConfigTable::Get(const std::string& key, std::vector<std::string>& value) {
  const toml::node* node = file_->Find(path_, key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return file_->Fail(node, Joined(path_, key), "expected a list of texts");
  std::vector<std::string> texts;
  for (const auto& element : *array) {
    if (!element.is_string())
      return file_->Fail(&element, Joined(path_, key), "expected a list of texts");
    texts.push_back(**element.as_string());
  }
  value = std::move(texts);
}

void ConfigTable::Get(const std::string& key, std::vector<double>& value) {
  const toml::node* node = file_->Find(path_, key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return file_->Fail(node, Joined(path_, key), "expected a list of numbers");
  std::vector<double> numbers;
  for (const auto& element : *array) {
    if (!element.is_number())
      return file_->Fail(&element, Joined(path_, key), "expected a list of numbers");
    numbers.push_back(*element.value<double>());
  }
  value = std::move(numbers);
}

std::vector<std::string> ConfigTable::Keys() const {
  std::vector<std::string> keys;
  if (const toml::table* table = file_->Table(path_)) {
    for (const auto& [key, node] : *table) keys.emplace_back(key.str());
  }
  return keys;
}

bool ConfigTable::Has(const std::string& key) const {
  const toml::table* table = file_->Table(path_);
  return table != nullptr && table->contains(key);
}

void ConfigTable::Fail(const std::string& key, const std::string& what) {
  const toml::table* table = file_->Table(path_);
  file_->Fail(table == nullptr ? nullptr : table->get(key), Joined(path_, key), what);
}

Status ConfigTable::Finish() const {
  if (!file_->first_error.empty()) return Error{file_->first_error};
  if (auto unknown = file_->UnknownKey(file_->root, ""); !unknown.empty()) return Error{unknown};
  return {};
}

}  // namespace beckon
