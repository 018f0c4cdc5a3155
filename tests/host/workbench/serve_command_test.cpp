// axistool serve: one line on standard output, nothing else, and an orderly end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

using testing::MatchesRegex;

ProgramRun served_until(const std::string& signal, const std::string& arguments) {
  return run_program("timeout --preserve-status -s " + signal + " 1 \"" + std::string(AXISTOOL_PROGRAM) + "\" serve " +
                     arguments + " --no-browser");
}

TEST(ServeCommand, PrintsItsAddressAndEndsAtInterruptAndTerm) {
  const TemporaryFolder folder;
  for (const char* signal : {"INT", "TERM"}) {
    const ProgramRun run = served_until(signal, folder.path(""));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/\\?token=[0-9a-f]+\n"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path(""))) << "looking leaves nothing behind";
}

TEST(ServeCommand, RefusesATakenPortAFolderThatIsNoneAndNonsense) {
  const ServedFolder served;
  const ProgramRun taken = served_until("TERM", ". --port " + std::to_string(served.server.port()));
  EXPECT_EQ(taken.exit_code, 4) << taken.output;
  EXPECT_THAT(taken.output, testing::HasSubstr("--port"));
  EXPECT_EQ(served_until("TERM", "no-such-folder").exit_code, 9);
  EXPECT_EQ(served_until("TERM", ". --port 65536").exit_code, 2);
}

}  // namespace
