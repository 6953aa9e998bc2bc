// Files that are wrong: one clear line each, and never a crash.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "services/intention/affordances_file.h"
#include "services/intention/history_commands.h"
#include "services/intention/history_text.h"
#include "services/intention/phrases_file.h"
#include "services/intention/scenario_file.h"
#include "services/intention/store.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
namespace {

const char kLine[] =
    R"({"user": "u", "scene": [{"category": "Box", "distance_m": 0.7, "lateral_m": 0.1}, {"category": "Bowl", "distance_m": 0.5}, {"category": "Box", "distance_m": 0.9}], "want": {"category": "Box", "instance": 2, "action": "Open"}, "utime": 1700000000000000})";

const char kRow[] =
    R"({"origin": "attic", "seq": 3, "kind": "session", "body": {"session_id": "a", "user": "ann", "device": "console", "utime": 5, "category": "Mug", "action": "Drink", "instance": 1, "questions": 4, "posterior": 1.0, "present": {"Mug": 2}, "answers": [{"kind": "full", "likelihoods": [1.0, 0.0], "meant": 0, "device": "console"}]}})";

std::string Source(const std::string& name) {
  return std::string(BECKON_SOURCE_DIR) + "/services/intention/" + name;
}

std::string Content(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class BadInput : public testing::Test {
 protected:
  std::string Write(const std::string& text) {
    std::filesystem::remove(folder / "input");  // a file anew is quicker than one overwritten
    std::ofstream(folder / "input", std::ios::binary) << text;
    return folder / "input";
  }
  /// The error without the folder, or "read N".
  std::string Scenario(const std::string& text) {
    const std::string path = Write(text);
    const auto read = ReadScenario(path, affordances);
    if (read) return "read " + std::to_string(read->size());
    const std::string& message = read.error().message;
    EXPECT_EQ(message.find(path), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 600u) << message;
    return "input" + message.substr(path.size());
  }
  std::string Changed(const std::string& from, const std::string& to) const {
    std::string line = kLine;
    const size_t at = line.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return line.replace(at, from.size(), to);
  }

  TemporaryFolder folder;
  const Affordances affordances = *ReadAffordances(Source("affordances.toml"));
};

TEST_F(BadInput, TakesAnyEndOfLineAndAByteOrderMark) {
  const std::string line = kLine;
  EXPECT_EQ(Scenario(line), "read 1");
  EXPECT_EQ(Scenario(line + "\r\n\r\n  \n" + line + "\r\n"), "read 2");
  EXPECT_EQ(Scenario("\xEF\xBB\xBF" + line + "\n"), "read 1");
  EXPECT_EQ(ReadScenario(Write(line), affordances)->front().session.utime, 1'700'000'000'000'000);
}

TEST_F(BadInput, SaysWhichWantIsImpossible) {
  EXPECT_EQ(Scenario(Changed("\"instance\": 2", "\"instance\": 3")),
            "input:1: 'want': Box 3 is not in the scene, which has 2");
  EXPECT_EQ(Scenario(Changed("{\"category\": \"Box\", \"instance\"",
                             "{\"category\": \"Mug\", \"instance\"")),
            "input:1: 'want': Mug 2 is not in the scene, which has none");
  EXPECT_EQ(Scenario(Changed("\"Box\", \"instance\": 2", "\"Bowl\", \"instance\": 1")),
            "input:1: 'want': a Bowl affords Grasp, Move, Push; not Open");
}

TEST_F(BadInput, SaysWhatWasExpectedAndFound) {
  const std::string many = [] {
    std::string objects;
    for (int i = 0; i < 500; ++i) objects += "{\"category\": \"Box\", \"distance_m\": 1}, ";
    return objects;
  }();
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const auto& [line, message] : std::vector<std::pair<std::string, std::string>>{
           {Changed("0.7", "-0.5"),
            ":2: object 1 of 'scene': 'distance_m' must be a number of metres from 0 to 1000, "
            "found -0.5"},
           {Changed("0.5", "1e9"), ":2: object 2 of 'scene': 'distance_m' must be a number of"},
           {Changed("0.7", "null"), "found null"},
           {Changed("0.7", "\"NaN\""), "found \"NaN\""},
           {Changed("0.7", "NaN"), ":2: not a JSON object: parse error"},
           {Changed("0.7", "1e999"), ":2: not a JSON object: number overflow parsing '1e999'"},
           {Changed("0.1", "[]"), "'lateral_m' must be a number of metres from -1000 to 1000"},
           {Changed("\"Bowl\"", "\"Car\""),
            ":2: object 2 of 'scene': unknown category 'Car', expected one of Bottle, Bowl, Box,"},
           {Changed("\"Open\"", "\"Fly\""),
            ":2: 'want': unknown action 'Fly', expected one of Drink, Grasp"},
           {Changed("\"instance\": 2", "\"instance\": 1.5"),
            "'instance' must be a whole number from 1, the nearest, found 1.5"},
           {Changed("\"instance\": 2", "\"instance\": 0"), "found 0"},
           {Changed("\"instance\": 2", "\"instance\": 18446744073709551615"), "found 184467"},
           {Changed("1700000000000000", "-1"), "'utime' must be a whole number of microseconds"},
           {Changed("1700000000000000", "18446744073709551615"), "'utime' must be a whole"},
           {Changed("\"user\": \"u\"", "\"user\": 3"),
            ":2: the session: 'user' must be a text, found 3"},
           {Changed("\"user\"", "\"usr\""), ":2: the session lacks 'user'"},
           {Changed("\"want\"", "\"wants\""), ":2: the session lacks 'want'"},
           {Changed("{\"category\": \"Bowl\"", "3, {\"category\": \"Bowl\""),
            ":2: object 2 of 'scene' must be an object with 'category', found 3"},
           {Changed("[{", "[" + many + "{"),
            ":2: 'scene' must be a list of 1 to 64 objects, found 503"},
           {R"({"user": "u", "scene": [], "want": {}})",
            ":2: 'scene' must be a list of 1 to 64 objects, found 0"},
           {Changed("\"user\": \"u\"", "\"user\": \"u\", \"user\": \"v\""),
            ":2: the key 'user' is there twice"},
           {Changed("0.1}", "0.1, \"category\": \"Mug\"}"),
            ":2: the key 'category' is there twice"},
           {Changed("\"u\"", deep), ":2: nests deeper than 32 levels"},
           {std::string(10'000'000, 'x'),
            ":2: the line has 10000000 bytes, expected at most 1000000"},
           {"[1]", ":2: expected a JSON object, found array"},
           {std::string("{\"user\": \"\xFF\"}"), ":2: not a JSON object: parse error"},
           {std::string("\0{}", 3), ":2: not a JSON object: parse error"},
           {"{\"user\": ", ":2: not a JSON object: parse error"}}) {
    const std::string found = Scenario(std::string(kLine) + "\n" + line + "\n");
    EXPECT_NE(found.find(message), std::string::npos) << line.substr(0, 100) << "\n"
                                                      << found << "\nexpected " << message;
    EXPECT_EQ(found.find("input:2: "), 0u) << found;
  }
}

/// Text with a few bytes changed, doubled, removed or put elsewhere.
std::string Mutant(std::string text, std::mt19937_64& random) {
  static const std::string kTelling = "{}[]\",:.-+eE0123456789\\\n\r\t\0\xff\xc3";
  const auto below = [&](size_t n) { return n == 0 ? 0 : random() % n; };
  const size_t changes = 1 + below(4);
  for (size_t i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = below(text.size()), length = 1 + below(20);
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text[at] = kTelling[below(kTelling.size())];
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 4:
        text.insert(at, 1, kTelling[below(kTelling.size())]);
        break;
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

/// Feeds mutants; `read` gives the error's message, or nothing where the mutant is right.
void ExpectClearErrors(const std::string& good, int mutants,
                       const std::function<std::string(const std::string&)>& read) {
  std::mt19937_64 random(7);
  int refused = 0;
  for (int i = 0; i < mutants; ++i) {
    const std::string mutant = Mutant(good, random);
    const std::string message = read(mutant);
    refused += !message.empty();
    ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    ASSERT_LT(message.size(), 2000u) << message;
  }
  EXPECT_GT(refused, mutants / 10);
}

TEST_F(BadInput, MutatedScenariosAreReadOrRefusedInOneLine) {
  ExpectClearErrors(std::string(kLine) + "\n" + kLine + "\n", 3000, [&](const std::string& text) {
    const std::string said = Scenario(text);
    return said.starts_with("read") ? "" : said;
  });
}

TEST_F(BadInput, MutatedPhrasesAreReadOrRefusedInOneLine) {
  ExpectClearErrors(Content(Source("questions.de.toml")), 1500, [&](const std::string& text) {
    const auto read = ParsePhrases(text, "q.toml");
    if (!read) return read.error().message;
    // What was read can be spoken.
    const Situation situation = MakeSituation(affordances, {{0, 1, 0}, {0, 2, 1}, {-1, 3, 2}});
    for (uint64_t objects = 1; objects < 8; ++objects) {
      EXPECT_LE(
          Text(affordances, situation, {QuestionKind::kSet, {{1 + objects, objects, -1}}}, *read)
              .size(),
          1000u);
    }
    return std::string();
  });
}

TEST_F(BadInput, MutatedAffordancesAreReadOrRefusedInOneLine) {
  ExpectClearErrors(Content(Source("affordances.toml")), 1500, [&](const std::string& text) {
    const auto read = ReadAffordances(Write(text));
    return read ? std::string() : read.error().message;
  });
}

TEST_F(BadInput, MutatedImportsAreAddedWholeOrNotAtAll) {
  const std::string good = std::string(kRow) + "\n" +
                           R"({"origin": "attic", "seq": 4, "kind": "note", "body": "{}"})" + "\n";
  const std::string db = folder / "a.db";
  auto store = Store::Open(db, "kitchen");
  ASSERT_TRUE(store.ok());
  testing::internal::CaptureStdout();
  ExpectClearErrors(good, 300, [&](const std::string& text) {
    const int64_t before = *(*store)->RowCount();
    const Status imported = ImportHistory({.db = db, .file = Write(text)}, "kitchen");
    const int64_t after = *(*store)->RowCount();
    if (imported) return std::string();
    EXPECT_EQ(before, after);
    return imported.error().message;
  });
  testing::internal::GetCapturedStdout();
  EXPECT_TRUE((*store)->AllSessions().ok());
}

TEST_F(BadInput, ImportNamesTheLine) {
  const std::string db = folder / "a.db";
  const auto import = [&](const std::string& line) {
    const Status imported =
        ImportHistory({.db = db, .file = Write(std::string(kRow) + "\n" + line)}, "kitchen");
    return imported ? std::string("imported") : imported.error().message;
  };
  std::string torn = kRow;
  torn.resize(torn.size() / 2);
  std::string far = kRow;
  far.replace(far.find("\"instance\": 1"), 13, "\"instance\": 9999");
  for (const auto& [line, message] : std::vector<std::pair<std::string, std::string>>{
           {torn, "input:2: not a JSON object: parse error"},
           {far, "input:2: not a session: 'instance' must be a whole number from 1 to 64"},
           {R"({"origin": "x", "seq": 0, "kind": "note", "body": "{}"})",
            "input:2: 'seq' must be a whole number from 1, found 0"},
           {R"({"origin": "", "seq": 1, "kind": "note", "body": "{}"})",
            "input:2: 'origin' or 'kind' is empty"}}) {
    const std::string found = import(line);
    EXPECT_NE(found.find(message), std::string::npos) << found << "\nexpected " << message;
    EXPECT_FALSE(std::filesystem::exists(db));
  }
}

TEST(HistoryText, SumsUpEveryUser) {
  std::vector<SessionRecord> sessions;
  for (int i = 0; i < 40; ++i) {
    SessionRecord session;
    session.user = i % 2 == 0 ? "ann" : "bob";
    session.action = "Open";
    session.category = "Carton";
    session.device = "switch";
    session.utime = (1'700'000'000 + i) * kSecond;
    session.questions = i < 20 ? 6 : 1;
    sessions.push_back(session);
  }
  const std::string text = HistoryText(sessions);
  EXPECT_NE(text.find("Open Carton 1"), std::string::npos);
  EXPECT_NE(text.find("ann                     20       6.0      1.0  ██████████▂▂▂▂▂▂▂▂▂▂\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(HistoryText({}), "no sessions\n");
}

}  // namespace
}  // namespace beckon::intention
