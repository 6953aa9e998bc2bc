// What a front end is: one way in which a person, or a program in a person's place, sees questions
// and answers them. A front end is one file front_end_NAME.cpp that registers its factory; nothing
// else has to know of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/config.h"
#include "services/base/result.h"

namespace CLI {
class App;
}

namespace beckon {
class Bus;
class RunLoop;
}  // namespace beckon

namespace beckon::ui_bridge {

/// What a front end says. All calls in the loop's thread.
class FrontEndSink {
 public:
  virtual ~FrontEndSink() = default;
  /// How likely what was received is under each option of the question; `OneHot` for a press.
  virtual void Answer(int64_t query_id, const std::vector<double>& likelihoods) = 0;
  /// A REQUEST_* of session_t. kRequestStop is sent at once and repeated until intention has
  /// stopped; kRequestProfile is repeated until a profile of the user came.
  virtual void Request(msg::SessionKind request) = 0;
  /// Somebody else is in front of it now. What runs is cancelled; ShowUser tells every front end of
  /// this program when that is done. Fails where the name is none.
  virtual Status ChooseUser(const std::string& user) = 0;
  /// This front end is through; the program ends when all are, but for endless ones.
  virtual void Finish() = 0;
};

/// 1 for `option` of `n`, 0 for the others.
std::vector<double> OneHot(size_t option, size_t n);

class FrontEnd {
 public:
  virtual ~FrontEnd() = default;

  /// What it can do; published once a second (utime and device are filled in).
  virtual msg::Interface Announce() const = 0;
  /// Called once everything runs.
  virtual void Begin() = 0;
  /// A new question; it replaces the one before. Called once for each.
  virtual void Present(const msg::Query& query) = 0;
  /// The question no longer stands.
  virtual void Withdraw() = 0;
  /// The course of the conversation changed (BEGUN, CONFIRMED, ABANDONED, STOPPED, IDLE).
  virtual void ShowSession(const msg::Session& event) = 0;
  /// A line for the user that is no question.
  virtual void ShowNotice(const std::string& text) = 0;
  /// What is on the table, whenever it is seen anew.
  virtual void ShowScene(const msg::Scene&) {}
  /// What the robot was told to do for this user.
  virtual void ShowTask(const msg::Task&) {}
  /// What became of a task.
  virtual void ShowTaskStatus(const msg::TaskStatus&) {}
  /// Whose wishes it asks for from now on.
  virtual void ShowUser(const std::string&) {}
  /// The user's past, after kRequestProfile and whenever it grew.
  virtual void ShowProfile(const msg::Profile&) {}
  /// Whether it waits for people who may come at any time, so that the program does not stay for
  /// its sake when the others are through.
  virtual bool Endless() const { return false; }
  /// One line for BECKON_STATUS.
  virtual std::string State() const = 0;
};

/// What a front end is made with; all outlive it.
struct FrontEndSetup {
  std::string device;
  std::string user;             // until ShowUser
  int exit_after_sessions = 0;  // Finish after so many sessions, confirmed or not; 0 = never
  RunLoop& loop;
  FrontEndSink& sink;
  Bus& bus;  // for messages beyond those that FrontEnd is shown; subscribe in Begin
};

class FrontEndFactory {
 public:
  virtual ~FrontEndFactory() = default;
  /// As in --front-end NAME.
  virtual std::string name() const = 0;
  /// One line for --help.
  virtual std::string summary() const = 0;
  /// Adds its flags; they are parsed before the next calls.
  virtual void AddOptions(CLI::App&) {}
  /// Reads its section of the configuration file.
  virtual void Configure(ConfigTable) {}
  virtual Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) = 0;
};

/// All that were registered, by name. Called once a program.
std::vector<std::unique_ptr<FrontEndFactory>> MakeFrontEndFactories();

/// A front end's file ends with one of these at namespace scope, given a function that makes its
/// factory.
class FrontEndRegistration {
 public:
  using Make = std::unique_ptr<FrontEndFactory> (*)();
  explicit FrontEndRegistration(Make make);
};

}  // namespace beckon::ui_bridge
