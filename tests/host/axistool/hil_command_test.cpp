// axistool hil: shipped scenarios by name, one page for several scenarios, before and after.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

TEST(HilCommand, ShippedScenariosGoByTheirNamesAndSeveralGetAnIndex) {
  const TemporaryFolder folder;
  const ProgramRun run = run_axistool("hil square fault-blocked.toml -o " + folder.path("out"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("2 of 2 scenarios hold"));
  EXPECT_THAT(run.output, HasSubstr(folder.path("out/index.html")));
  const std::string index = host::read_file(folder.path("out/index.html"));
  EXPECT_THAT(index, HasSubstr("<a href=\"square.html\">"));
  EXPECT_THAT(index, HasSubstr("<a href=\"fault-blocked.html\">"));
  EXPECT_TRUE(std::filesystem::exists(folder.path("out/square.html")));
}

TEST(HilCommand, AnUnknownNameSaysWhichThereAre) {
  const ProgramRun run = run_axistool("hil sqare");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.output, HasSubstr("did you mean square?"));
  EXPECT_THAT(run.output, HasSubstr("hidden-effect"));
}

TEST(HilCommand, TheSpoiltCircleIsNotCalledGood) {
  const ProgramRun run = run_axistool("hil hidden-effect");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, HasSubstr("misses its target"));
}

TEST(HilCommand, BeforeAndAfterStandOnOnePage) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_axistool("hil hidden-effect -o " + folder.path("one")).exit_code, 0);
  const ProgramRun run =
      run_axistool("hil hidden-effect --before-after --model x=" + folder.path("one/hidden-effect-x.toml") + " -o " +
                   folder.path("two"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("Before and after: contour error 12.3 → 12.3 µm"));
  EXPECT_THAT(host::read_file(folder.path("two/hidden-effect.html")), HasSubstr(">before: "));
}

}  // namespace
