// What beckon-perception is told on its command line.
#pragma once

#include "services/base/app.h"
#include "services/perception/offline.h"
#include "services/perception/perception_config.h"

namespace beckon::perception {

struct Options {
  AppOptions app;
  OfflineOptions offline;
  Overrides overrides;
  bool list_categories = false;
};

void AddOptions(CLI::App& app, Options& o);

}  // namespace beckon::perception
