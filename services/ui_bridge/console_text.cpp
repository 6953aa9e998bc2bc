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
  return query.options.size() == 2 && query.options[0].text == "Yes" &&
         query.options[1].text == "No";
}

std::string HowToAnswer(const msg::Query& query) {
  return IsYesNo(query) ? "y = yes, n = no"
                        : "1-" + std::to_string(query.options.size()) + " = that option";
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
  const std::string can =
      query != nullptr ? HowToAnswer(*query) + ", u = undo, 0 = none of these, s = stop, q = quit"
                       : "there is no question to answer; s = stop, q = quit";
  return {Kind::kUnknown, 0, "'" + line.substr(0, 40) + "': " + can};
}

}  // namespace

ConsoleInput ParseLine(const std::string& line, const msg::Query* query) {
  static const std::map<std::string, Kind> kWords = {
      {"u", Kind::kUndo},        {"undo", Kind::kUndo},        {"back", Kind::kUndo},
      {"0", Kind::kNoneOfThese}, {"none", Kind::kNoneOfThese}, {"noneofthese", Kind::kNoneOfThese},
      {"s", Kind::kStop},        {"stop", Kind::kStop},        {"r", Kind::kResume},
      {"resume", Kind::kResume}, {"q", Kind::kQuit},           {"quit", Kind::kQuit},
      {"exit", Kind::kQuit},     {"new", Kind::kNew},          {"", Kind::kNothing}};
  const std::string text = Normalised(line);
  if (const auto word = kWords.find(text); word != kWords.end()) return {word->second, 0, {}};
  if (query == nullptr) return Unknown(line, query);
  if (IsYesNo(*query)) {
    if (text == "y" || text == "yes") return {Kind::kOption, 0, {}};
    if (text == "n" || text == "no") return {Kind::kOption, 1, {}};
  }
  size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (whole && number >= 1 && number <= query->options.size())
    return {Kind::kOption, number - 1, {}};
  return Unknown(line, query);
}

std::string RenderScene(const msg::Scene& scene) {
  if (scene.objects.empty()) return "Nothing is seen on the table.\n";
  std::string text = "\nOn the table, from left to right:\n";
  int number = 0;
  for (const auto* object : FromLeft(scene)) {
    text += "  " + std::to_string(++number) + ". " + object->category +
            (object->ask_user ? "? " : " ") + "(" + Distance(*object) + ")\n";
  }
  return text;
}

std::string RenderQuestion(const msg::Query& query, const msg::Scene* scene, bool bold) {
  std::string text = "\nQuestion " + std::to_string(query.questions_asked + 1);
  const auto left = std::lround(query.expected_questions - 1);
  if (left >= 1) text += ", about " + std::to_string(left) + " more";
  text += bold ? "\n\n  \x1b[1m" + query.text + "\x1b[0m\n\n" : "\n\n  " + query.text + "\n\n";
  if (scene != nullptr && query.kind == msg::QueryKind::kWhatIsIt && !query.objects.empty()) {
    const std::string where = Whereabouts(*scene, query.objects.front().object_id);
    if (!where.empty()) text += "  (" + where + ")\n\n";
  }
  if (!IsYesNo(query)) {
    for (size_t i = 0; i < query.options.size(); ++i) {
      text += "  " + std::to_string(i + 1) + "  " + query.options[i].text + "\n";
    }
    text += "\n";
  }
  return text + "  (" + HowToAnswer(query) +
         ", u = undo, 0 = none of these, s = stop, q = quit)\n> ";
}

std::string RenderSession(const msg::Session& event) {
  switch (event.kind) {
    case msg::SessionKind::kBegun:
      return event.text;
    case msg::SessionKind::kConfirmed:
      return "Confirmed after " + std::to_string(event.questions) +
             (event.questions == 1 ? " answer" : " answers") +
             (event.text.empty() ? "." : ": " + event.text);
    case msg::SessionKind::kAbandoned:
      return "The conversation ended without a task" +
             (event.text.empty() ? "." : ": " + event.text);
    case msg::SessionKind::kStopped:
      return "STOPPED." + (event.text.empty() ? "" : " " + event.text) + " Type r to resume.";
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
