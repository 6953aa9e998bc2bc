#include "tools/beckon/task_words.h"

namespace beckon::tool {

std::string TaskWords(const msg::Task& task) {
  return task.action + " " + task.object.category + " " + std::to_string(task.object.instance);
}

}  // namespace beckon::tool
