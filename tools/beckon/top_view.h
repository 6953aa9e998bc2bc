// How `beckon top` draws: rows and conversations in, lines of text out. Pure.
#pragma once

#include <string>
#include <vector>

#include "tools/beckon/top_conversations.h"
#include "tools/beckon/top_model.h"

namespace beckon::tool {

struct TopScreen {
  size_t columns = 80;
  size_t rows = 0;  // 0 = as many as it takes
  bool colour = false;
  std::string clock;  // e.g. "13:45:02"
};

/// At most `rows` lines of at most `columns` characters; where there is too little room, first what
/// the processes say of themselves is left out, then the last of them.
std::vector<std::string> DrawTop(const std::vector<TopRow>& rows, const TopTalks& talks,
                                 const TopScreen& screen);

/// "0.4ms", "12ms", "1.2s", "3.0min", "2.1h", "4.0d".
std::string ShortTime(Utime us);

/// "950", "9.5k", "12M".
std::string ShortCount(int64_t n);

}  // namespace beckon::tool
