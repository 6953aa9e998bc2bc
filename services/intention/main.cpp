// beckon-intention: finds out with as few questions as possible what the user wants done.
#include <CLI/CLI.hpp>

#include "services/intention/commands.h"

int main(int argc, char** argv) {
  CLI::App app("Finds out with as few questions as possible what the user wants done.",
               "beckon-intention");
  beckon::intention::CommandLine command_line(app);
  return beckon::RunApp(app, argc, argv, command_line.common(), [&] { return command_line.Run(); });
}
