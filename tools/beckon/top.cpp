#include "tools/beckon/top.h"

#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <ctime>

#include "services/base/bus.h"
#include "services/base/raw_terminal.h"
#include "services/base/run_loop.h"
#include "tools/beckon/top_json.h"
#include "tools/beckon/top_view.h"

namespace beckon::tool {
namespace {

constexpr Utime kRedraw_us = kSecond / 2;

std::string WallClock() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  std::array<char, 16> text{};
  localtime_r(&now, &local);
  return {text.data(), std::strftime(text.data(), text.size(), "%T", &local)};
}

/// The screen, from the first Draw until the end: another page than the shell's, with no cursor.
class Screen {
 public:
  Screen() {
    MakeTerminalRaw();
    Put("\x1b[?1049h\x1b[?25l");
  }
  ~Screen() {
    Put("\x1b[?25h\x1b[?1049l");
    RestoreTerminal();
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  static TopScreen Size() {
    TopScreen screen{.columns = 80, .rows = 24};
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
      screen.columns = size.ws_col;
      screen.rows = size.ws_row;
    }
    return screen;
  }

  void Draw(const std::vector<std::string>& lines) {
    std::string page = "\x1b[H";
    for (size_t i = 0; i < lines.size(); ++i) page += (i == 0 ? "" : "\n") + lines[i] + "\x1b[K";
    Put(page + "\x1b[J");
  }

 private:
  static void Put(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }
};

/// What is heard.
class Ears {
 public:
  explicit Ears(Bus& bus) {
    bus.Subscribe<msg::Status>(
        [this](const msg::Status& status) { model_.OnStatus(status, steady_.Now()); });
    bus.Subscribe<msg::Session>(
        [this](const msg::Session& session) { talks_.OnSession(session, steady_.Now()); });
    bus.Subscribe<msg::Query>(
        [this](const msg::Query& query) { talks_.OnQuery(query, steady_.Now()); });
    bus.Subscribe<msg::Task>([this](const msg::Task& task) { talks_.OnTask(task, steady_.Now()); });
    bus.Subscribe<msg::TaskStatus>(
        [this](const msg::TaskStatus& status) { talks_.OnTaskStatus(status, steady_.Now()); });
  }

  std::vector<TopRow> Rows(TopSort sort) const { return model_.Rows(steady_.Now(), sort); }
  TopTalks Talks() const { return talks_.View(steady_.Now()); }

 private:
  const SteadyClock steady_;
  TopModel model_;
  TopConversations talks_;
};

Result<int> LookOnce(const TopOptions& options, const std::string& lcm_url, const Ears& ears,
                     RunLoop& loop) {
  loop.After(static_cast<Utime>(options.wait_s * kSecond), [&loop] { loop.Stop(); });
  loop.Run();
  const auto rows = ears.Rows(TopSort::kService);
  TopScreen screen = Screen::Size();
  if (isatty(STDOUT_FILENO) != 1) screen.columns = SIZE_MAX;
  screen.rows = 0;
  screen.clock = WallClock();
  if (options.json) {
    std::printf("%s\n", TopJson(rows, ears.Talks()).c_str());
  } else {
    for (const auto& line : DrawTop(rows, ears.Talks(), screen)) std::printf("%s\n", line.c_str());
  }
  if (!rows.empty()) return 0;
  std::fprintf(stderr, "beckon: nobody is heard on %s\n", lcm_url.c_str());
  return 1;
}

class Live {
 public:
  Live(const Ears& ears, RunLoop& loop) : ears_(ears), loop_(loop) {
    loop_.AddFd(STDIN_FILENO, [this] { ReadKeys(); });
    loop_.Every(kRedraw_us, [this] { Draw(); });
    Draw();
  }

 private:
  void Draw() {
    TopScreen size = Screen::Size();
    size.colour = true;
    size.clock = WallClock();
    size.rows -= size.rows > 1 ? 1 : 0;  // for the keys
    auto lines = DrawTop(ears_.Rows(sort_), ears_.Talks(), size);
    lines.resize(size.rows);
    lines.push_back(("q leaves; sort by: " + std::string(kSortKeysHelp)).substr(0, size.columns));
    screen_.Draw(lines);
  }

  void ReadKeys() {
    std::array<char, 64> keys;
    const ssize_t n = read(STDIN_FILENO, keys.data(), keys.size());
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (n <= 0) return loop_.Stop();  // the terminal is gone
    for (ssize_t i = 0; i < n; ++i) {
      if (keys[static_cast<size_t>(i)] == 'q') return loop_.Stop();
      sort_ = SortOfKey(keys[static_cast<size_t>(i)]).value_or(sort_);
    }
    Draw();
  }

  const Ears& ears_;
  RunLoop& loop_;
  Screen screen_;
  TopSort sort_ = TopSort::kService;
};

}  // namespace

Result<int> RunTop(const TopOptions& options, const std::string& lcm_url) {
  const bool once = options.once || options.json;
  if (!once && (isatty(STDIN_FILENO) != 1 || isatty(STDOUT_FILENO) != 1))
    return Error{"top: needs a terminal; 'beckon top --once' prints one table"};
  RunLoop loop(/*handle_signals=*/true);
  auto bus = Bus::Open(lcm_url);
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  const Ears ears(**bus);
  if (once) return LookOnce(options, lcm_url, ears, loop);
  spdlog::set_level(spdlog::level::off);  // it would draw over the table
  const Live live(ears, loop);
  loop.Run();
  return 0;
}

}  // namespace beckon::tool
