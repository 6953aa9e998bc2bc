#include "tools/beckon/supervisor.h"

#include <algorithm>
#include <csignal>
#include <utility>

namespace beckon::tool {

struct Supervisor::Entry {
  ProcessSpec spec;
  Restart restart;
  BackOff back_off;
  std::optional<ChildProcess> process;
  Utime started = 0;
  std::optional<RunLoop::TimerId> timer;  // until it is started again
};

Supervisor::Supervisor(RunLoop& loop, const Clock& steady,
                       std::function<void(const Death&)> on_death)
    : loop_(loop), steady_(steady), on_death_(std::move(on_death)) {}

Supervisor::~Supervisor() { Stop(); }

Status Supervisor::Start(ProcessSpec spec, Restart restart) {
  const std::string name = spec.name;
  auto entry = std::make_unique<Entry>();
  entry->spec = std::move(spec);
  entry->restart = restart;
  if (auto launched = Launch(*entry); !launched) return launched;
  entries_[name] = std::move(entry);
  return {};
}

Status Supervisor::Launch(Entry& entry) {
  auto process = ChildProcess::Start(entry.spec);
  if (!process) return process.error();
  entry.process = *std::move(process);
  entry.started = steady_.Now();
  loop_.AddFd(entry.process->fd(), [this, name = entry.spec.name] { OnEnded(name); });
  return {};
}

void Supervisor::LaunchIn(Entry& entry, Utime delay_us) {
  entry.timer = loop_.After(delay_us, [this, &entry] {
    entry.timer.reset();
    // A program that is away meanwhile (an upgrade) is waited for.
    if (!Launch(entry)) LaunchIn(entry, BackOff::kLongest_us);
  });
}

void Supervisor::OnEnded(const std::string& name) {
  const auto found = entries_.find(name);
  if (found == entries_.end() || !found->second->process) return;
  Entry& entry = *found->second;
  const auto exit = entry.process->Poll();
  if (!exit) return;
  loop_.RemoveFd(entry.process->fd());
  entry.process.reset();

  Death death{.name = name,
              .exit = *exit,
              .last_line = LastLine(entry.spec.log_file),
              .in_a_row = 1,
              .alive_us = steady_.Now() - entry.started,
              .restart_us = std::nullopt};
  const bool failed = exit->code != 0 || exit->signal != 0;
  if (entry.restart == Restart::kAlways || (entry.restart == Restart::kOnFailure && failed)) {
    death.restart_us = entry.back_off.Next(death.alive_us);
    death.in_a_row = entry.back_off.deaths();
    LaunchIn(entry, *death.restart_us);
  }
  on_death_(death);
}

std::optional<pid_t> Supervisor::Pid(const std::string& name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end() || !found->second->process) return {};
  return found->second->process->pid();
}

void Supervisor::Signal(const std::string& name, int signal) {
  const auto found = entries_.find(name);
  if (found != entries_.end() && found->second->process) found->second->process->Signal(signal);
}

void Supervisor::Stop(int patience_ms) {
  for (auto& [name, entry] : entries_) {
    if (entry->timer) loop_.Cancel(*entry->timer);
    if (!entry->process) continue;
    loop_.RemoveFd(entry->process->fd());
    entry->process->Signal(SIGTERM);
  }
  const Utime deadline = steady_.Now() + Utime{1000} * patience_ms;
  for (auto& [name, entry] : entries_) {
    if (!entry->process) continue;
    const Utime left_us = deadline - steady_.Now();
    entry->process->Wait(static_cast<int>(std::max<Utime>(0, left_us / 1000)));
  }
  entries_.clear();  // kills what is left
}

void Supervisor::Stop(const std::string& name, int signal, int patience_ms) {
  const auto found = entries_.find(name);
  if (found == entries_.end()) return;
  Entry& entry = *found->second;
  if (entry.timer) loop_.Cancel(*entry.timer);
  if (entry.process) {
    loop_.RemoveFd(entry.process->fd());
    entry.process->Signal(signal);
    entry.process->Wait(patience_ms);
  }
  entries_.erase(found);
}

}  // namespace beckon::tool
