// The settings that ship: every key that is written down there is one that its front end reads.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "services/base/app.h"
#include "services/base/config.h"
#include "services/ui_bridge/front_end.h"

namespace beckon::ui_bridge {
namespace {

/// Each "# key = value" without its '#'.
std::string Uncommented(const std::string& path) {
  std::ifstream file(path);
  std::string text, line;
  while (std::getline(file, line)) {
    const size_t equals = line.find(" = ");
    const bool key =
        line.starts_with("# ") && equals != std::string::npos && line.find(' ', 2) == equals;
    text += (key ? line.substr(2) : line) + "\n";
  }
  return text;
}

Status ReadBy(std::vector<std::unique_ptr<FrontEndFactory>>& factories, const std::string& text) {
  auto table = ConfigTable::Parse(text, "ui_bridge.toml");
  if (!table) return table.error();
  for (auto& factory : factories) factory->Configure(table->Section(factory->name()));
  return table->Finish();
}

TEST(ShippedSettings, AreReadWithAllTheirKeys) {
  const std::string text = Uncommented(SharedFile("ui_bridge.toml"));
  auto factories = MakeFrontEndFactories();
  for (const char* section :
       {"[console]", "[switch]", "[speech]", "[speech.words]", "[bci]", "[web]"})
    EXPECT_NE(text.find(section), std::string::npos) << section;
  const Status read = ReadBy(factories, text);
  EXPECT_TRUE(read) << read.error().message;
}

TEST(ShippedSettings, DoNotHideAKeyThatNobodyReads) {
  auto factories = MakeFrontEndFactories();
  for (const char* wrong :
       {"[speech]\nvoise = \"en\"\n", "[switch]\nscan_tme = 1.0\n", "[bci]\nrow = 2\n",
        "[web]\nports = 1\n", "[consoles]\nkind = \"choice\"\n"})
    EXPECT_FALSE(ReadBy(factories, wrong)) << wrong;
}

}  // namespace
}  // namespace beckon::ui_bridge
