#include "services/intention/store_rows.h"

#include <array>
#include <nlohmann/json.hpp>

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array kKinds = {QuestionKind::kAction, QuestionKind::kObject,
                               QuestionKind::kFull,   QuestionKind::kCategory,
                               QuestionKind::kSet,    QuestionKind::kChoice};

QuestionKind KindNamed(const std::string& name) {
  for (const QuestionKind kind : kKinds) {
    if (Name(kind) == name) return kind;
  }
  return QuestionKind::kFull;
}

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
  body.at("meant").get_to(answer.meant);
  body.at("device").get_to(answer.device);
  const bool right = answer.likelihoods.size() >= 2 && answer.meant >= 0 &&
                     answer.meant < static_cast<int>(answer.likelihoods.size());
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
    root.at("utime").get_to(session.utime);
    root.at("category").get_to(session.category);
    root.at("action").get_to(session.action);
    root.at("instance").get_to(session.instance);
    root.at("questions").get_to(session.questions);
    root.at("posterior").get_to(session.posterior);
    if (root.contains("present")) root.at("present").get_to(session.present);
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
    root.at("utime").get_to(label.utime);
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

Result<RowHead> HeadOf(const std::string& origin, int64_t seq, const std::string& kind,
                       const std::string& body) {
  if (kind == "session") {
    const auto session = SessionFromBody(body);
    if (!session) return session.error();
    return RowHead{"session/" + session->session_id, session->user, session->utime};
  }
  if (kind == "label") {
    const auto label = LabelFromBody(body);
    if (!label) return label.error();
    return RowHead{"label/" + label->id, label->user, label->utime};
  }
  return Parse<RowHead>(body, [&](const json& root) {
    return RowHead{kind + "/" + origin + "/" + std::to_string(seq),
                   root.value("user", std::string()), root.value("utime", Utime{0})};
  });
}

}  // namespace beckon::intention
