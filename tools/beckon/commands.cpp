// beckon: what a person does with the whole system: try it, check a machine, run it, record,
// replay.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <tuple>

#include "services/base/app.h"
#include "tools/beckon/demo.h"
#include "tools/beckon/doctor.h"
#include "tools/beckon/fleet.h"
#include "tools/beckon/keys_command.h"
#include "tools/beckon/log_tools.h"
#include "tools/beckon/profile.h"
#include "tools/beckon/top.h"

namespace beckon::tool {
namespace {

void AddDemo(CLI::App& app, DemoOptions& o) {
  auto* demo = app.add_subcommand(
      "demo",
      "Five services on a private bus, from an image to a confirmed task. On a terminal you "
      "answer; "
      "--headless a simulated user does, one JSON line a session comes out, and the exit code is 0 "
      "only if every task was right.");
  demo->add_option("--input", o.input,
                   "PCD, PLY or folder to look at (default: the embedded scene)")
      ->type_name("FILE");
  demo->add_option("--want", o.want,
                   "What the simulated user wants, e.g. Open:Carton, the nearest one "
                   "(default: something the scene offers)")
      ->type_name("ACTION:CATEGORY");
  demo->add_option("--sessions", o.sessions,
                   "Conversations, one after the other (default: 1 simulated, "
                   "without end else)")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("N");
  demo->add_option("--front-end", o.front_ends,
                   "How you are asked, e.g. web or switch; may be given several times (default: "
                   "console and web on a terminal; beckon-ui-bridge --help lists all)")
      ->type_name("NAME");
  demo->add_flag("--headless", o.headless, "No person: the simulated front end answers");
  demo->add_option("--db", o.db, "What is learnt (default: a temporary file)")->type_name("FILE");
  demo->add_option("--port", o.port, "Of the page, on this machine (default: 8765, or a free one)")
      ->check(CLI::Range(1, 65535));
  demo->add_flag("--no-browser", o.no_browser, "Say where the page is, but do not open it");
  demo->add_option("--record", o.record, "Log all messages with lcm-logger")->type_name("LOG");
  demo->add_option("--picture", o.picture,
                   "Draw what was seen, and the first conversation, to a .png or .jpg")
      ->type_name("OUT");
  demo->add_option("--seed", o.seed, "Of the embedded scene and of the simulated user")
      ->check(CLI::NonNegativeNumber);
  demo->add_option("--policy", o.policy, "How questions are chosen, e.g. adaptive, oain")
      ->type_name("NAME");
  demo->add_option("--user", o.user, "Whose habits are learnt (default: demo)")->type_name("NAME");
  demo->add_option("--think", o.think_s, "Seconds the simulated user takes for an answer")
      ->check(CLI::Range(0.0, 600.0));
  demo->add_option("--flip", o.flip, "Chance that it answers wrongly")->check(CLI::Range(0.0, 1.0));
  demo->add_option("--timeout", o.timeout_s,
                   "Seconds without anything new before it gives up (default: 30)")
      ->check(CLI::Range(1.0, 3600.0));
  demo->add_option("--logs", o.logs, "Folder for the services' logs (default: temporary)")
      ->type_name("DIR");
}

struct Options {
  AppOptions app;
  DemoOptions demo;
  KeysOptions keys;
  std::string db, profile, out, log;
  double speed = 1;
  bool hash = false;
  bool list = false;
  ReplayPart part;
  TopOptions top;
};

void AddOthers(CLI::App& app, Options& o) {
  app.add_subcommand("doctor",
                     "Whether this machine has what Beckon needs, and what to do where it has not")
      ->add_option("--db", o.db, "Look at this history too")
      ->type_name("FILE");
  app.add_subcommand("run", "Keeps a profile's processes running until Ctrl-C")
      ->add_option("PROFILE", o.profile,
                   "TOML file, or a profile that ships: one-machine, two-machines/{camera,room}, "
                   "three-machines/{camera,compute,room}")
      ->required();
  app.add_subcommand("record",
                     "Writes all messages to a log (lcm-logger), and LOG.index.json: what is in it")
      ->add_option("--out", o.out, "The log; must not exist")
      ->type_name("LOG")
      ->required();
  auto* replay = app.add_subcommand("replay", "Publishes a log again (lcm-logplayer)");
  replay->add_option("LOG", o.log, "Of 'beckon record' or lcm-logger")->required();
  replay->add_option("--speed", o.speed, "Times its own pace")->check(CLI::Range(0.01, 10.0));
  auto* list = replay->add_flag("--list", o.list, "Say what is in it, and play nothing");
  auto* session = replay
                      ->add_option("--session", o.part.session,
                                   "Only this conversation, by number or id of --list")
                      ->type_name("N|ID")
                      ->excludes(list);
  for (const auto& [name, seconds, help] :
       {std::tuple{"--from", &o.part.from_s, "Only from then on, seconds since its first message"},
        std::tuple{"--to", &o.part.to_s, "Only until then, seconds since its first message"}}) {
    replay->add_option(name, *seconds, help)
        ->check(Within(0, 1e9))
        ->type_name("S")
        ->excludes(list)
        ->excludes(session);
  }
  replay->add_flag("--hash", o.hash, "Lock step with hashes: not part of this version");
}

void AddTop(CLI::App& app, TopOptions& o) {
  auto* top = app.add_subcommand(
      "top", "Live view of every process on the bus, and of the conversations. Keys: q leaves, " +
                 std::string(kSortKeysHelp));
  top->add_flag("--once", o.once, "Print one table and leave; exit code 1 where nothing is heard");
  top->add_flag("--json", o.json, "The same as one JSON object");
  top->add_option("--wait", o.wait_s, "Seconds that --once and --json listen")
      ->check(Within(0.1, 3600))
      ->capture_default_str();
}

Result<int> Run(const CLI::App& app, Options& o) {
  if (app.got_subcommand("demo")) return RunDemo(o.demo);
  if (app.got_subcommand("run")) {
    setenv("BECKON_KEYS", o.app.keys.c_str(), 1);  // for its processes
    return RunProfile(o.profile, o.app.lcm_url);
  }
  if (app.got_subcommand("keys")) {
    o.keys.folder = o.app.keys;
    if (auto done = RunKeys(app, o.keys); !done) return done.error();
    return 0;
  }
  if (app.got_subcommand("doctor")) {
    const auto findings =
        Examine({.lcm_url = o.app.lcm_url, .db = o.db, .bin_dir = OwnBinDir(), .keys = o.app.keys});
    std::fputs(Render(findings).c_str(), stdout);
    return ExitCode(findings);
  }
  if (app.got_subcommand("record")) return Record(o.out, o.app.lcm_url);
  if (app.got_subcommand("top")) return RunTop(o.top, o.app.lcm_url);
  if (o.hash)
    return Error{"replay --hash: not part of this version; 'beckon replay LOG' publishes the log"};
  if (o.list) {
    if (auto listed = ListLog(o.log); !listed) return listed.error();
    return 0;
  }
  return Replay(o.log, o.app.lcm_url, o.speed, o.part).error();
}

}  // namespace

int RunBeckon(int argc, char** argv) {
  CLI::App app("Asks as few questions as possible until a robot arm knows what its user wants.",
               "beckon");
  Options options;
  AddAppOptions(app, options.app);
  app.require_subcommand(1);
  app.fallthrough();
  AddDemo(app, options.demo);
  AddOthers(app, options);
  AddKeys(app, options.keys);
  AddTop(app, options.top);
  int code = 0;
  const int status = RunApp(app, argc, argv, options.app, [&]() -> Status {
    auto result = Run(app, options);
    if (!result) return result.error();
    code = *result;
    return {};
  });
  return status != 0 ? status : code;
}

}  // namespace beckon::tool
