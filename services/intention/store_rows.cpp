#include "services/intention/store_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array kKinds = {QuestionKind::kAction, QuestionKind::kObject,
                               QuestionKind::kFull,   QuestionKind::kCategory,
                               QuestionKind::kSet,    QuestionKind::kChoice};

constexpr char kWithdrawn[] = "withdrawn";
constexpr char kDropped[] = "dropped";

QuestionKind KindNamed(const std::string& name) {
  for (const QuestionKind kind : kKinds) {
    if (Name(kind) == name) return kind;
  }
  return QuestionKind::kFull;
}

/// Bounds of what a row may say: an import comes from anywhere.
constexpr int kMostAnswers = 100'000;
constexpr Utime kMostUtime = 253'402'300'800 * kSecond;  // the year 9999

int64_t NeedInteger(const json& body, const char* key, int64_t least, int64_t most) {
  const json& value = body.at(key);
  if (!value.is_number_integer() || value < least || value > most) {
    throw json::other_error::create(501,
                                    std::string("'") + key + "' must be a whole number from " +
                                        std::to_string(least) + " to " + std::to_string(most),
                                    &body);
  }
  return value.get<int64_t>();
}

bool IsLikelihood(double value) { return value >= 0 && std::isfinite(value); }

/// Older rows know only yes and no, and only the device that asked for the session.
AnswerRecord AnswerFrom(const json& body, const std::string& session_device) {
  AnswerRecord answer;
  answer.kind = KindNamed(body.at("kind").get<std::string>());
  if (!body.contains("likelihoods")) {
    answer.likelihoods = {body.at("yes").get<double>(), body.at("no").get<double>()};
    answer.meant = body.at("meant_yes").get<bool>() ? 0 : 1;
    answer.device = session_device;
    return answer;
  }
  body.at("likelihoods").get_to(answer.likelihoods);
  answer.meant = static_cast<int>(NeedInteger(body, "meant", 0, kMaxThings));
  body.at("device").get_to(answer.device);
  const auto fate = body.value("fate", std::string());
  if (fate == kWithdrawn) answer.fate = AnswerFate::kWithdrawn;
  if (fate == kDropped) answer.fate = AnswerFate::kDropped;
  const auto& likelihoods = answer.likelihoods;
  const bool right = likelihoods.size() >= 2 && likelihoods.size() <= kMaxThings + 1 &&
                     answer.meant < static_cast<int>(likelihoods.size()) &&
                     std::all_of(likelihoods.begin(), likelihoods.end(), IsLikelihood);
  if (!right)
    throw json::other_error::create(501, "an answer of at least two likelihoods and the meant one",
                                    &body);
  return answer;
}

ordered_json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d ToVector(const json& v) {
  if (!v.is_array() || v.size() != 3)
    throw json::other_error::create(501, "expected three numbers", &v);
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

uint64_t HashFrom(const std::string& text, const json& root) {
  uint64_t hash = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (text.size() != 16 || error != std::errc() || end != text.data() + text.size())
    throw json::other_error::create(501, "'hash' must be 16 hexadecimal digits", &root);
  return hash;
}

/// Parses and extracts; json's exceptions become an Error.
template <typename T, typename Extract>
Result<T> Parse(const std::string& body, Extract extract) {
  try {
    const json root = json::parse(body);
    if (!root.is_object()) return Error{"expected a JSON object"};
    return extract(root);
  } catch (const json::exception& e) {
    return Error{e.what()};
  }
}

Result<RowHead> NamesOf(const HistoryRow& row) {
  if (row.kind == "session") {
    const auto session = SessionFromBody(row.body);
    if (!session) return session.error();
    return RowHead{"session/" + session->session_id, session->user, session->utime};
  }
  if (row.kind == "label") {
    const auto label = LabelFromBody(row.body);
    if (!label) return label.error();
    return RowHead{"label/" + label->id, label->user, label->utime};
  }
  return Parse<RowHead>(row.body, [&](const json& root) {
    const std::string name = row.kind + "/" + row.origin + "/" + std::to_string(row.seq);
    RowHead head{root.value("uid", name), root.value("user", std::string()),
                 root.contains("utime") ? NeedInteger(root, "utime", 0, kMostUtime) : Utime{0}};
    if (row.kind != kErased && !head.uid.starts_with(row.kind + "/"))
      throw json::other_error::create(501, "'uid' must begin with the kind", &root);
    if (row.kind == kErased) {
      if (row.hybrid_utime == 0)
        throw json::other_error::create(501, "an erased row needs its hybrid time", &root);
      head.hash = HashFrom(root.at("hash").get<std::string>(), root);
    }
    return head;
  });
}

}  // namespace

std::string ToBody(const SessionRecord& session) {
  ordered_json body;
  body["session_id"] = session.session_id;
  body["user"] = session.user;
  body["device"] = session.device;
  body["utime"] = session.utime;
  body["category"] = session.category;
  body["action"] = session.action;
  body["instance"] = session.instance;
  body["questions"] = session.questions;
  body["posterior"] = session.posterior;
  body["present"] = session.present;
  body["answers"] = ordered_json::array();
  for (const AnswerRecord& a : session.answers) {
    body["answers"].push_back({{"kind", Name(a.kind)},
                               {"likelihoods", a.likelihoods},
                               {"meant", a.meant},
                               {"device", a.device}});
    if (a.fate != AnswerFate::kStands)
      body["answers"].back()["fate"] = a.fate == AnswerFate::kWithdrawn ? kWithdrawn : kDropped;
  }
  return body.dump();
}

std::string ToBody(const LabelRecord& label) {
  ordered_json body;
  body["label_id"] = label.id;
  body["session_id"] = label.session_id;
  body["user"] = label.user;
  body["utime"] = label.utime;
  body["category"] = label.category;
  body["source"] = label.source;
  body["position_W"] = ToJson(label.centroid_W);
  body["extent_W"] = ToJson(label.extent_W);
  body["probabilities"] = ordered_json::array();
  for (const auto& p : label.probabilities)
    body["probabilities"].push_back({p.category, p.probability});
  return body.dump();
}

Result<SessionRecord> SessionFromBody(const std::string& body) {
  return Parse<SessionRecord>(body, [](const json& root) {
    SessionRecord session;
    root.at("session_id").get_to(session.session_id);
    root.at("user").get_to(session.user);
    root.at("device").get_to(session.device);
    session.utime = NeedInteger(root, "utime", 0, kMostUtime);
    root.at("category").get_to(session.category);
    root.at("action").get_to(session.action);
    session.instance = static_cast<int>(NeedInteger(root, "instance", 1, kMaxThings));
    session.questions = static_cast<int>(NeedInteger(root, "questions", 0, kMostAnswers));
    root.at("posterior").get_to(session.posterior);
    if (const auto present = root.find("present"); present != root.end()) {
      for (const auto& [name, count] : present->items()) {
        session.present[name] =
            static_cast<int>(NeedInteger(*present, name.c_str(), 0, kMaxThings));
      }
    }
    for (const json& a : root.at("answers"))
      session.answers.push_back(AnswerFrom(a, session.device));
    return session;
  });
}

Result<LabelRecord> LabelFromBody(const std::string& body) {
  return Parse<LabelRecord>(body, [](const json& root) {
    LabelRecord label;
    root.at("label_id").get_to(label.id);
    root.at("session_id").get_to(label.session_id);
    root.at("user").get_to(label.user);
    label.utime = NeedInteger(root, "utime", 0, kMostUtime);
    root.at("category").get_to(label.category);
    root.at("source").get_to(label.source);
    label.centroid_W = ToVector(root.at("position_W"));
    label.extent_W = ToVector(root.at("extent_W"));
    for (const json& p : root.at("probabilities")) {
      label.probabilities.push_back({p.at(0).get<std::string>(), p.at(1).get<float>()});
    }
    return label;
  });
}

Result<RowHead> HeadOf(const HistoryRow& row) {
  Result<RowHead> head = NamesOf(row);
  if (head && row.kind != kErased) head->hash = RowHash(Timed(row, *head));
  return head;
}

std::string WithUid(const std::string& body, const std::string& uid) {
  ordered_json root = ordered_json::parse(body);
  if (!root.contains("uid")) root["uid"] = uid;
  return root.dump();
}

HistoryRow Timed(HistoryRow row, const RowHead& head) {
  if (row.hybrid_utime == 0) row.hybrid_utime = std::max<Utime>(head.utime, 1);
  return row;
}

}  // namespace beckon::intention
