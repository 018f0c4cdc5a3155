// axistool demo, as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(DemoCommand, WritesItsReportFromAnyFolderAndEndsWithASummary) {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path(""));
  const ProgramRun run = run_axistool("demo --output shown/here");
  std::filesystem::current_path(before);
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("Every figure agrees"), HasSubstr("shown/here/index.html"),
                                HasSubstr("x inertia J"), HasSubstr("y inertia J"), HasSubstr("--emps DIR")));
  EXPECT_GT(std::filesystem::file_size(folder.path("shown/here/index.html")), 100'000u);
}

TEST(DemoCommand, AbsentRecordIsNamedWithWhatToDo) {
  const TemporaryFolder folder;
  const ProgramRun run = run_axistool("demo --output " + folder.path("out") + " --data " + folder.path("gone"));
  EXPECT_EQ(run.exit_code, 9);
  EXPECT_THAT(run.output, AllOf(HasSubstr("gone"), HasSubstr("--data")));
}

TEST(DemoCommand, EmpsFolderWithoutItsRecordsIsABadInput) {
  const TemporaryFolder folder;
  const ProgramRun run = run_axistool("demo --output " + folder.path("out") + " --emps " + folder.path(""));
  EXPECT_EQ(run.exit_code, 9);
  EXPECT_THAT(run.output, HasSubstr("DATA_EMPS.mat"));
}

}  // namespace
