#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.empty() || line.front() != '#') lines.push_back(line);
  return lines;
}

class Compare : public testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string model = kCase + "/model.toml";
  const std::string record = kCase + "/validate.csv";
};

TEST_F(Compare, JsonHasWhatTheFormatSays) {
  const ProgramRun run = run_axistool("compare " + model + " " + record + " --json -", "2>/dev/null");
  ASSERT_EQ(run.exit_code, 0);
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["format"], "axis-comparison/1");
  EXPECT_GT(json["relative_error"].get<double>(), 0.0);
  EXPECT_LT(json["relative_error"].get<double>(), 1.0);
  EXPECT_EQ(json["window_s"], 0.1);
  for (const char* channel : {"x_mm", "w_rad_s"}) {
    EXPECT_GE(json["channels"][channel]["rms"], json["channels"][channel]["floor"]) << channel;
    EXPECT_LE(json["channels"][channel]["fit"], 100.0);
  }
  EXPECT_GT(json["combined"], 1.0);
  EXPECT_TRUE(json["log_faults"].empty());
  EXPECT_EQ(json["records"].size(), 1u);
  EXPECT_FALSE(json["where"].empty());
}

TEST_F(Compare, PredictionsHaveTheRecordsRows) {
  const std::string predictions = folder.path("p.csv");
  ASSERT_EQ(run_axistool("compare " + model + " " + record + " --predictions " + predictions).exit_code, 0);
  const auto measured = lines_of(record), predicted = lines_of(predictions);
  ASSERT_EQ(predicted.size(), measured.size());
  EXPECT_EQ(predicted[0], "t_s,w_rad_s,x_mm,x_pred_mm,w_pred_rad_s");
  for (const std::size_t row : {std::size_t{1}, measured.size() - 1}) {
    double time[2];
    ASSERT_EQ(std::sscanf(measured[row].c_str(), "%lf", &time[0]), 1);
    double w, x, x_pred, w_pred;
    ASSERT_EQ(std::sscanf(predicted[row].c_str(), "%lf,%lf,%lf,%lf,%lf", &time[1], &w, &x, &x_pred, &w_pred), 5);
    EXPECT_EQ(time[0], time[1]);
    EXPECT_NEAR(x_pred, x, 1.0) << "within 0.1 s of a restart";
    EXPECT_NEAR(w_pred, w, 10.0);
  }
}

TEST_F(Compare, SeveralRecordsGetAFileEach) {
  const std::string jog = kCase + "/train-jog.csv";
  ASSERT_EQ(
      run_axistool("compare " + model + " " + record + " " + jog + " --predictions " + folder.path("p.csv")).exit_code,
      0);
  EXPECT_EQ(lines_of(folder.path("p-1-validate.csv")).size(), lines_of(record).size());
  EXPECT_EQ(lines_of(folder.path("p-2-train-jog.csv")).size(), lines_of(jog).size());
}

/// The rows after the last full window are also predicted. Effects with memory before a window need weights there.
TEST_F(Compare, PredictionsEndWithWhatIsLeftOfAWindow) {
  const auto lines = lines_of(record);
  std::string cut = "# format: axis-record/1\n# sample_period_s: 0.001\n";
  for (std::size_t k = 0; k < 1533; ++k) cut += lines[k] + "\n";
  const std::string delayed = folder.write(
      "delayed.toml",
      host::read_file(model) + "\n[[effect]]\nkind = \"input_delay\"\ndelay_s = 0.002\n" +
          "[[effect]]\nkind = \"encoder_cyclic_error\"\ncosine_mm = 0.01\nsine_mm = 0.0\nperiod_mm = 2.0\n");
  const std::string predictions = folder.path("p.csv");
  const ProgramRun run =
      run_axistool("compare " + delayed + " " + folder.write("cut.csv", cut) + " --predictions " + predictions);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(lines_of(predictions).size(), 1533u);
}

/// A first capture is often at rest: nothing slides, so no regression is possible.
TEST_F(Compare, ARecordAtRestIsSaidToBeOne) {
  std::string rest = "# format: axis-record/1\n# sample_period_s: 0.001\nt_s,u_V,x_mm,w_rad_s\n";
  for (int k = 0; k < 1500; ++k)
    rest += fmt::format("{:.3f},{:.2f},5.0,{:.3f}\n", 0.001 * k, 0.01 * (k % 7), 0.01 * ((k * 7919) % 11 - 5));
  const ProgramRun run = run_axistool("compare " + model + " " + folder.write("rest.csv", rest));
  EXPECT_THAT(run.exit_code, testing::AnyOf(0, 8)) << run.output;
}

TEST_F(Compare, FailsAboveTheLimitThatIsGiven) {
  EXPECT_EQ(run_axistool("compare " + model + " " + record + " --fail-above 1.0").exit_code, 1);
  EXPECT_EQ(run_axistool("compare " + model + " " + record + " --fail-above 1000").exit_code, 0);
}

TEST_F(Compare, WritesAReportAndLeavesTheModelAlone) {
  const std::string copy = folder.path("m.toml"), report = folder.path("r.html");
  fs::copy_file(model, copy);
  const ProgramRun run = run_axistool("compare " + copy + " " + record + " --report " + report);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, HasSubstr("constant speed"));
  EXPECT_EQ(lines_of(copy), lines_of(model));
  std::stringstream text;
  text << std::ifstream(report).rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("What is missing, as torque"));
}

/// Catches a second model that is read as a record.
TEST_F(Compare, SeveralModelsStandBesideEachOther) {
  std::string heavy = host::read_file(model);
  const std::size_t at = heavy.find("J_kg_m2 = ") + 10;
  heavy.replace(at, heavy.find('\n', at) - at, "0.02");
  const std::string other = folder.write("heavy.toml", heavy), report = folder.path("r.html"),
                    json = folder.path("c.json");
  const ProgramRun run =
      run_axistool("compare " + model + " " + other + " " + record + " --report " + report + " --json " + json);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("model.toml predicts best"));
  const auto both = nlohmann::json::parse(host::read_file(json));
  ASSERT_EQ(both["models"].size(), 2u);
  EXPECT_LT(both["models"][0]["combined"], both["models"][1]["combined"]);
  const auto alone = nlohmann::json::parse(run_axistool("compare " + other + " " + record + " --json -", "").output);
  EXPECT_EQ(both["models"][1]["channels"], alone["channels"]) << "a second model changes no figure of the first";
  EXPECT_EQ(both["combined"], both["models"][0]["combined"]);
  EXPECT_THAT(host::read_file(report), HasSubstr("\"name\":\"heavy.toml\""));
}

// After an effect was added, "does not fit" would hide what it has gained.
TEST_F(Compare, TellsHowMuchTheEffectsOfTheModelGain) {
  const std::string case_00 = AXIS_TEST_DATA "/drive-cases/single/case-00";
  const ProgramRun run =
      run_axistool("compare " + case_00 + "/model.toml " + case_00 + "/validate.csv --json " + folder.path("c.json"));
  const auto json = nlohmann::json::parse(host::read_file(folder.path("c.json")));
  EXPECT_GT(json["without_effects"]["times"], 2.0);
  EXPECT_THAT(run.output,
              HasSubstr(fmt::format("{:.3g} times better than without stribeck; the error is {:.3g} times",
                                    json["without_effects"]["times"].get<double>(), json["combined"].get<double>())));
}

// A hand-written model does not name its training records. The validation record must not be proposed for training.
TEST_F(Compare, TheNextCommandNamesTheFilesThatWereGivenAndTrainsOnNone) {
  const std::string copy = folder.path("my drive.toml");
  std::string heavy = host::read_file(model);
  const std::size_t at = heavy.find("J_kg_m2 = ") + 10;
  heavy.replace(at, heavy.find('\n', at) - at, "0.02");
  folder.write("my drive.toml", heavy);
  const ProgramRun run = run_axistool("compare '" + copy + "' " + record);
  EXPECT_THAT(run.output, HasSubstr("axistool diagnose '" + copy + "' --train TRAINING.csv --validate " + record));
}

TEST_F(Compare, WorksWithoutATachometer) {
  std::string text = "# format: axis-record/1\n# sample_period_s: 0.001\n";
  for (const std::string& line : lines_of(record)) text += line.substr(0, line.rfind(',')) + "\n";
  ASSERT_THAT(text, HasSubstr("t_s,u_V,x_mm\n"));
  const ProgramRun run =
      run_axistool("compare " + model + " " + folder.write("x.csv", text) + " --json -", "2>/dev/null");
  ASSERT_EQ(run.exit_code, 0);
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_TRUE(json["channels"].contains("x_mm"));
  EXPECT_FALSE(json["channels"].contains("w_rad_s"));
}

TEST_F(Compare, AWindowLongerThanTheRecordIsBadInput) {
  const ProgramRun run = run_axistool("compare " + model + " " + record + " --window 1000");
  EXPECT_EQ(run.exit_code, 9);
  EXPECT_THAT(run.output, HasSubstr("--window"));
}

}  // namespace
