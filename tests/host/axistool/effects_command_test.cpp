// axistool effects, as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(EffectsCommand, ListsTheCatalogue) {
  const ProgramRun run = run_axistool("effects");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, AllOf(HasSubstr("Friction\n"), HasSubstr("backlash"), HasSubstr("axistool effects KIND")));
}

TEST(EffectsCommand, ShowsOneEffectInFull) {
  const ProgramRun run = run_axistool("effects backlash");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, AllOf(HasSubstr("gap_mm"), HasSubstr("gap_m"), HasSubstr("kind = \"backlash\"")));
}

TEST(EffectsCommand, UnknownKindIsAUsageErrorWithASuggestion) {
  const ProgramRun run = run_axistool("effects baklash");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.output, AllOf(HasSubstr("'baklash' is unknown"), HasSubstr("did you mean backlash?")));
}

TEST(AddCommand, UnknownKindIsAUsageErrorWithASuggestion) {
  const std::string folder = AXIS_TEST_DATA "/drive-cases/none/case-01";
  const ProgramRun run = run_axistool("add " + folder + "/model.toml baklash --train " + folder +
                                      "/train-jog.csv -o /tmp/never-written.toml");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.output, HasSubstr("did you mean backlash?"));
}

TEST(EffectsCommand, JsonOnStandardOutputStandsAlone) {
  for (const char* arguments : {"effects --json -", "effects tach_gain --json -"}) {
    const ProgramRun run = run_axistool(arguments, "2>/dev/null");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(nlohmann::json::parse(run.output)["format"], "axis-effects/1") << arguments;
  }
}

TEST(EffectsCommand, JsonIntoAFileBesideTheText) {
  const TemporaryFolder folder;
  const std::string path = folder.path("effects.json");
  const ProgramRun run = run_axistool("effects --json \"" + path + "\"");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, HasSubstr("backlash"));
  std::ifstream file(path);
  EXPECT_EQ(nlohmann::json::parse(file)["format"], "axis-effects/1");
}

}  // namespace
