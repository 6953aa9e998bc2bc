#include "services/intention/service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <optional>
#include <type_traits>

#include "services/base/app.h"
#include "services/base/status_reporter.h"
#include "services/intention/affordances_file.h"
#include "services/intention/core/policies.h"
#include "services/intention/history_service.h"
#include "services/intention/lead_service.h"
#include "services/intention/phrases_file.h"
#include "services/intention/store.h"
#include "services/intention/store_recovery.h"

namespace beckon::intention {
namespace {

/// Of what is wrong, in the status.
constexpr size_t kMostNotice = 700;
/// Where interfaces make errors: that the user wants something we do not know of.
constexpr double kNonePrior = 0.002;

std::unique_ptr<Policy> PolicyOf(const ServiceConfig& config, const Affordances& affordances) {
  if (config.policy == "oain") return MakeOainPolicy(affordances);
  AdaptiveConfig adaptive;
  adaptive.families =
      config.queries == "aof" ? QueryFamilies::kActionObjectFull : QueryFamilies::kAll;
  adaptive.none_prior = kNonePrior;
  return MakeAdaptivePolicy(adaptive);
}

ConversationConfig ConversationConfigOf(const ServiceConfig& config, Phrases phrases) {
  ConversationConfig conversation;
  conversation.phrases = std::move(phrases);
  conversation.task_lifetime = static_cast<Utime>(config.task_lifetime_s * kSecond);
  conversation.scene_max_age = static_cast<Utime>(config.scene_max_age_s * kSecond);
  return conversation;
}

}  // namespace

Result<ServiceConfig> ReadServiceConfig(ConfigTable table) {
  ServiceConfig config;
  table.Get("db", config.db);
  table.Get("policy", config.policy, {"adaptive", "oain"});
  table.Get("queries", config.queries, {"all", "aof"});
  table.Get("affordances", config.affordances);
  table.Get("phrases", config.phrases);
  table.Get("machine", config.machine);
  table.Get("share_history", config.share_history);
  table.Get("task_lifetime_s", config.task_lifetime_s, 1, 3600);
  table.Get("scene_max_age_s", config.scene_max_age_s, 0.1, 3600);
  if (Status read = table.Finish(); !read) return read.error();
  return config;
}

void FillDefaults(ServiceConfig& config) {
  if (config.db.empty()) config.db = DataFile("beckon.db");
  if (config.affordances.empty()) config.affordances = SharedFile("affordances.toml");
  if (config.phrases.empty()) config.phrases = SharedFile("questions.en.toml");
  if (config.machine.empty()) config.machine = HostName();
}

struct Service::State {
  State(const ServiceConfig& config, Affordances known, Phrases phrases, OpenedStore opened,
        Bus& the_bus, RunLoop& the_loop, const Clock& the_clock)
      : affordances(std::move(known)),
        policy(PolicyOf(config, affordances)),
        notice(std::move(opened.notice)),
        store(std::move(opened.store)),
        conversation(NewHolder(config.machine), steady, affordances, *policy, *store,
                     ConversationConfigOf(config, std::move(phrases))),
        share_history(config.share_history),
        bus(the_bus),
        loop(the_loop),
        clock(the_clock) {}

  template <typename Message>
  void Feed(Actions (LedConversation::*handler)(const Message&, Utime)) {
    bus.Subscribe<Message>([this, handler](Message message) {
      Publish((conversation.*handler)(message, clock.Now()));
    });
  }

  void Subscribe() {
    Feed<msg::Scene>(&LedConversation::OnScene);
    Feed<msg::Poses>(&LedConversation::OnPoses);
    Feed<msg::Interface>(&LedConversation::OnInterface);
    Feed<msg::Session>(&LedConversation::OnSession);
    Feed<msg::TaskStatus>(&LedConversation::OnTaskStatus);
    bus.Subscribe<msg::Answer>([this](msg::Answer answer) {
      const Stopwatch stopwatch;
      Publish(conversation.OnAnswer(answer, clock.Now()));
      const auto us = static_cast<int64_t>(stopwatch.Milliseconds() * 1000);
      question_us = us;
      question_us_max = std::max(question_us_max, us);
    });
    lead.emplace(conversation, bus, loop, clock, [this](const Actions& a) { Publish(a); });
    status = std::make_unique<StatusReporter>("intention", bus, loop,
                                              [this](msg::Status& s) { Fill(s); });
    Publish(conversation.Recover(clock.Now()));
    if (share_history) {
      history = std::make_unique<HistoryService>(
          *store, bus, loop, clock,
          [this](msg::History message) { PublishOne(std::move(message)); });
    }
  }

  template <typename Message>
  void PublishOne(Message message) {
    message.seal.sender = conversation.sender();
    // What is to be done later is not done.
    if constexpr (std::is_same_v<Message, msg::Task>)
      message.seal.expires_utime = message.expires_utime;
    if (Status sent = bus.Publish(message); !sent) spdlog::error("{}", sent.error().message);
  }
  void PublishOne(const Refused& refused) {
    bus.Refuse(refused.channel, refused.reason, refused.detail);
  }

  void Publish(const Actions& actions) {
    for (const Outgoing& action : actions) {
      std::visit([this](const auto& one) { PublishOne(one); }, action);
    }
  }

  void Fill(msg::Status& s) {
    const ConversationCounters& c = conversation.conversation().counters();
    s.state = conversation.conversation().StateText();
    lead->Fill(s);
    const auto rows = store->RowCount();
    for (const auto& [name, value] :
         std::map<std::string, int64_t>{{"sessions", c.sessions},
                                        {"confirmed", c.confirmed},
                                        {"abandoned", c.abandoned},
                                        {"answers", c.answers},
                                        {"stale_answers", c.stale_answers},
                                        {"refused_requests", c.refused},
                                        {"unknown_categories", c.unknown_categories},
                                        {"tasks", c.tasks},
                                        {"tasks_expired", c.expired},
                                        {"tasks_revoked", c.revoked},
                                        {"confirmations_held", c.held},
                                        {"labels", c.labels},
                                        {"late_scenes", c.late_scenes},
                                        {"db_rows", rows ? *rows : -1},
                                        {"question_us", question_us},
                                        {"question_us_max", question_us_max}}) {
      s.counters.push_back({name, value});
    }
    std::string notices = notice;
    if (history) {
      history->Fill(s);
      if (const std::string more = history->Notice(); !more.empty())
        notices += (notices.empty() ? "" : "; ") + more;
    }
    if (!notices.empty()) s.state += " (" + notices.substr(0, kMostNotice) + ")";
  }

  const Affordances affordances;
  const std::unique_ptr<Policy> policy;
  const std::string notice;  // of how the database was found
  const std::unique_ptr<Store> store;
  const BootClock steady;
  LedConversation conversation;
  const bool share_history;
  Bus& bus;
  RunLoop& loop;
  const Clock& clock;
  std::optional<LeadService> lead;
  std::unique_ptr<HistoryService> history;
  std::unique_ptr<StatusReporter> status;
  int64_t question_us = 0;  // from an answer to what follows it, last and longest
  int64_t question_us_max = 0;
};

Service::Service(std::unique_ptr<State> state) : state_(std::move(state)) {}
Service::~Service() = default;

Result<std::unique_ptr<Service>> Service::Start(const ServiceConfig& config, Bus& bus,
                                                RunLoop& loop, const Clock& clock) {
  auto affordances = ReadAffordances(config.affordances);
  if (!affordances) return affordances.error();
  auto phrases = config.phrases.empty() ? English() : ReadPhrases(config.phrases);
  if (!phrases) return phrases.error();
  auto store = OpenOrReplace(config.db, config.machine, clock.Now());
  if (!store) return store.error();
  if (!store->notice.empty()) spdlog::error("{}", store->notice);
  auto state = std::make_unique<State>(config, *std::move(affordances), *std::move(phrases),
                                       *std::move(store), bus, loop, clock);
  state->Subscribe();
  return std::unique_ptr<Service>(new Service(std::move(state)));
}

}  // namespace beckon::intention
