#include "services/intention/phrases_file.h"

#include <unistd.h>

#include <algorithm>
#include <set>

#include "services/base/config.h"

namespace beckon::intention {
namespace {

/// Reads the texts of one table, checking each; the table records the first error of the file.
class Texts {
 public:
  Texts(ConfigTable table, const std::vector<std::string>& cases)
      : table_(std::move(table)), cases_(cases) {}

  /// A template that must be there.
  void Need(const std::string& key, std::string& text,
            const std::vector<std::string>& placeholders = {}) {
    if (!table_.Has(key)) return table_.Fail(key, "is missing, expected a text in quotes");
    Check(key, text, placeholders);
  }
  /// A word that may be left out.
  void May(const std::string& key, std::map<std::string, std::string>& by_case,
           const std::string& in) {
    if (table_.Has(key)) Check(key, by_case[in], {});
  }
  ConfigTable& table() { return table_; }

 private:
  void Check(const std::string& key, std::string& text,
             const std::vector<std::string>& placeholders) {
    std::string read(" ");  // stays where it is not a text, which is an error already
    table_.Get(key, read);
    if (Status right = CheckTemplate(read, placeholders, cases_); !right)
      table_.Fail(key, right.error().message);
    text = read;
  }

  ConfigTable table_;
  const std::vector<std::string>& cases_;
};

/// A list of words, of at least `least`.
void NeedWords(ConfigTable& table, const std::string& key, size_t least,
               std::vector<std::string>& words) {
  table.Get(key, words);
  for (size_t i = 0; i < words.size(); ++i) {
    if (Status right = CheckTemplate(words[i], {}, {}); !right)
      return table.Fail(key, "word " + std::to_string(i + 1) + " " + right.error().message);
  }
  if (words.size() < least) {
    table.Fail(key, "expected a list of at least " + std::to_string(least) + " words, found " +
                        std::to_string(words.size()));
  }
}

void ReadCases(ConfigTable& file, Phrases& phrases) {
  NeedWords(file, "cases", 1, phrases.cases);
  std::set<std::string> seen;
  for (const std::string& in : phrases.cases) {
    const bool name = std::all_of(in.begin(), in.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
    if (!name) file.Fail("cases", "'" + in + "' is no name, expected small letters and digits");
    if (!seen.insert(in).second) file.Fail("cases", "'" + in + "' is there twice");
  }
}

void ReadGender(ConfigTable table, Phrases& phrases, Gender& gender) {
  table.Get("starts", gender.starts);
  for (const std::string& in : phrases.cases) {
    Texts texts(table.Section(in), phrases.cases);
    NounForms& forms = gender.forms[in];
    texts.Need("the", forms.the, {"noun"});
    texts.Need("ranked", forms.ranked, {"rank", "noun"});
    texts.Need("a", forms.a, {"noun"});
    texts.Need("one_of", forms.one_of, {"nouns"});
  }
}

void ReadGroups(ConfigTable table, Phrases& phrases) {
  for (const std::string& in : phrases.cases) {
    Texts texts(table.Section(in), phrases.cases);
    GroupForms& forms = phrases.groups[in];
    texts.Need("nearest", forms.nearest, {"count"});
    texts.Need("farthest", forms.farthest, {"count"});
    texts.Need("left", forms.left, {"count"});
    texts.Need("right", forms.right, {"count"});
    texts.Need("outlined", forms.outlined, {"count"});
  }
}

void ReadNoun(ConfigTable table, const Phrases& phrases, NounWord& noun) {
  Texts texts(table, phrases.cases);
  texts.Need("gender", noun.gender);
  if (!phrases.genders.contains(noun.gender)) {
    std::string expected;
    for (const auto& [name, gender] : phrases.genders)
      expected += (expected.empty() ? "" : ", ") + name;
    table.Fail("gender", "unknown gender '" + noun.gender + "', expected one of " + expected);
  }
  texts.Need("one", noun.one);
  texts.Need("many", noun.many);
  for (const std::string& in : phrases.cases) {
    texts.May("one_" + in, noun.one_in, in);
    texts.May("many_" + in, noun.many_in, in);
  }
}

void ReadVerb(ConfigTable table, const Phrases& phrases, VerbWords& verb, bool with_words) {
  using Placeholders = std::vector<std::string>;
  Texts texts(std::move(table), phrases.cases);
  const Placeholders words = with_words ? Placeholders{"words"} : Placeholders{};
  texts.Need("any", verb.any, words);
  texts.Need("bare", verb.bare, words);
  Placeholders task = words;
  task.emplace_back("object");
  texts.Need("task", verb.task, task);
}

void ReadWords(ConfigTable& file, Phrases& phrases) {
  if (!file.Has("names_are_words"))
    file.Fail("names_are_words", "is missing, expected true or false");
  file.Get("names_are_words", phrases.names_are_words);
  ConfigTable genders = file.Section("genders");
  for (const std::string& name : genders.Keys())
    ReadGender(genders.Section(name), phrases, phrases.genders[name]);
  if (phrases.genders.empty())
    file.Fail("genders", "is missing, expected at least one table [genders.<name>]");
  ConfigTable nouns = file.Section("nouns");
  for (const std::string& name : nouns.Keys())
    ReadNoun(nouns.Section(name), phrases, phrases.nouns[name]);
  if (!nouns.Has("Unknown"))
    nouns.Fail("Unknown", "is missing, expected the word for an object of no category");
  ConfigTable verbs = file.Section("verbs");
  for (const std::string& name : verbs.Keys())
    ReadVerb(verbs.Section(name), phrases, phrases.verbs[name], /*with_words=*/false);
  ReadVerb(file.Section("other_verb"), phrases, phrases.other_verb, /*with_words=*/true);
}

Result<Phrases> Read(ConfigTable file) {
  Phrases phrases;
  ReadCases(file, phrases);
  NeedWords(file, "ranks", 2, phrases.ranks);
  NeedWords(file, "numbers", 2, phrases.numbers);
  Texts root(file, phrases.cases);
  root.Need("list_comma", phrases.list_comma);
  root.Need("list_or", phrases.list_or);
  root.Need("numbered", phrases.numbered, {"noun", "number"});
  ReadWords(file, phrases);
  ReadGroups(file.Section("groups"), phrases);
  for (const Sentence& sentence : Sentences()) {
    Texts texts(file.Section(sentence.section), phrases.cases);
    texts.Need(sentence.key, phrases.*sentence.text, sentence.placeholders);
  }
  if (Status read = file.Finish(); !read) return read.error();
  return phrases;
}

}  // namespace

Result<Phrases> ParsePhrases(const std::string& text, const std::string& name) {
  auto file = ConfigTable::Parse(text, name);
  if (!file) return file.error();
  return Read(*std::move(file));
}

Result<Phrases> ReadPhrases(const std::string& path) {
  if (access(path.c_str(), R_OK) != 0)
    return Error{path + ": cannot read the phrases; check --phrases"};
  auto file = ConfigTable::Load(path);
  if (!file) return file.error();
  return Read(*std::move(file));
}

}  // namespace beckon::intention
