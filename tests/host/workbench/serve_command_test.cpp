// axistool serve: one line on standard output, nothing else, and an orderly end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "host/read_file.hpp"
#include "tests/child.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/workbench/served_folder.hpp"
#include "tests/wait_until.hpp"

namespace {

using testing::MatchesRegex;

ProgramRun refused(const std::string& arguments) { return run_axistool("serve " + arguments + " --no-browser"); }

TEST(ServeCommand, PrintsItsAddressAndEndsAtInterruptAndTerm) {
  const TemporaryFolder folder, beside;
  const std::string printed = beside.path("printed");
  for (const int signal : {SIGINT, SIGTERM}) {
    Child serve({AXISTOOL_PROGRAM, "serve", folder.path(""), "--no-browser"}, printed);
    EXPECT_TRUE(wait_until([&] { return host::read_file(printed).ends_with("\n"); }));
    EXPECT_EQ(serve.end(signal), 0);
    EXPECT_THAT(host::read_file(printed), MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/\\?token=[0-9a-f]+\n"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path(""))) << "showing the page writes no file";
}

TEST(ServeCommand, RefusesATakenPortAFolderThatIsNoneAndNonsense) {
  const ServedFolder served;
  const ProgramRun taken = refused(". --port " + std::to_string(served.server.port()));
  EXPECT_EQ(taken.exit_code, 4) << taken.output;
  EXPECT_THAT(taken.output, testing::HasSubstr("--port"));
  EXPECT_EQ(refused("no-such-folder").exit_code, 9);
  EXPECT_EQ(refused(". --port 65536").exit_code, 2);
}

}  // namespace
