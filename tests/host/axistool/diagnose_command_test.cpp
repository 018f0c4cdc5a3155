#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kCases = fs::path(AXIS_TEST_DATA) / "drive-cases";

TEST(DiagnoseCommand, JsonHasWhatTheFormatSays) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const std::string folder = (kCases / "single" / "case-06").string();
  const ProgramRun run = run_axistool("diagnose " + folder + "/model.toml --train " + folder + "/train-jog.csv " +
                                          folder + "/train-sweep.csv --validate " + folder + "/validate.csv --json -",
                                      "2>/dev/null");
  ASSERT_EQ(run.exit_code, 0);
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["format"], "axis-diagnosis/1");

  const auto& error = json["error"];
  EXPECT_EQ(error["window_s"], 0.1);
  for (const char* channel : {"x_mm", "w_rad_s"})
    for (const char* of : {"before", "floor"})
      for (const char* set : {"train", "validate"})
        EXPECT_GT(error["channels"][channel][of][set].get<double>(), 0.0) << channel << ' ' << of << ' ' << set;
  const double before = error["combined"]["before"]["validate"];
  EXPECT_GT(before, 1.0);
  EXPECT_GT(error["combined"]["before"]["train"], 1.0);

  std::map<std::string, double> shares;
  for (const auto& region : json["where"]) {
    EXPECT_TRUE(region["region"].is_string());
    EXPECT_TRUE(region["rms"].is_number());
    shares[region["partition"]] += region["share"].get<double>();
  }
  EXPECT_TRUE(shares.contains("regime"));
  for (const auto& [partition, sum] : shares) EXPECT_NEAR(sum, 1.0, 1e-6) << partition;

  ASSERT_FALSE(json["candidates"].empty());
  double last = 0.0;
  for (const auto& candidate : json["candidates"]) {
    EXPECT_FALSE(candidate["kinds"].empty());
    EXPECT_EQ(candidate["before"], before);
    EXPECT_GE(candidate["after"].get<double>(), last);  // best first
    last = candidate["after"];
    EXPECT_TRUE(candidate["parameters"].is_object());
    EXPECT_FALSE(candidate["parameters"].empty());
    EXPECT_GE(candidate["confidence"].get<double>(), 0.0);
    EXPECT_LE(candidate["confidence"].get<double>(), 1.0);
    EXPECT_TRUE(candidate["confused_with"].is_array());
    EXPECT_FALSE(candidate["separate_by"].get<std::string>().empty());
  }

  const auto& verdict = json["verdict"];
  EXPECT_THAT(verdict["status"].get<std::string>(), testing::AnyOf("missing", "ambiguous"));
  EXPECT_THAT(verdict["effects"].get<std::vector<std::string>>(), testing::Contains("input_delay"));
  EXPECT_TRUE(verdict["parameters"].is_array());
  EXPECT_TRUE(verdict["alternatives"].is_array());
  EXPECT_FALSE(verdict["next_experiment"].get<std::string>().empty());
  EXPECT_FALSE(verdict["explanation"].get<std::string>().empty());
}

TEST(DiagnoseCommand, AMissingRecordIsABadFile) {
  const std::string folder = (kCases / "none" / "case-01").string();
  const ProgramRun run = run_axistool("diagnose " + folder + "/model.toml --train " + folder + "/no-such.csv");
  EXPECT_EQ(run.exit_code, 9);
  EXPECT_THAT(run.output, HasSubstr("no-such.csv"));
}

TEST(ImproveCommand, InterruptedItLeavesNothingBehindAndWhatWasThereWhole) {
  const TemporaryFolder folder;
  const std::string model = folder.write("better.toml", "what was there\n");
  const std::string data = (kCases / "pairs" / "case-00").string();
  // Interrupted as by Ctrl-C, long before its end; timeout then returns 124.
  const ProgramRun run =
      run_program("timeout --signal=INT 1 \"" AXISTOOL_PROGRAM "\" improve " + data + "/model.toml --train " + data +
                  "/train-jog.csv --validate " + data + "/validate.csv -o " + model + " --json " +
                  folder.path("better.json") + " --report " + folder.path("better.html"));
  ASSERT_EQ(run.exit_code, 124) << run.output;
  std::ifstream in(model);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "what was there");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path("")), fs::directory_iterator()), 1);
}

TEST(ScoreboardCommand, CountsAnAnswerThatIsTheTruth) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const TemporaryFolder folder;
  const std::string json = folder.path("scores.json");
  const ProgramRun run = run_axistool("scoreboard " + (kCases / "none" / "case-01").string() + " --json " + json);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("nothing hidden: 1 cases, 0 false claims"));
  std::ifstream in(json);
  const auto scores = nlohmann::json::parse(in);
  EXPECT_EQ(scores["format"], "axis-scoreboard/1");
  ASSERT_EQ(scores["cases"].size(), 1u);
  EXPECT_EQ(scores["cases"][0]["outcome"], "right");
  EXPECT_EQ(scores["summary"]["none"]["right"], 1);
}

TEST(ScoreboardCommand, AFolderWithoutCasesIsABadFile) {
  const TemporaryFolder folder;
  const ProgramRun run = run_axistool("scoreboard " + folder.path("."));
  EXPECT_EQ(run.exit_code, 9);
  EXPECT_THAT(run.output, HasSubstr("truth.json"));
}

}  // namespace
