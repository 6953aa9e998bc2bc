// Settings and token on a real disk: whole or not at all, private, and a damaged file is told.
#include "services/ui_bridge/web/settings_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "services/ui_bridge/web/access_token.h"
#include "services/ui_bridge/web/page_files.h"

namespace beckon::ui_bridge::web {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FolderTest : public ::testing::Test {
 protected:
  FolderTest() {
    char name[] = "/tmp/beckon-web-test-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~FolderTest() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(folder_ + "/" + name).parent_path());
    std::ofstream(folder_ + "/" + name) << text;
  }

  std::string folder_;
};

using SettingsStoreTest = FolderTest;
using AccessTokenTest = FolderTest;
using PageFilesTest = FolderTest;

TEST_F(SettingsStoreTest, KeepsEachUsersSettingsOverARestart) {
  {
    SettingsStore store(folder_ + "/new/web");
    EXPECT_EQ(*store.Load("ann"), Settings{});
    store.Save("ann", {.theme = "dark"});
    store.Save("bob", {.theme = "contrast"});
    EXPECT_EQ(store.Load("ann")->theme, "dark") << "before it is on disk";
  }
  const SettingsStore store(folder_ + "/new/web");
  EXPECT_EQ(store.Load("ann")->theme, "dark");
  EXPECT_EQ(store.Load("bob")->theme, "contrast");
  EXPECT_EQ(store.Load("cat")->theme, "auto");
}

TEST_F(SettingsStoreTest, KeepsTheLastOfManyQuickChanges) {
  SettingsStore store(folder_);
  for (int percent = 100; percent <= 250; ++percent) store.Save("ann", {.text_percent = percent});
  store.Flush();
  EXPECT_EQ(SettingsStore(folder_).Load("ann")->text_percent, 250);
  EXPECT_FALSE(fs::exists(folder_ + "/ann.json.new"));
}

TEST_F(SettingsStoreTest, TellsWhatIsWrongWithAFileCutAnywhere) {
  const std::string whole = ToJson(Settings{.theme = "dark"}).dump(1);
  const SettingsStore store(folder_);
  for (size_t cut = 0; cut < whole.size(); ++cut) {
    Write("ann.json", whole.substr(0, cut));
    const auto settings = store.Load("ann");
    ASSERT_FALSE(settings) << cut;
    EXPECT_THAT(settings.error().message, HasSubstr("ann.json"));
  }
  for (const char* wrong : {"[]", "null", "{\"theme\": 1}", "{\"other\": 1}", "\xff\xfe"}) {
    Write("ann.json", wrong);
    EXPECT_FALSE(store.Load("ann")) << wrong;
  }
  Write("ann.json", std::string(100'000, ' ') + whole);
  EXPECT_FALSE(store.Load("ann")) << "too large";
}

TEST_F(SettingsStoreTest, GoesOnWhereNothingCanBeWritten) {
  Write("file", "not a folder");
  SettingsStore store(folder_ + "/file/web");
  store.Save("ann", {.theme = "dark"});
  store.Flush();
  EXPECT_EQ(store.Load("ann")->theme, "auto");
}

TEST_F(AccessTokenTest, IsMadeOncePrivateAndRandom) {
  const std::string path = folder_ + "/web/token";
  const auto token = LoadOrMakeToken(path);
  ASSERT_TRUE(token) << token.error().message;
  EXPECT_THAT(*token, ::testing::MatchesRegex("[0-9a-f]{32}"));
  struct stat file {};
  ASSERT_EQ(stat(path.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0600u);
  EXPECT_EQ(*LoadOrMakeToken(path), *token) << "pages find their way back";
  EXPECT_NE(*LoadOrMakeToken(folder_ + "/other"), *token);
}

TEST_F(AccessTokenTest, IsMadeAnewWhereOthersMayHaveReadItOrItIsNone) {
  const std::string path = folder_ + "/token";
  const std::string first = *LoadOrMakeToken(path);
  fs::permissions(path, fs::perms::group_read, fs::perm_options::add);
  const std::string second = *LoadOrMakeToken(path);
  EXPECT_NE(second, first);
  Write("token", "short");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  const std::string third = *LoadOrMakeToken(path);
  EXPECT_EQ(third.size(), 32u);
  fs::rename(path, folder_ + "/real");
  fs::create_symlink(folder_ + "/real", path);
  EXPECT_NE(*LoadOrMakeToken(path), third) << "a link may lead to another's file";
}

TEST_F(PageFilesTest, AreThoseOfThePageAndNothingElse) {
  Write("index.html", "<html>");
  Write("page.js", "1");
  Write("i18n/de.json", "{}");
  Write("notes.txt", "secret");
  Write(".hidden", "secret");
  const auto files = ReadPageFiles(folder_);
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_EQ(files->size(), 3u);
  EXPECT_EQ(files->at("/").content_type, "text/html; charset=utf-8");
  EXPECT_EQ(*files->at("/i18n/de.json").bytes, "{}");
  EXPECT_NE(files->at("/").etag, files->at("/page.js").etag);
}

TEST_F(PageFilesTest, SayWhatIsMissing) {
  EXPECT_THAT(ReadPageFiles(folder_).error().message, HasSubstr("index.html"));
  EXPECT_THAT(ReadPageFiles(folder_ + "/none").error().message, HasSubstr("none"));
  Write("index.html", "");
  EXPECT_THAT(ReadPageFiles(folder_).error().message, HasSubstr("empty"));
  Write("index.html", std::string(2 << 20, ' '));
  EXPECT_THAT(ReadPageFiles(folder_).error().message, HasSubstr("1 MB"));
}

}  // namespace
}  // namespace beckon::ui_bridge::web
