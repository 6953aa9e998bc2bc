// Every kind of question in English and in German, and phrase files that are wrong.
#include "services/intention/core/phrases.h"

#include <fstream>
#include <sstream>

#include "services/intention/affordances_file.h"
#include "services/intention/core/interview.h"
#include "services/intention/core/question.h"
#include "services/intention/phrases_file.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

std::string Shipped(const std::string& language) {
  return std::string(BECKON_SOURCE_DIR) + "/services/intention/questions." + language + ".toml";
}

std::string Content(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

Phrases Read(const std::string& language) {
  const auto phrases = ReadPhrases(Shipped(language));
  EXPECT_TRUE(phrases.ok()) << (phrases ? "" : phrases.error().message);
  return phrases ? *phrases : English();
}

/// A carton, three mugs (the second in the list is the nearest), a spray can, an unknown object,
/// two cups.
class Said : public testing::Test {
 protected:
  std::string Ask(const Phrases& phrases, QuestionKind kind, std::vector<std::string> actions,
                  uint64_t objects) const {
    return Text(affordances, situation, {kind, {Asked(std::move(actions), objects)}}, phrases);
  }
  Proposition Asked(std::vector<std::string> actions, uint64_t objects) const {
    Proposition asked{actions.empty() ? kAny : 0, objects, -1};
    for (const std::string& action : actions)
      asked.actions |= uint64_t{1} << affordances.FindAction(action);
    return asked;
  }
  std::string Option(const Phrases& phrases, std::vector<std::string> actions,
                     uint64_t objects) const {
    return OptionText(affordances, situation, Asked(std::move(actions), objects), phrases);
  }
  Thing Seen(const std::string& category, double distance_m, double lateral_m) const {
    return {affordances.FindCategory(category), distance_m, lateral_m};
  }

  const Affordances affordances = TestAffordances();
  const Situation situation = MakeSituation(
      affordances, {Seen("Carton", 0.50, 0.10), Seen("Mug", 0.60, 0.30), Seen("Mug", 0.40, -0.20),
                    Seen("Mug", 0.70, 0.35), Seen("SprayCan", 0.90, -0.30),
                    Seen("Unicorn", 0.65, 0.00), Seen("Cup", 0.62, -0.10), Seen("Cup", 0.3, 0.0)});
  const Phrases en = Read("en");
  const Phrases de = Read("de");
};

TEST_F(Said, Actions) {
  const auto kind = QuestionKind::kAction;
  EXPECT_EQ(Ask(en, kind, {"Open"}, kAny), "Do you want to open something?");
  EXPECT_EQ(Ask(de, kind, {"Open"}, kAny), "Möchten Sie etwas öffnen?");
  EXPECT_EQ(Ask(en, kind, {"Open", "Drink", "Pour"}, kAny),
            "Do you want to drink from, open or pour from something?");
  EXPECT_EQ(Ask(de, kind, {"Open", "Drink", "Pour"}, kAny),
            "Möchten Sie etwas trinken, öffnen oder eingießen?");
}

TEST_F(Said, Objects) {
  const auto kind = QuestionKind::kObject;
  EXPECT_EQ(Ask(en, kind, {}, 0b1), "Is it about the carton?");
  EXPECT_EQ(Ask(de, kind, {}, 0b1), "Geht es um den Karton?");
  EXPECT_EQ(Ask(en, kind, {}, 0b10), "Is it about the second mug?");
  EXPECT_EQ(Ask(de, kind, {}, 0b10), "Geht es um die zweite Tasse?");
  EXPECT_EQ(Ask(de, kind, {}, 0b10000000), "Geht es um den vordersten Becher?");
  EXPECT_EQ(Ask(en, kind, {}, 0b100000), "Is it about the unknown object?");
  EXPECT_EQ(Ask(de, kind, {}, 0b100000), "Geht es um das unbekannte Objekt?");
}

TEST_F(Said, Tasks) {
  const auto kind = QuestionKind::kFull;
  EXPECT_EQ(Ask(en, kind, {"Open"}, 0b1), "Open the carton?");
  EXPECT_EQ(Ask(de, kind, {"Open"}, 0b1), "Den Karton öffnen?");
  EXPECT_EQ(Ask(en, kind, {"Drink"}, 0b1000), "Drink from the third mug?");
  EXPECT_EQ(Ask(de, kind, {"Drink"}, 0b1000), "Aus der dritten Tasse trinken?");
  EXPECT_EQ(Ask(de, kind, {"Drink"}, 0b1000000), "Aus dem zweiten Becher trinken?");
  EXPECT_EQ(Ask(de, kind, {"Grasp"}, 0b10000), "Die Sprühdose greifen?");
  EXPECT_EQ(TaskText(affordances, "Open", "Carton", de), "Den Karton öffnen");
  EXPECT_EQ(TaskText(affordances, "Open", "Carton", en), "Open the carton");
}

TEST_F(Said, CategoriesAndSets) {
  const auto category = QuestionKind::kCategory, set = QuestionKind::kSet;
  EXPECT_EQ(Ask(en, category, {}, 0b1110), "Is it about one of the mugs?");
  EXPECT_EQ(Ask(de, category, {}, 0b1110), "Geht es um eine der Tassen?");
  EXPECT_EQ(Ask(de, category, {}, 0b11000000), "Geht es um einen der Becher?");
  EXPECT_EQ(Ask(en, set, {}, 0b10000101), "Is it one of the three objects nearest to you?");
  EXPECT_EQ(Ask(de, set, {}, 0b10000101), "Ist es eines der drei vordersten Objekte?");
  EXPECT_EQ(Ask(en, set, {}, 0b11000), "Is it one of the two objects furthest from you?");
  EXPECT_EQ(Ask(en, set, {}, 0b1010100), "Is it one of the three objects furthest to the left?");
  EXPECT_EQ(Ask(de, set, {}, 0b1010100), "Ist es eines der drei Objekte ganz links?");
  EXPECT_EQ(Ask(en, set, {}, 0b1010), "Is it one of the two objects furthest to the right?");
  EXPECT_EQ(Ask(de, set, {}, 0b1010), "Ist es eines der zwei Objekte ganz rechts?");
  EXPECT_EQ(Ask(en, set, {}, 0b10110), "Is it one of the three outlined objects?");
  EXPECT_EQ(Ask(de, set, {}, 0b10110), "Ist es eines der drei umrandeten Objekte?");
  EXPECT_EQ(Ask(en, set, {}, 0b10001), "Is it the carton or the spray can?");
  EXPECT_EQ(Ask(de, set, {}, 0b10001), "Ist es der Karton oder die Sprühdose?");
}

TEST_F(Said, AnActionWithOneOfSeveralObjects) {
  const auto set = QuestionKind::kSet;
  EXPECT_EQ(Ask(en, set, {"Drink"}, 0b1110), "Do you want to drink from one of the mugs?");
  EXPECT_EQ(Ask(de, set, {"Drink"}, 0b1110), "Möchten Sie aus einer der Tassen trinken?");
  EXPECT_EQ(Ask(de, set, {"Pour"}, 0b10110),
            "Möchten Sie aus einem der drei umrandeten Objekte eingießen?");
  EXPECT_EQ(Ask(en, set, {"Grasp", "Open"}, 0b1),
            "Do you want to grasp the carton or open the carton?");
}

TEST_F(Said, Choices) {
  const auto which = [&](const Phrases& phrases, std::vector<Proposition> options) {
    return Text(affordances, situation, {QuestionKind::kChoice, std::move(options)}, phrases);
  };
  const Proposition task = Asked({"Open"}, 0b1), action = Asked({"Open"}, kAny),
                    object = Asked({}, 0b1);
  EXPECT_EQ(which(en, {task, Asked({"Drink"}, 0b10)}), "Which one?");
  EXPECT_EQ(which(de, {task, Asked({"Drink"}, 0b10)}), "Welches davon?");
  EXPECT_EQ(which(en, {action, Asked({"Drink"}, kAny)}), "What do you want to do?");
  EXPECT_EQ(which(de, {action, Asked({"Drink"}, kAny)}), "Was möchten Sie tun?");
  EXPECT_EQ(which(en, {object, Asked({}, 0b1110)}), "Which one is it about?");
  EXPECT_EQ(which(de, {object, Asked({}, 0b1110)}), "Um welches Objekt geht es?");
  EXPECT_EQ(which(en, {task, object}), "Which one?");
  EXPECT_EQ(Option(en, {"Open"}, 0b1), "Open the carton");
  EXPECT_EQ(Option(de, {"Open"}, 0b1), "Den Karton öffnen");
  EXPECT_EQ(Option(en, {"Open"}, kAny), "Open something");
  EXPECT_EQ(Option(de, {"Open"}, kAny), "Etwas öffnen");
  EXPECT_EQ(Option(en, {}, 0b1000), "The third mug");
  EXPECT_EQ(Option(de, {}, 0b1000), "Die dritte Tasse");
  EXPECT_EQ(Option(en, {}, 0b1110), "One of the mugs");
  EXPECT_EQ(Option(de, {}, 0b1110), "Eine der Tassen");
  EXPECT_EQ(Option(en, {}, kAny), "Something");
  EXPECT_EQ(ANoun(de, "SprayCan"), "eine Sprühdose");
  EXPECT_EQ(ANoun(de, "Carton"), "einen Karton");
}

TEST_F(Said, AgainAndOfObjects) {
  const Question open = {QuestionKind::kFull, {Asked({"Open"}, 0b1)}};
  EXPECT_EQ(TextAgain(affordances, situation, open, en), "Once more, to be sure: open the carton?");
  EXPECT_EQ(TextAgain(affordances, situation, open, de),
            "Noch einmal zur Sicherheit: den Karton öffnen?");
  EXPECT_EQ(ObjectText(affordances, situation, 1, en.object_moved, en),
            "The second mug has moved.");
  EXPECT_EQ(ObjectText(affordances, situation, 0, de.object_gone, de), "Der Karton ist weg.");
}

TEST_F(Said, AnInterviewSpeaksTheLanguage) {
  const auto policy = MakePolicy("adaptive", affordances, QueryFamilies::kAll);
  ASSERT_TRUE(policy.ok());
  InterviewInput input;
  input.table = {{SceneObject(1, "SprayCan", 0, 0.5), ""}};
  input.phrases = de;
  Interview interview(affordances, **policy, input);
  auto query = std::get<msg::Query>(interview.outcome());
  EXPECT_EQ(query.text, "Die Sprühdose greifen?");
  EXPECT_EQ(query.options[0].text, "Ja");
  EXPECT_EQ(query.options[1].text, "Nein");
  EXPECT_EQ(query.why,
            "Es ist die einzige Aufgabe, die noch möglich ist; mit einem Ja ist alles klar.");
  interview.NoneOfThese("");
  query = std::get<msg::Query>(interview.outcome());
  EXPECT_EQ(query.text, "Was ist das für ein Objekt?");
  EXPECT_EQ(query.options.front().text.substr(0, 3), "ein");
  EXPECT_EQ(query.options.back().text, "Nichts davon");
}

TEST_F(Said, LargeNumbersInDigits) {
  std::vector<Thing> things;
  for (int i = 0; i < 40; ++i)
    things.push_back(Seen(i % 2 == 0 ? "Mug" : "Cup", 0.3 + 0.01 * i, 0));
  const Situation crowd = MakeSituation(affordances, things);
  const auto said = [&](const Phrases& phrases, uint64_t objects) {
    return Text(affordances, crowd, {QuestionKind::kSet, {{kAny, objects, -1}}}, phrases);
  };
  EXPECT_EQ(said(en, 0xFFF), "Is it one of the twelve objects nearest to you?");
  EXPECT_EQ(said(en, 0x1FFF), "Is it one of the 13 objects nearest to you?");
  EXPECT_EQ(said(en, 1u << 26), "Is it about mug number 14?");
  EXPECT_EQ(said(de, 1u << 26), "Geht es um Tasse Nummer 14?");
}

TEST_F(Said, EnglishIsWhatTheFileSays) { EXPECT_TRUE(en == English()); }

TEST_F(Said, TheShippedLanguagesHaveAllWords) {
  const auto shipped =
      ReadAffordances(std::string(BECKON_SOURCE_DIR) + "/services/intention/affordances.toml");
  ASSERT_TRUE(shipped.ok());
  EXPECT_TRUE(MissingWords(en, *shipped).empty());
  EXPECT_TRUE(MissingWords(de, *shipped).empty());
  const auto more = Affordances::Make({{"Open", "open"}, {"Wave", "wave"}},
                                      {{"Box", {"Open"}}, {"IceBox", {"Open", "Wave"}}});
  ASSERT_TRUE(more.ok());
  EXPECT_TRUE(MissingWords(en, *more).empty());
  const auto missing = MissingWords(de, *more);
  ASSERT_EQ(missing.size(), 2u);
  EXPECT_EQ(missing[0], "[nouns] lacks IceBox, it is called 'ice box'");
  EXPECT_EQ(missing[1], "[verbs] lacks Wave, it is called 'wave'");
}

struct Wrong {
  std::string from, to, message;
};

TEST(PhrasesFile, SaysWhatIsWrongAndWhatWasExpected) {
  const std::string good = Content(Shipped("de"));
  for (const Wrong& wrong : std::vector<Wrong>{
           {"full = \"{task}?\"", "",
            "q.toml: questions.full: is missing, expected a text in quotes"},
           {"full = \"{task}?\"", "full = \"Wirklich?\"",
            ": questions.full: {task} is missing, expected {task}"},
           {"full = \"{task}?\"", "full = \"{taks}?\"",
            ": questions.full: unknown placeholder {taks}, expected {task}"},
           {"um {object}?", "um {object.genitive}?",
            ": questions.object: unknown placeholder {object.genitive}, expected {object} or "
            "{object.accusative} or {object.dative} or {object.nominative}"},
           {"full = \"{task}?\"", "full = \"{task?\"", ": questions.full: a brace has no partner"},
           {"full = \"{task}?\"", "full = 3", ": questions.full: expected a text in quotes"},
           {"full = \"{task}?\"", "full = \"\"", ": questions.full: is empty, expected a text"},
           {"full = \"{task}?\"", "full = \"{task}\\n?\"", ": questions.full: holds a line break"},
           {"full = \"{task}?\"", "full = \"{task}?\"\nfuller = \"?\"",
            ": unknown key 'questions.fuller'; did you mean 'questions.full'?"},
           {"gender = \"m\", one = \"Karton\"", "gender = \"x\", one = \"Karton\"",
            ": nouns.Carton.gender: unknown gender 'x', expected one of f, m, n"},
           {"Unknown =", "Unknwon =", "q.toml: nouns.Unknown: is missing"},
           {"ranks = [", "ranks = [3, ", ": ranks: expected a list of texts"},
           {"[groups.dative]", "[groups.datve]", "q.toml: groups.dative.nearest: is missing"},
           {"cases = [", "cases = [\"Dativ!\", ", ": cases: 'Dativ!' is no name"},
           {"names_are_words = false", "", "q.toml: names_are_words: is missing"},
           {"[verbs]", "[verbs", ": not TOML: "}}) {
    std::string text = good;
    ASSERT_NE(text.find(wrong.from), std::string::npos) << wrong.from;
    text.replace(text.find(wrong.from), wrong.from.size(), wrong.to);
    const auto read = ParsePhrases(text, "q.toml");
    ASSERT_FALSE(read.ok()) << wrong.to;
    EXPECT_NE(read.error().message.find(wrong.message), std::string::npos)
        << read.error().message << "\nexpected " << wrong.message;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
  EXPECT_NE(ReadPhrases("/nowhere/q.toml").error().message.find("check --phrases"),
            std::string::npos);
}

TEST(PhrasesFile, WordsThatAreTooLongAreCutNotRefused) {
  Phrases phrases = English();
  phrases.full = std::string(290, 'a') + "{task}";
  phrases.other_verb.task = std::string(280, 'b') + "{words}{object}";
  phrases.nouns["Box"] = {"a", std::string(290, 'c'), "d", {}, {}};
  phrases.again = std::string(280, 'e') + "{question}";
  const Affordances affordances = TestAffordances();
  const Situation situation = MakeSituation(affordances, Things(affordances, {{"Box", 1}}));
  const std::string text = TextAgain(affordances, situation, AskPair(situation, 0), phrases);
  EXPECT_EQ(text.size(), 1000u);
}

}  // namespace
}  // namespace beckon::intention
