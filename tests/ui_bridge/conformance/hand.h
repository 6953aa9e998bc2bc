// What acts in a person's place at a front end, for tests and measurements.
#pragma once

#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"

namespace beckon::ui_bridge::conformance {

/// What a hand acts with; all outlive it. The loop runs while the front end is waited for.
struct HandSetup {
  Bus& bus;
  RunLoop& loop;
  std::string device;  // of the front end
};

/// The person, or the device in a person's hand: does what leads to an answer at one front end.
/// Made before the front end is, so that it can hold open what the front end reads.
class Hand {
 public:
  virtual ~Hand() = default;

  /// As in --front-end NAME.
  virtual std::string front_end() const = 0;
  /// Its flags, and its section of the configuration file: what makes it quick enough for a test.
  virtual std::vector<std::string> flags() const { return {}; }
  virtual std::string config() const { return {}; }
  /// Longest that it takes from a question, or from a deed of the hand, to what follows.
  virtual double patience_s() const { return 5; }

  /// Once the front end runs.
  virtual void Begin(const HandSetup&) {}
  /// Asks for a session, where the front end does not do so by itself.
  virtual void Start() {}
  /// Answers the question that stands, if it can by this option. Returns the option that it went
  /// for: a simulated user has a will of its own.
  virtual size_t Choose(const msg::Query& query, size_t option) = 0;
  /// Both false where nobody can make this front end stop: where its user is a program.
  virtual bool Stop() = 0;
  virtual bool Resume() = 0;
  /// Takes the last answer back; false where this front end has no way to.
  virtual bool Undo() { return false; }
};

}  // namespace beckon::ui_bridge::conformance
