// What every front end must do, as tests that run against any of them:
// `beckon_front_end_conformance` makes a test program of them and of one Hand, which acts in a
// person's place.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {

/// Makes a hand for each test; printed as its front end's name.
struct MakeHand {
  const char* name;
  std::unique_ptr<Hand> (*make)();
};
inline void PrintTo(const MakeHand& hand, std::ostream* out) { *out << hand.name; }

/// The front end of a hand in a real service, on an in-process bus, with a scripted intention.
class FrontEndConformance : public ::testing::TestWithParam<MakeHand> {
 protected:
  FrontEndConformance();
  ~FrontEndConformance() override;
  void SetUp() override;

  /// Runs the loop until `condition`; false after the hand's patience.
  bool Await(const std::function<bool()>& condition);
  /// Runs the loop for a while, for what must not come.
  void Let(double seconds);

  /// Hears its request and begins the session that it asked for.
  void BeginSession();
  /// A question of this kind; yes and no, or three options where the kind has them.
  msg::Query Question(msg::QueryKind kind) const;
  /// Publishes it, and again twice a second until another takes its place.
  msg::Query Ask(msg::QueryKind kind);
  /// Runs the loop until an answer to the query came; null where none did.
  const msg::Answer* AnswerTo(const msg::Query& query);
  void Announce(msg::SessionKind kind, int questions = 0);
  int Count(msg::SessionKind request) const;
  /// The answers in different words: repetitions are left out.
  std::vector<msg::Answer> DistinctAnswers() const;

  RunLoop loop_;
  SystemClock clock_;
  SteadyClock steady_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Hand> hand_;
  struct Program;  // factory and service
  std::unique_ptr<Program> program_;

  bool silent_ = false;     // the scripted intention is away
  std::string session_id_;  // that the front end asked for last
  std::string device_;
  std::optional<msg::Interface> interface_;
  std::vector<msg::Session> requests_;
  std::vector<msg::Answer> answers_;
  std::optional<msg::Session> announced_;  // repeated once a second
  std::optional<msg::Query> query_;        // repeated
  int64_t heard_query_ = 0;                // that the front end was shown
  int64_t last_query_ = 0;
};

}  // namespace beckon::ui_bridge::conformance

/// At namespace scope: runs the suite with hands of this class.
#define BECKON_FRONT_END_CONFORMANCE(HandClass)                                                  \
  INSTANTIATE_TEST_SUITE_P(                                                                      \
      HandClass, FrontEndConformance,                                                            \
      ::testing::Values(MakeHand{                                                                \
          #HandClass, []() -> std::unique_ptr<Hand> { return std::make_unique<HandClass>(); }}), \
      [](const auto&) { return std::string("FrontEnd"); })
