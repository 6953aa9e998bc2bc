// A front end with somebody in front of it who wants one thing over and over, on a bus of this
// program.
#pragma once

#include <map>
#include <set>
#include <string>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/dialogue.h"
#include "services/ui_bridge/simulated_user.h"

namespace beckon::faults {

class Person final : public ui_bridge::DialogueOutput {
 public:
  struct Wish {
    std::string user, device, action, category;
  };
  /// Subscribes; everything must outlive it. `clock` stamps what is said.
  Person(const Wish& wish, Bus& bus, RunLoop& loop, const Clock& clock, const Clock& steady);
  ~Person() override;

  /// Has one session after the other, or no further one.
  void GoOn(bool goes_on);
  const Wish& wish() const { return wish_; }
  /// Sessions that ended in a task, as intention said.
  const std::set<std::string>& confirmed() const { return confirmed_; }

  void Send(const msg::Answer& answer) override { (void)bus_.Publish(answer); }
  void Send(const msg::Session& request) override { (void)bus_.Publish(request); }
  void Present(const msg::Query& query) override;
  void Withdraw() override {}
  void ShowSession(const msg::Session& event) override;
  void ShowUser(const std::string&) override {}
  void ShowNotice(const std::string&) override {}

 private:
  void Tick();

  const Wish wish_;
  Bus& bus_;
  RunLoop& loop_;
  ui_bridge::SimulatedUser wants_;
  ui_bridge::Dialogue dialogue_;
  RunLoop::TimerId timer_;
  bool goes_on_ = false;
  std::set<std::string> confirmed_;
};

/// Shows the same table over and over: a carton, two mugs, a box and a tin, fitted.
class Table {
 public:
  Table(Bus& bus, RunLoop& loop, const Clock& clock);
  ~Table() { loop_.Cancel(timer_); }
  Table(const Table&) = delete;

 private:
  void Show();

  Bus& bus_;
  RunLoop& loop_;
  const Clock& clock_;
  int64_t scenes_ = 0;
  RunLoop::TimerId timer_;
};

/// What may be done with what stands there, each once: action and category.
std::vector<std::pair<std::string, std::string>> WishesAtTable();

}  // namespace beckon::faults
