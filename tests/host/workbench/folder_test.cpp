// The workbench lists, reads and writes nothing outside its folder: names with "..", links that leave it, uploads.
#include "host/workbench/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

namespace fs = std::filesystem;
using host::workbench::Folder;
using host::workbench::is_plain_name;

TEST(Folder, TakesPlainNamesOnly) {
  for (const char* plain : {"a.csv", "run 1/a.csv", "a..b.csv", "ä.csv", "<b>.csv"}) EXPECT_TRUE(is_plain_name(plain));
  for (const char* name :
       {"", "/etc/passwd", "../a.csv", "a/../../b.csv", "a/..", ".ssh/id", "a//b", "a/", "-rf", "a\nb", "a\\b", "./a"})
    EXPECT_FALSE(is_plain_name(name)) << name;
  EXPECT_FALSE(is_plain_name(std::string_view("a\0b", 3)));
  EXPECT_FALSE(is_plain_name(std::string(501, 'a')));
}

TEST(Folder, ListsWhatIsReadHereAndNothingThatLiesElsewhere) {
  const WorkingFolder working;
  const TemporaryFolder elsewhere;
  elsewhere.write("secret.csv", "t_s,u_V,x_mm\n");
  working.copy_case("single/case-00");
  working.folder.write("notes.toml", "a = 1\n");
  working.folder.write("sheet.toml", "format = \"axis-model/1\"\n[drive]\n");
  working.folder.write("plc.csv", "Time;Pos\n1;2\n");
  fs::create_directories("runs/deep");
  fs::copy("validate.csv", "runs/deep/again.csv");
  fs::create_symlink(elsewhere.path("secret.csv"), "link.csv");
  fs::create_directory_symlink(elsewhere.path(""), "linked");
  fs::create_symlink("validate.csv", "alias.csv");
  const Folder folder;
  std::vector<std::string> found;
  for (const auto& file : folder.files()) found.push_back(file.name + ":" + file.kind);
  EXPECT_THAT(found, testing::ElementsAre("alias.csv:record", "model.toml:model", "plc.csv:log",
                                          "runs/deep/again.csv:record", "sheet.toml:sheet", "train-jog.csv:record",
                                          "train-sweep.csv:record", "validate.csv:record"));
  EXPECT_EQ(folder.existing("alias.csv"), "alias.csv");
  const auto code_of = [&](const std::string& name) {
    try {
      folder.existing(name);
    } catch (const host::Failure& failure) {
      return failure.code;
    }
    return host::ExitCode::done;
  };
  EXPECT_EQ(code_of("link.csv"), host::ExitCode::permission);
  EXPECT_EQ(code_of("linked/secret.csv"), host::ExitCode::permission);
  EXPECT_EQ(code_of("none.csv"), host::ExitCode::bad_input);
  EXPECT_EQ(code_of("runs"), host::ExitCode::bad_input);
  EXPECT_EQ(code_of("../" + fs::current_path().filename().string() + "/validate.csv"), host::ExitCode::usage);
}

TEST(Folder, ACommissionsRecordsHaveTheRolesThatTheyHadThere) {
  const WorkingFolder working;
  fs::create_directory("x");
  working.folder.write("x/commission.json", "{}");
  for (const char* name : {"dwell.csv", "judge-jogs.csv", "pulse.csv", "run-1.csv"})
    working.folder.write(std::string("x/") + name, "t_s,u_V,x_mm\n");
  working.folder.write("dwell.csv", "t_s,u_V,x_mm\n");
  std::vector<std::string> found;
  for (const auto& file : Folder().files()) found.push_back(file.name + ":" + file.role);
  EXPECT_THAT(found, testing::ElementsAre("dwell.csv:", "x/dwell.csv:train", "x/judge-jogs.csv:judge",
                                          "x/pulse.csv:off", "x/run-1.csv:train"));
}

TEST(Folder, GivesAwayNothingByRequestEither) {
  const ServedFolder served;
  const TemporaryFolder elsewhere;
  elsewhere.write("secret.csv", "t_s,u_V,x_mm\n");
  fs::create_symlink(elsewhere.path("secret.csv"), "link.csv");
  served.copy_case("single/case-00");
  for (const char* name : {"../../../../etc/passwd", "/etc/passwd", "%2e%2e%2fx", "..%2f..%2fetc%2fpasswd", "link.csv",
                           "", "workbench/../../x"}) {
    const auto result = served.client().Get("/api/file?name=" + std::string(name), served.own);
    ASSERT_TRUE(result) << name;
    EXPECT_GE(result->status, 400) << name;
    EXPECT_EQ(result->body.find("t_s"), std::string::npos);
  }
  EXPECT_EQ(served.client().Get("/api/file?name=validate.csv", served.own)->body, host::read_file("validate.csv"));
  EXPECT_EQ(served.client().Get("/page/../api/folder", served.own)->status, 404);
  const auto [status, told] =
      served.post("/api/compare", {{"do", "compare"}, {"models", {"model.toml"}}, {"records", {"link.csv"}}});
  EXPECT_EQ(status, 403) << told;
}

TEST(Folder, AnUploadTakesAFreeNameAndLeavesNothingHalfWritten) {
  const ServedFolder served;
  const auto upload = [&](const std::string& name, const std::string& text) {
    const auto result = served.client().Post("/api/files?name=" + name, served.own, text, "text/csv");
    return result ? std::pair(result->status, nlohmann::json::parse(result->body, nullptr, false))
                  : std::pair(0, nlohmann::json());
  };
  EXPECT_EQ(upload("a.csv", "first").second["name"], "a.csv");
  EXPECT_EQ(upload("a.csv", "second").second["name"], "a-2.csv");
  EXPECT_EQ(host::read_file("a.csv"), "first");
  EXPECT_EQ(host::read_file("a-2.csv"), "second");
  for (const char* name : {"", "run.sh", "../a.csv", "sub/a.csv", ".hidden.csv", "page.html", "workbench/choice.json"})
    EXPECT_EQ(upload(name, "x").first, 400) << name;
  fs::create_symlink("/nowhere/else.csv", "dangling.csv");
  EXPECT_EQ(upload("dangling.csv", "x").second["name"], "dangling-2.csv") << "a link is not followed";
  EXPECT_TRUE(fs::is_empty("workbench"));
}

TEST(Folder, ItsOwnFolderMayNotLeadOut) {
  const WorkingFolder working;
  const TemporaryFolder elsewhere;
  fs::create_directory_symlink(elsewhere.path(""), "workbench");
  EXPECT_THROW(Folder().own_file("choice.json"), host::Failure);
  EXPECT_TRUE(fs::is_empty(elsewhere.path("")));
}

}  // namespace
