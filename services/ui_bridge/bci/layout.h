// Which class of the decoder stands for what: the options of a question from the first class on,
// row by row, and what can be said without a hand (stop, undo, pause) in the last ones. A class
// keeps its place: stop is always in the same cell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/result.h"

namespace beckon::ui_bridge::bci {

enum class Control { kStop, kUndo, kPause };

/// "stop", "undo", "pause".
const char* Name(Control control);
std::optional<Control> FindControl(const std::string& name);

struct LayoutConfig {
  // Binary: two classes for yes and no, then one a control; only yes/no questions are asked.
  msg::StimulusMode mode = msg::StimulusMode::kMatrix;
  int rows = 2;                   // of the matrix; rows x columns <= 64
  int columns = 2;                // rows x columns - controls >= 2
  std::vector<Control> controls;  // in the last cells, in this order; none twice
  double control_prior = 0.02;    // 0 .. 0.2, P(meant) of each, for when to stop
};

/// Fails where a control stands there twice, or fewer than two classes are left for options.
Status Check(const LayoutConfig& config);
size_t Classes(const LayoutConfig& config);
/// That a question may have.
size_t MaxOptions(const LayoutConfig& config);
/// Of a control; empty where it is not offered.
std::optional<size_t> ClassOf(const LayoutConfig& config, Control control);

/// What is shown and decoded while one question lasts. Options are the first classes.
struct Layout {
  msg::StimulusMode mode = msg::StimulusMode::kMatrix;
  int rows = 1;
  int columns = 2;
  std::vector<std::string> labels;  // one a class, empty: nothing there
  std::vector<double> prior;        // P(meant), one a class, sum 1; 0: nothing there
  std::vector<bool> ends;           // whether it ends the conversation, where it is not corrected
  std::vector<std::optional<Control>> controls;  // one a class
  size_t options = 0;
};

/// Fails where the question has more options than there are classes for.
Result<Layout> LayOut(const LayoutConfig& config, const msg::Query& query);
/// Of a question of this front end's own, whose first option has `first_prior`, the others share
/// the rest. No options: only controls.
Layout LayOut(const LayoutConfig& config, const std::vector<std::string>& options,
              double first_prior);

}  // namespace beckon::ui_bridge::bci
