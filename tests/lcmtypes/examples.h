// A fully populated, valid value of every message type.
#pragma once

#include <tuple>

#include "lcmtypes/messages.h"

namespace beckon::msg {

Frame ExampleFrame();
Scene ExampleScene();
Poses ExamplePoses();
Interface ExampleInterface();
Query ExampleQuery();
Answer ExampleAnswer();
Session ExampleSession();
Task ExampleTask();
TaskStatus ExampleTaskStatus();
Label ExampleLabel();
Profile ExampleProfile();
Highlight ExampleHighlight();
Stimulus ExampleStimulus();
Decoding ExampleDecoding();
History ExampleHistory();
Lease ExampleLease();
Status ExampleStatus();

/// One of each, to write a property once for all types.
inline auto AllExamples() {
  return std::make_tuple(ExampleFrame(), ExampleScene(), ExamplePoses(), ExampleInterface(),
                         ExampleQuery(), ExampleAnswer(), ExampleSession(), ExampleTask(),
                         ExampleTaskStatus(), ExampleLabel(), ExampleProfile(), ExampleHighlight(),
                         ExampleStimulus(), ExampleDecoding(), ExampleHistory(), ExampleLease(),
                         ExampleStatus());
}

}  // namespace beckon::msg
