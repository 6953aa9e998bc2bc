// LABEL: what the user said an object is.
#include <beckon/label_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

/// Categories name folders of examples.
static bool IsFolderName(const std::string& name) {
  return !name.starts_with('.') && name.find('/') == std::string::npos;
}

static void Walk(Walker& w, const label_t*) {
  w.Skip(8);
  w.String("label_id", kMaxText);
  w.String("session_id", kMaxName);
  w.String("user", kMaxName);
  w.Skip(1);
  w.String("category", kMaxName);
  w.String("source", kMaxText);
  w.Skip(8 + 8 + 4);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Label& label) {
  return Rules("label")
      .Time(label.utime)
      .Name(label.label_id, "label_id", kMaxText)
      .Text(label.session_id, "session_id", kMaxName)
      .Text(label.user, "user", kMaxName)
      .Require(IsUserName(label.user), "user: expected letters, digits, '_', '.' or '-'")
      .Range(static_cast<int>(label.state), "state", 1, 2)
      .Name(label.category, "category")
      .Require(IsFolderName(label.category), "category: expected no '/', and no '.' first")
      .Text(label.source, "source")
      .Require(label.scene_seq >= 1, "scene_seq is below 1")
      .Time(label.scene_utime)
      .Require(label.object_id >= 1, "object_id is below 1")
      .Require(Check(label.seal));
}

static label_t ToWire(const msg::Label& label) {
  label_t wire{};
  wire.utime = label.utime;
  wire.label_id = label.label_id;
  wire.session_id = label.session_id;
  wire.user = label.user;
  wire.state = static_cast<int8_t>(label.state);
  wire.category = label.category;
  wire.source = label.source;
  wire.scene_seq = label.scene_seq;
  wire.scene_utime = label.scene_utime;
  wire.object_id = label.object_id;
  wire.seal = ToWire(label.seal);
  return wire;
}

static Result<msg::Label> FromWire(const label_t& wire) {
  msg::Label label;
  label.utime = wire.utime;
  label.label_id = wire.label_id;
  label.session_id = wire.session_id;
  label.user = wire.user;
  label.state = static_cast<msg::LabelState>(wire.state);
  label.category = wire.category;
  label.source = wire.source;
  label.scene_seq = wire.scene_seq;
  label.scene_utime = wire.scene_utime;
  label.object_id = wire.object_id;
  label.seal = FromWire(wire.seal);
  return label;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Label, label_t)

}  // namespace beckon
