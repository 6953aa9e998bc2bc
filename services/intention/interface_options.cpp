#include "services/intention/interface_options.h"

#include <CLI/CLI.hpp>
#include <map>

#include "services/base/app.h"

namespace beckon::intention {

void AddInterfaceOptions(CLI::App& command, Interface& interface) {
  static const std::map<std::string, InterfaceKind> kinds = {{"yesno", InterfaceKind::kYesNo},
                                                             {"choice", InterfaceKind::kChoice},
                                                             {"scan", InterfaceKind::kScan},
                                                             {"vector", InterfaceKind::kVector}};
  command
      .add_option("--interface", interface.kind,
                  "How the user answers: yesno (default), choice (of all options at once), scan (a "
                  "press takes the option that is shown), vector (a probability for each)")
      ->transform(CLI::CheckedTransformer(kinds).description("yesno|choice|scan|vector"));
  command
      .add_option("--max-options", interface.max_options,
                  "Most answers of a question, \"none of these\" among them")
      ->check(CLI::Range(2, 64))
      ->capture_default_str();
  command
      .add_option("--seconds-per-question", interface.seconds_per_question, "Time of a question")
      ->check(Within(0.001, 1000.0))
      ->capture_default_str();
  command
      .add_option("--seconds-per-option", interface.seconds_per_option,
                  "Time that each answer of a question adds; of a scan: each one shown")
      ->check(Within(0.0, 1000.0))
      ->capture_default_str();
}

}  // namespace beckon::intention
