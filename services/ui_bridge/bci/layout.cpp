#include "services/ui_bridge/bci/layout.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace beckon::ui_bridge::bci {
namespace {

constexpr std::array<const char*, 3> kNames = {"stop", "undo", "pause"};
constexpr std::array<const char*, 3> kLabels = {"STOP", "Undo", "Pause"};
/// Of an option that whoever asks thinks impossible: they may be wrong.
constexpr double kLeastPrior = 0.01;
/// Answers still needed after an option, below which it ends the conversation.
constexpr float kNoneLeft = 0.05f;

Layout Empty(const LayoutConfig& config) {
  const bool matrix = config.mode == msg::StimulusMode::kMatrix;
  const size_t classes = Classes(config);
  Layout layout;
  layout.mode = config.mode;
  layout.rows = matrix ? config.rows : 1;
  layout.columns = static_cast<int>(classes) / layout.rows;
  layout.labels.resize(classes);
  layout.prior.assign(classes, 0.0);
  layout.ends.assign(classes, false);
  layout.controls.resize(classes);
  return layout;
}

void PutControls(const LayoutConfig& config, bool can_undo, Layout& layout) {
  for (const Control control : config.controls) {
    if (control == Control::kUndo && !can_undo) continue;
    const size_t place = *ClassOf(config, control);
    layout.labels[place] = kLabels[static_cast<size_t>(control)];
    layout.prior[place] = config.control_prior;
    layout.controls[place] = control;
  }
}

void ScalePrior(Layout& layout) {
  double sum = 0;
  for (const double p : layout.prior) sum += p;
  if (sum > 0)
    for (double& p : layout.prior) p /= sum;
}

}  // namespace

const char* Name(Control control) { return kNames[static_cast<size_t>(control)]; }

std::optional<Control> FindControl(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Control>(found - kNames.begin());
}

Status Check(const LayoutConfig& config) {
  for (size_t i = 0; i < config.controls.size(); ++i) {
    if (std::count(config.controls.begin(), config.controls.end(), config.controls[i]) > 1)
      return Error{"control '" + std::string(Name(config.controls[i])) + "' is there twice"};
  }
  const size_t classes = Classes(config);
  if (classes > 64) return Error{"at most 64 classes, found " + std::to_string(classes)};
  if (classes < config.controls.size() + 2) {
    return Error{"expected at least two classes beside the controls, found " +
                 std::to_string(classes) + " with " + std::to_string(config.controls.size()) +
                 " controls"};
  }
  return {};
}

size_t Classes(const LayoutConfig& config) {
  if (config.mode == msg::StimulusMode::kBinary) return 2 + config.controls.size();
  return static_cast<size_t>(config.rows) * static_cast<size_t>(config.columns);
}

size_t MaxOptions(const LayoutConfig& config) { return Classes(config) - config.controls.size(); }

std::optional<size_t> ClassOf(const LayoutConfig& config, Control control) {
  const auto found = std::find(config.controls.begin(), config.controls.end(), control);
  if (found == config.controls.end()) return std::nullopt;
  return MaxOptions(config) + static_cast<size_t>(found - config.controls.begin());
}

Result<Layout> LayOut(const LayoutConfig& config, const msg::Query& query) {
  if (query.options.size() > MaxOptions(config)) {
    return Error{"a question with " + std::to_string(query.options.size()) +
                 " answers, for which the decoder has " + std::to_string(MaxOptions(config)) +
                 " classes; another front end has to answer it"};
  }
  Layout layout = Empty(config);
  layout.options = query.options.size();
  const bool known = query.prospects.size() == layout.options;
  const double even = 1 / static_cast<double>(layout.options);
  double sum = 0;
  for (size_t i = 0; i < layout.options; ++i) {
    layout.labels[i] = query.options[i].text;
    const double p = known ? static_cast<double>(query.prospects[i].probability) : even;
    sum += layout.prior[i] = std::isfinite(p) ? std::clamp(p, kLeastPrior, 1.0) : even;
    layout.ends[i] = known && query.prospects[i].questions_left < kNoneLeft;
  }
  const double options = 1 - config.control_prior * static_cast<double>(config.controls.size());
  for (size_t i = 0; i < layout.options; ++i) layout.prior[i] *= options / sum;
  PutControls(config, query.questions_asked > 0, layout);
  ScalePrior(layout);
  return layout;
}

Layout LayOut(const LayoutConfig& config, const std::vector<std::string>& options,
              double first_prior) {
  Layout layout = Empty(config);
  layout.options = options.size();
  for (size_t i = 0; i < options.size(); ++i) {
    layout.labels[i] = options[i];
    layout.prior[i] =
        i == 0 ? first_prior : (1 - first_prior) / static_cast<double>(options.size() - 1);
  }
  PutControls(config, false, layout);
  if (const auto pause = ClassOf(config, Control::kPause)) {
    layout.labels[*pause].clear();
    layout.prior[*pause] = 0;
    layout.controls[*pause].reset();
  }
  ScalePrior(layout);
  return layout;
}

}  // namespace beckon::ui_bridge::bci
