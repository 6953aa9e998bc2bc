#include "tools/beckon/bus_watch.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace beckon::tool {

BusWatch::BusWatch(Bus& bus, const Clock& clock, const Clock& steady, std::string user,
                   std::function<void(const SessionRecord&)> on_end)
    : bus_(bus), clock_(clock), steady_(steady), observer_(std::move(user), std::move(on_end)) {
  bus_.Subscribe<msg::Session>([this](const msg::Session& message) {
    robot_.OnSession(message);
    observer_.OnSession(message, steady_.Now());
  });
  bus_.Subscribe<msg::Query>(
      [this](const msg::Query& query) { observer_.OnQuery(query, steady_.Now()); });
  bus_.Subscribe<msg::Answer>(
      [this](const msg::Answer& answer) { observer_.OnAnswer(answer, steady_.Now()); });
  bus_.Subscribe<msg::Task>([this](const msg::Task& task) {
    for (const auto& status : robot_.OnTask(task, clock_.Now())) {
      if (auto sent = bus_.Publish(status); !sent) spdlog::error("robot: {}", sent.error().message);
    }
    observer_.OnTask(task, steady_.Now());
  });
  bus_.Subscribe<msg::Status>(
      [this](const msg::Status& status) { statuses_[status.service] = status; });
}

const msg::Status* BusWatch::StatusOf(const std::string& service) const {
  const auto found = statuses_.find(service);
  return found == statuses_.end() ? nullptr : &found->second;
}

std::string BusWatch::Says(const std::string& service) const {
  const auto* status = StatusOf(service);
  if (status == nullptr) return "nothing is heard of " + service;
  return service + " says '" + status->state + "'";
}

}  // namespace beckon::tool
