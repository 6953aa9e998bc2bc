// Phones, words and what may be said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ui_bridge/speech/grammar.h"
#include "services/ui_bridge/speech/prompt.h"

namespace beckon::ui_bridge::speech {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Pronunciation Say(const std::string& phones) { return *ParsePronunciation(phones); }

msg::Query Question(msg::QueryKind kind, const std::vector<std::string>& options) {
  msg::Query query;
  query.kind = kind;
  query.text = "Which one?";
  for (const auto& text : options) {
    msg::Option option;
    option.text = text;
    query.options.push_back(option);
  }
  return query;
}

Lexicon SmallLexicon() {
  Lexicon lexicon;
  for (const auto& [word, phones] :
       std::vector<std::pair<std::string, std::string>>{{"yes", "Y EH S"},
                                                        {"yeah", "Y AE"},
                                                        {"no", "N OW"},
                                                        {"nope", "N OW P"},
                                                        {"stop", "S T AA P"},
                                                        {"undo", "AH N D UW"},
                                                        {"take", "T EY K"},
                                                        {"that", "DH AE T"},
                                                        {"back", "B AE K"},
                                                        {"none", "N AH N"},
                                                        {"of", "AH V"},
                                                        {"these", "DH IY Z"},
                                                        {"resume", "R IH Z UW M"},
                                                        {"start", "S T AA R T"},
                                                        {"repeat", "R IH P IY T"},
                                                        {"number", "N AH M B ER"},
                                                        {"one", "W AH N"},
                                                        {"two", "T UW"},
                                                        {"three", "TH R IY"},
                                                        {"open", "OW P AH N"},
                                                        {"the", "DH AH"},
                                                        {"the", "DH IY"},
                                                        {"carton", "K AA R T AH N"},
                                                        {"shop", "SH AA P"},
                                                        {"go", "G OW"}}) {
    lexicon.Add(word, Say(phones));
  }
  return lexicon;
}

TEST(Phones, AreReadWithAndWithoutStress) {
  EXPECT_EQ(Say("S T AA1 P"), Say("S T AA P"));
  EXPECT_EQ(ToText(Say("Y EH0 S")), "Y EH S");
}

TEST(Phones, RefuseWhatIsNoneAndNameIt) {
  const auto wrong = ParsePronunciation("Y EH Q");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("'Q'"));
  EXPECT_FALSE(ParsePronunciation(""));
}

TEST(Phones, MayBeOneWithinAPhrase) {
  const auto a = ParsePronunciation("AH0");
  ASSERT_TRUE(a) << a.error().message;
  EXPECT_EQ(a->size(), 1u);
}

TEST(Phones, ComeFromEspeaksMnemonics) {
  EXPECT_EQ(*FromEspeak("s_t_'A:_p"), Say("S T AA P"));
  EXPECT_EQ(*FromEspeak("n_'i@_r_I_s_t"), Say("N IY R IH S T"));
  EXPECT_EQ(*FromEspeak("b_'V_?_n-"), Say("B AH T AH N"));
  EXPECT_FALSE(FromEspeak("y*_Q"));
  EXPECT_FALSE(FromEspeak(""));
}

TEST(Phones, AreSaidWithoutRToo) {
  EXPECT_EQ(WithoutR(Say("N AH M B ER")), Say("N AH M B AH"));
  EXPECT_EQ(WithoutR(Say("S T AA R T")), Say("S T AA T"));
  EXPECT_EQ(WithoutR(Say("R IH P IY T")), Say("R IH P IY T"));
  EXPECT_EQ(WithoutR(Say("TH R IY")), Say("TH R IY"));
}

TEST(Phones, AreSaidWithARoundOToo) {
  EXPECT_EQ(WithRoundO(Say("S T AA P")), Say("S T AO P"));
  EXPECT_EQ(WithRoundO(Say("S T AA R T")), Say("S T AA R T"));
  EXPECT_EQ(WithRoundO(Say("N OW")), Say("N OW"));
}

TEST(Phones, AreSaidInEachAccentOnce) {
  EXPECT_THAT(InAccents(Say("N OW")), ElementsAre(Say("N OW")));
  EXPECT_THAT(InAccents(Say("S T AA P")), ElementsAre(Say("S T AA P"), Say("S T AO P")));
  EXPECT_THAT(InAccents(Say("S T AA R T")),
              ElementsAre(Say("S T AA R T"), Say("S T AA T"), Say("S T AO T")));
}

TEST(Phones, LieFurtherApartTheLessTheyAreAlike) {
  EXPECT_EQ(Distance(Say("S T AA P"), Say("S T AA P")), 0);
  EXPECT_DOUBLE_EQ(Distance(Say("S T AA P"), Say("S T AA K")), kAlike);
  EXPECT_EQ(Distance(Say("S T AA P"), Say("S T AA N")), 1);
  EXPECT_EQ(Distance(Say("N OW"), Say("N OW P")), Distance(Say("N OW P"), Say("N OW")));
}

TEST(Words, AreNormalisedFromWhatIsWritten) {
  EXPECT_EQ(Normalised("Open the carton?"), "open the carton");
  EXPECT_EQ(Normalised("SprayCan"), "spray can");
  EXPECT_EQ(Normalised("Mug number 3"), "mug number three");
  EXPECT_EQ(Normalised("?!"), "");
}

TEST(Words, OfSeveralPronunciationsAreAllSaid) {
  const auto said = SmallLexicon().Say("the carton");
  ASSERT_TRUE(said);
  EXPECT_EQ(said->size(), 2u);
  const auto missing = SmallLexicon().Say("the gizmo");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("gizmo"));
}

TEST(Commands, OfAYesNoQuestionAreItsAnswersAndWhatIsAlwaysPossible) {
  const auto query = Question(msg::QueryKind::kFull, {"Yes", "No"});
  int options = 0;
  bool stop = false;
  for (const auto& command : CommandsFor(&query, {})) {
    options += command.kind == CommandKind::kOption ? 1 : 0;
    stop |= command.kind == CommandKind::kStop;
    EXPECT_NE(command.kind, CommandKind::kResume);
  }
  EXPECT_EQ(options, 2);
  EXPECT_TRUE(stop);
}

TEST(Commands, OfAChoiceAreItsOptionsByNameAndNumber) {
  const auto query = Question(msg::QueryKind::kChoice, {"Open the carton", "None of these"});
  std::vector<std::string> first;
  for (const auto& command : CommandsFor(&query, {})) {
    if (command.kind == CommandKind::kOption && command.option == 0) first = command.phrases;
    EXPECT_NE(command.kind, CommandKind::kNone) << "the last option says it already";
  }
  EXPECT_THAT(first, ElementsAre("open the carton", "open carton", "number one"));
}

TEST(Commands, DropAPhraseThatMeansTwoThings) {
  const auto query = Question(msg::QueryKind::kChoice, {"The mug", "A mug", "None of these"});
  for (const auto& command : CommandsFor(&query, {})) {
    if (command.kind == CommandKind::kOption && command.option < 2) {
      EXPECT_THAT(command.phrases, Not(Contains("mug")));
    }
  }
}

TEST(Commands, WithoutAQuestionStopAndResumeRemain) {
  bool stop = false;
  bool resume = false;
  for (const auto& command : CommandsFor(nullptr, {})) {
    stop |= command.kind == CommandKind::kStop;
    resume |= command.kind == CommandKind::kResume;
    EXPECT_NE(command.kind, CommandKind::kOption);
  }
  EXPECT_TRUE(stop && resume);
}

TEST(Grammars, TakeReplacedWordsAndPhones) {
  SpokenWords words;
  words.yes = {"/AA Y/"};
  const auto query = Question(msg::QueryKind::kFull, {"Yes", "No"});
  const auto grammar = BuildGrammar(CommandsFor(&query, words), SmallLexicon(), {});
  ASSERT_TRUE(grammar) << grammar.error().message;
  int yes = 0;
  for (const auto& phrase : grammar->phrases) {
    if (!phrase.command) continue;
    const auto& command = grammar->commands[*phrase.command];
    if (command.kind != CommandKind::kOption || command.option != 0) continue;
    ++yes;
    EXPECT_EQ(phrase.sounds, Say("AA Y"));
  }
  EXPECT_EQ(yes, 1);
}

TEST(Grammars, HaveRivalsThatAreNoPhrases) {
  const auto query = Question(msg::QueryKind::kFull, {"Yes", "No"});
  const auto grammar = BuildGrammar(CommandsFor(&query, {}), SmallLexicon(), {});
  ASSERT_TRUE(grammar);
  std::vector<Pronunciation> rivals;
  for (const auto& phrase : grammar->phrases) {
    if (!phrase.command) rivals.push_back(phrase.sounds);
  }
  EXPECT_THAT(rivals, Contains(Say("G OW")));
  EXPECT_THAT(rivals, Not(Contains(Say("N OW"))));
}

TEST(Grammars, NameTheWordThatIsInNoDictionary) {
  SpokenWords words;
  words.yes = {"blorp"};
  const auto query = Question(msg::QueryKind::kFull, {"Yes", "No"});
  const auto commands = CommandsFor(&query, words);
  EXPECT_THAT(MissingWords(commands, SmallLexicon()), ElementsAre("blorp"));
  const auto grammar = BuildGrammar(commands, SmallLexicon(), {});
  ASSERT_FALSE(grammar);
  EXPECT_THAT(grammar.error().message, HasSubstr("blorp"));
}

TEST(Prompts, NameTheOptionsOfAChoiceByNumber) {
  const auto query = Question(msg::QueryKind::kChoice, {"Open the carton", "None of these"});
  EXPECT_EQ(QuestionPrompt(query, "number", true),
            "Which one? number 1: Open the carton. number 2: None of these.");
}

TEST(Prompts, TeachIntentionHowLongTheyTake) {
  PromptTimes times(160);
  const float before = times.seconds_per_question();
  for (int i = 0; i < 30; ++i) times.Spoken(0, 5);
  EXPECT_GT(times.seconds_per_question(), before);
  EXPECT_NEAR(times.seconds_per_question(), 6.5, 0.1);
  for (int i = 0; i < 60; ++i) times.Spoken(4, 13);
  EXPECT_NEAR(times.seconds_per_option(), 2, 0.2);
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
