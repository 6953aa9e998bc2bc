// Types at the console, through a pipe.
#pragma once

#include <unistd.h>

#include <array>

#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {
class ConsoleHand final : public Hand {
 public:
  ConsoleHand() {
    std::array<int, 2> pipe_ends{};
    if (pipe(pipe_ends.data()) != 0) throw std::runtime_error("no pipe");
    dup2(pipe_ends[0], STDIN_FILENO);
    close(pipe_ends[0]);
    keyboard_ = pipe_ends[1];
  }
  ~ConsoleHand() override { close(keyboard_); }

  std::string front_end() const override { return "console"; }
  size_t Choose(const msg::Query& query, size_t option) override {
    if (query.options.size() == 2) {
      Type(option == 0 ? "y" : "n");
    } else {
      Type(std::to_string(option + 1));
    }
    return option;
  }
  bool Stop() override { return Type("s"); }
  bool Resume() override { return Type("r"); }
  bool Undo() override { return Type("u"); }

 private:
  bool Type(const std::string& line) {
    const std::string text = line + "\n";
    return write(keyboard_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  }

  int keyboard_ = -1;
};

}  // namespace beckon::ui_bridge::conformance
