// `beckon demo`: the five services on a private bus, from an image to a confirmed task.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::tool {

struct DemoOptions {
  std::string input;  // file for capture; empty = the embedded scene
  std::string want;   // ACTION:CATEGORY of the simulated user; empty = something the scene offers
  int sessions = 0;   // 0 = one where simulated, else until the user leaves
  // Empty: console and web on a terminal; else web where a port is given, simulated where none is.
  std::vector<std::string> front_ends;
  bool headless = false;
  std::string db;           // empty = a temporary one
  int port = 0;             // of the page; 0 = 8765, or any where that is taken
  bool no_browser = false;  // do not open the page in the desktop's browser
  std::string record;       // log to write; empty = none
  std::string picture;      // of what was seen and asked, to write; empty = none
  // Of the embedded scene; this one has a carton, a cup and a bottle among its objects.
  int seed = 11;
  std::string policy;
  std::string user = "demo";
  double think_s = 0;     // of the simulated user, before each answer
  double flip = 0;        // chance that it answers wrongly
  double timeout_s = 30;  // without anything new
  // Folder for the services' logs; empty = a temporary one, kept where it went wrong.
  std::string logs;
};

/// Runs it. 0: done, and every task of a simulated user was right; 1: not so (said in one line on
/// standard error). Bad input is an Error, an image without a table or without objects too.
Result<int> RunDemo(const DemoOptions& options);

}  // namespace beckon::tool
