#include "services/ui_bridge/console_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

namespace beckon::ui_bridge {
namespace {

using Kind = ConsoleInput::Kind;

std::string Normalised(const std::string& line) {
  std::string text;
  for (const unsigned char c : line) {
    if (std::isspace(c) == 0) text += static_cast<char>(std::tolower(c));
  }
  return text;
}

bool IsYesNo(const msg::Query& query) {
  return query.kind != msg::QueryKind::kChoice && query.kind != msg::QueryKind::kWhatIsIt;
}

/// "y = yes, n = no", in the language of the question.
std::string HowToAnswer(const msg::Query& query) {
  if (!IsYesNo(query)) return "1 to " + std::to_string(query.options.size()) + " = that one";
  std::string text;
  for (const auto& option : query.options) {
    const std::string word = Normalised(option.text);
    text += (text.empty() ? "" : ", ") + word.substr(0, 1) + " = " + word;
  }
  return text;
}

/// Whether a word is an option's text, or the first letter of "Yes" or "No".
bool Says(const msg::Query& query, const msg::Option& option, const std::string& word) {
  const std::string text = Normalised(option.text);
  return word == text || (IsYesNo(query) && word == text.substr(0, 1));
}

/// "SprayCan" -> "spray can".
std::string Noun(const std::string& category) {
  std::string noun;
  for (const unsigned char c : category) {
    if (std::isupper(c) != 0 && !noun.empty()) noun += ' ';
    noun += static_cast<char>(std::tolower(c));
  }
  return noun;
}

std::string Name(const msg::SceneObject& object, const ToldCategories& told) {
  if (const auto said = told.find(object.id); said != told.end()) return Noun(said->second);
  if (object.category == msg::kUnknownCategory) return "something unknown";
  return Noun(object.category) + (object.ask_user ? ", perhaps" : "");
}

std::vector<const msg::SceneObject*> FromLeft(const msg::Scene& scene) {
  std::vector<const msg::SceneObject*> objects;
  for (const auto& object : scene.objects) objects.push_back(&object);
  std::ranges::stable_sort(objects, {}, [](const auto* object) { return object->centroid_W.x(); });
  return objects;
}

std::string Distance(const msg::SceneObject& object) {
  return std::to_string(std::lround(100 * object.centroid_W.head<2>().norm())) + " cm away";
}

/// "number 3 of 7 from the left, 62 cm away"; empty where the scene has no such object.
std::string Whereabouts(const msg::Scene& scene, int object_id) {
  const auto objects = FromLeft(scene);
  for (size_t i = 0; i < objects.size(); ++i) {
    if (objects[i]->id != object_id) continue;
    return "number " + std::to_string(i + 1) + " of " + std::to_string(objects.size()) +
           " from the left, " + Distance(*objects[i]);
  }
  return {};
}

ConsoleInput Unknown(const std::string& line, const msg::Query* query) {
  const std::string can = query != nullptr ? "please type " + HowToAnswer(*query) + "; ? = help"
                                           : "there is no question to answer; ? = help";
  return {Kind::kUnknown, 0, "'" + line.substr(0, 40) + "': " + can};
}

/// A line across the terminal.
std::string Rule() { return std::string(60, '-') + "\n"; }

/// "-> number 2 of 6 from the left, 101 cm away" where the question is about one object.
std::string PointAt(const msg::Query& query, const msg::Scene* scene) {
  if (scene == nullptr || query.objects.size() != 1) return {};
  if (query.any_object && query.kind != msg::QueryKind::kWhatIsIt) return {};
  const std::string where = Whereabouts(*scene, query.objects.front().object_id);
  return where.empty() ? "" : "  -> " + where + "\n";
}

}  // namespace

ConsoleInput ParseLine(const std::string& line, const msg::Query* query) {
  static const std::map<std::string, Kind> kWords = {
      {"u", Kind::kUndo},        {"undo", Kind::kUndo},        {"back", Kind::kUndo},
      {"0", Kind::kNoneOfThese}, {"none", Kind::kNoneOfThese}, {"noneofthese", Kind::kNoneOfThese},
      {"s", Kind::kStop},        {"stop", Kind::kStop},        {"r", Kind::kResume},
      {"resume", Kind::kResume}, {"q", Kind::kQuit},           {"quit", Kind::kQuit},
      {"exit", Kind::kQuit},     {"new", Kind::kNew},          {"", Kind::kNothing},
      {"?", Kind::kHelp},        {"h", Kind::kHelp},           {"help", Kind::kHelp}};
  const std::string text = Normalised(line);
  if (const auto word = kWords.find(text); word != kWords.end()) return {word->second, 0, {}};
  if (query == nullptr) return Unknown(line, query);
  for (size_t i = 0; i < query->options.size(); ++i) {
    if (Says(*query, query->options[i], text)) return {Kind::kOption, i, {}};
  }
  size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (whole && number >= 1 && number <= query->options.size())
    return {Kind::kOption, number - 1, {}};
  return Unknown(line, query);
}

std::string RenderWelcome() {
  return "\nThink of one thing on the table, and of what the robot should do with it:\n"
         "grasp, move, push, open it, drink or pour from it, ...\n"
         "Beckon finds out by asking as little as it can.\n";
}

std::string RenderHelp(const msg::Query* query) {
  return (query != nullptr ? "  " + HowToAnswer(*query) + "\n" : "") +
         "  u = undo the last answer   0 = none of these\n"
         "  s = stop everything        q = quit\n";
}

std::string RenderScene(const msg::Scene& scene, const ToldCategories& told) {
  if (scene.objects.empty()) return "Nothing is seen on the table.\n";
  std::string text = "\nOn the table, from left to right:\n";
  int number = 0;
  for (const auto* object : FromLeft(scene)) {
    text += "  " + std::to_string(++number) + ". " + Name(*object, told) + " (" +
            Distance(*object) + ")\n";
  }
  return text;
}

std::string RenderQuestion(const msg::Query& query, const msg::Scene* scene,
                           const QuestionStyle& style) {
  std::string text = style.terminal ? "\n" + Rule() : "\n";
  text += "Question " + std::to_string(query.questions_asked + 1);
  const auto left = std::lround(query.expected_questions - 1);
  if (left >= 1) text += ", about " + std::to_string(left) + " more";
  text +=
      style.terminal ? "\n\n  \x1b[1m" + query.text + "\x1b[0m\n" : "\n\n  " + query.text + "\n";
  text += PointAt(query, scene) + "\n";
  if (!IsYesNo(query)) {
    for (size_t i = 0; i < query.options.size(); ++i) {
      text += "  " + std::to_string(i + 1) + "  " + query.options[i].text + "\n";
    }
    text += "\n";
  }
  return text + (style.brief ? "  " + HowToAnswer(query) + ", ? = help\n" : RenderHelp(&query)) +
         "> ";
}

std::string RenderSession(const msg::Session& event) {
  switch (event.kind) {
    case msg::SessionKind::kBegun:
      return event.text;
    case msg::SessionKind::kConfirmed:
      return "\nThe robot was told" + (event.text.empty() ? "." : ": " + event.text) + " (" +
             std::to_string(event.questions) +
             (event.questions == 1 ? " question)" : " questions)");
    case msg::SessionKind::kAbandoned:
      return "The conversation ended without a task" +
             (event.text.empty() ? "." : ": " + event.text);
    case msg::SessionKind::kStopped:
      return "\nSTOPPED. Type r to resume.";
    default:
      return {};
  }
}

std::string RenderTaskStatus(const msg::TaskStatus& status) {
  const std::string text = status.text.empty() ? "" : ": " + status.text;
  switch (status.state) {
    case msg::TaskState::kAccepted:
      return "The robot has taken the task" + text;
    case msg::TaskState::kRunning:
      return "The robot is at it" + text;
    case msg::TaskState::kDone:
      return "The robot is done" + text;
    case msg::TaskState::kFailed:
      return "The robot could not do it" + text;
    case msg::TaskState::kExpired:
      return "No robot took the task in time" + text;
    case msg::TaskState::kRevoked:
      return "The task was taken back" + text;
  }
  return {};
}

}  // namespace beckon::ui_bridge
