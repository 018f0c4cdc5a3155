// From a first record to a decision with the commands, on a simulated board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "host/record/read_record.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

class Plan : public testing::Test {
 protected:
  void SetUp() override {
    const std::string text =
        "format = \"axis-model/1\"\nname = \"x\"\n[drive]\nkind = \"rotary\"\n"
        "amplifier_gain_A_per_V = 6.4898\ntorque_constant_Nm_per_A = 0.4769\n"
        "lead_mm_per_rad = 1.5915494309189535\nsample_period_s = 0.001\n"
        "[drive.dac]\nresolution_V = 0.00030517578125\nlimit_V = 10.0\n"
        "[drive.encoder]\nresolution_mm = 0.00244140625\n"
        "[drive.tach]\nnoise_variance_rad2_s2 = 0.02\n"
        "[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = 0.0072\n"
        "[[effect]]\nkind = \"viscous\"\nB_Nm_s_per_rad = 0.038\n"
        "[[effect]]\nkind = \"coulomb\"\npositive_Nm = 1.77\nnegative_Nm = -2.13\n";
    std::ofstream(file("model.toml")) << text;
    std::ofstream(file("machine.toml")) << text << "[[effect]]\nkind = \"input_delay\"\ndelay_s = 0.003\n";
  }
  std::string file(const char* name) const { return folder_.path(name); }
  ProgramRun excite(const std::string& words, const char* record, const char* machine = "machine.toml") const {
    return run_axistool("excite x " + words + " --device model:" + file(machine) + " --drive " + file("model.toml") +
                        " --yes --countdown 0 -o " + file(record));
  }
  nlohmann::json document(const char* name) const { return nlohmann::json::parse(std::ifstream(file(name))); }
  TemporaryFolder folder_;
};

const char* const kBox = " --box travel=80,speed=200,volts=4,time=8 ";

/// Catches a run that excite cannot make, a record that diagnose does not recognise, and odds that are not used.
TEST_F(Plan, SeparatesMakesAndDecides) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  ASSERT_EQ(excite(std::string("steps") + " --box travel=80,speed=200,volts=4,time=3", "steps.csv").exit_code, 0);
  const ProgramRun planned = run_axistool("plan " + file("model.toml") + " --train " + file("steps.csv") +
                                          " --rivals current_loop_lag,input_delay" + kBox + "-o " + file("run.toml") +
                                          " --json " + file("plan.json") + " --report " + file("plan.html"));
  ASSERT_EQ(planned.exit_code, 0) << planned.output;
  const nlohmann::json plan = document("plan.json");
  EXPECT_EQ(plan["format"], "axis-plan/1");
  EXPECT_EQ(plan["rivals"], (nlohmann::json{{"current_loop_lag"}, {"input_delay"}}));
  ASSERT_TRUE(plan["separable"].get<bool>());
  EXPECT_TRUE(plan["by_hand"].is_null());
  EXPECT_LE(plan["duration_s"], 8.0);
  const ProgramRun made = excite(file("run.toml"), "run.csv");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_EQ(host::read_record(file("run.csv")).header.at("excitation_rivals"), "current_loop_lag, input_delay");
  const std::string diagnose = "diagnose " + file("model.toml") + " --believed " + file("plan.json") + " --json " +
                               file("found.json") + " --train " + file("steps.csv") + " ";
  EXPECT_EQ(run_axistool(diagnose).exit_code, 2) << "the run is missing";
  const ProgramRun decided = run_axistool(diagnose + file("run.csv"));
  ASSERT_EQ(decided.exit_code, 0) << decided.output;
  const nlohmann::json found = document("found.json");
  EXPECT_EQ(found["verdict"]["effects"], nlohmann::json{"input_delay"});
  EXPECT_EQ(found["decision"]["best"], nlohmann::json{"input_delay"});
  EXPECT_LE(found["decision"]["odds"].get<double>(), 3.0 * plan["expected_odds"].get<double>());
  EXPECT_GE(3.0 * found["decision"]["odds"].get<double>(), plan["expected_odds"].get<double>());
}

/// Pieces in open and closed loop one after the other: the loop opens and closes between them, and the record has no
/// gap.
TEST_F(Plan, RunsPiecesOfEveryLoopInOneRecord) {
  ASSERT_EQ(run_axistool("design " + file("model.toml") + " -o " + file("p.toml")).exit_code, 0);
  const auto piece = [](const std::string& kind, const std::string& rest, const std::string& numbers) {
    return "[[piece]]\nkind = \"" + kind + "\"\ntime_s = 0.5\n" + rest + "[piece.numbers]\n" + numbers;
  };
  std::ofstream(file("run.toml")) << "format = \"axis-run-plan/1\"\n[box]\ntravel = 60.0\nspeed = 200.0\nvolts = 4.0\n"
                                     "time = 3.0\n"
                                  << piece("steps", "values = [2.0, -2.0]\n", "hold = 0.08\n")
                                  << piece("dwell", "values = [0.05, 0.1]\n", "speed = 20.0\nhold = 0.1\n")
                                  << piece("reversals", "", "amplitude = 0.1\nspeed = 4.0\n")
                                  << piece("steps", "values = [2.0, 0.0, -2.0]\n", "hold = 0.05\n");
  const ProgramRun made = excite(file("run.toml") + " --params " + file("p.toml"), "run.csv", "model.toml");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const host::Record record = host::read_record(file("run.csv"));
  EXPECT_GT(record.size(), 2500U);
  EXPECT_LT(record.size(), 6000U);
  EXPECT_NEAR(record.t_s.back(), 0.001 * static_cast<double>(record.size() - 1), 1e-6);
  EXPECT_EQ(record.header.at("excitation_piece_3"), "reversals amplitude=0.1 speed=4, 0.5 s");
  for (const double x : record.x) ASSERT_LT(std::abs(x), 30.0);
}

TEST_F(Plan, SaysWhatIsWrong) {
  ASSERT_EQ(excite(std::string("steps") + " --box travel=80,speed=200,volts=4,time=1", "steps.csv").exit_code, 0);
  const std::string start = "plan " + file("model.toml") + " --train " + file("steps.csv") + " -o " + file("run.toml");
  EXPECT_EQ(run_axistool(start + " --rivals input_delay,current_loop_lag").exit_code, 2) << "no box";
  const ProgramRun unknown = run_axistool(start + kBox + "--rivals input_delay,coging");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, HasSubstr("'coging' is unknown"));
  EXPECT_EQ(run_axistool(start + kBox + "--rivals input_delay").exit_code, 2) << "one rival";
  std::ofstream(file("run.toml")) << "format = \"axis-run-plan/1\"\n";
  EXPECT_EQ(excite(file("run.toml"), "run.csv").exit_code, 9);
}

}  // namespace
