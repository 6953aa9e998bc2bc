// Keeps each user's settings in a file of their own, written beside the loop's thread: a slow disk
// holds nobody up.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "services/base/result.h"
#include "services/ui_bridge/web/settings.h"

namespace beckon::ui_bridge::web {

class SettingsStore {
 public:
  /// `folder` is made when it is first written to.
  explicit SettingsStore(std::string folder);
  /// Writes what is still to be written.
  ~SettingsStore();

  /// Of a user with a valid name; the defaults where nothing was kept. Fails where the file is no
  /// file of settings.
  Result<Settings> Load(const std::string& user) const;
  /// Returns at once. The file is whole, old or new, whatever happens meanwhile.
  void Save(const std::string& user, const Settings& settings);
  /// Waits until all is written.
  void Flush();

 private:
  std::string PathOf(const std::string& user) const;
  void Work();

  const std::string folder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::string> waiting_;  // text by user
  bool writing_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

/// Writes a file anew or not at all, readable for its owner alone. Makes its folder.
Status WriteWhole(const std::string& path, const std::string& text);

}  // namespace beckon::ui_bridge::web
