// Commands with an external program as the machine: the example in Python, and faulty programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

const std::string kExample = AXIS_TEST_DATA "/../../host/examples/05-own-plant";

std::string plant(const std::string& command) { return "\"plant:" + kExample + ".toml:" + command + "\""; }

/// The example's physics is independent of the simulator. The data sheet's torque is 6.5 * 0.48 / 3.1 times the
/// machine's.
TEST(AnotherProgramsMachine, IsExcitedAndIdentified) {
  const TemporaryFolder folder;
  const ProgramRun excited = run_axistool(
      "excite x steps --drive " + kExample + ".toml --box travel=60,speed=150,volts=3,time=5 --yes --countdown 0 -o " +
      folder.path("steps.csv") + " --device " + plant("python3 " + kExample + ".py"));
  ASSERT_EQ(excited.exit_code, 0) << excited.output;
  const ProgramRun found =
      run_axistool("identify " + folder.path("steps.csv") + " --drive " + kExample + ".toml --json -", "2>/dev/null");
  const auto parameters = nlohmann::json::parse(found.output)["parameters"];
  EXPECT_NEAR(parameters["J_kg_m2"]["value"].get<double>(), 0.0081 * 6.5 * 0.48 / 3.1, 0.02 * 0.0081);
}

TEST(AnotherProgramsMachine, EndsTheCommandWhenItEnds) {
  const ProgramRun run =
      run_axistool("clear-faults --device " + plant("read hello; echo ready; read line; echo 0 0.5 -"));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.output, HasSubstr("last said '0 0.5 -'"));
}

TEST(AnotherProgramsMachine, StandsInForADriveOfAScenario) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("own.toml")) << "format = \"axis-scenario/1\"\nname = \"own\"\nduration_s = 1.0\n"
                                         << "[x]\ndrive = \"program: python3 " << kExample << ".py\"\n"
                                         << "data_sheet = \"paper x\"\n[y]\ndrive = \"paper y\"\n"
                                         << "[[move]]\nat_s = 0.1\nkind = \"jog\"\naxis = \"x\"\nspeed_mm_s = 20\n"
                                         << "[[expect]]\naxis = \"x\"\nsignal = \"position_mm\"\nat_least = 15\n"
                                         << "[[expect]]\naxis = \"x\"\nsignal = \"tracking_um\"\nat_least = 1\n";
  const ProgramRun run = run_axistool("hil --allow-program " + folder.path("own.toml"));
  EXPECT_EQ(run.exit_code, 0) << run.output;
}

/// A scenario from elsewhere must not run programs without consent, and the question must show the whole command line.
TEST(AnotherProgramsMachine, OfAScenarioRunsOnlyWhereThatIsAgreedTo) {
  const TemporaryFolder folder;
  const std::string trace = folder.path("trace");
  std::ofstream(folder.path("own.toml")) << "format = \"axis-scenario/1\"\nname = \"own\"\nduration_s = 0.1\n"
                                         << "[x]\ndrive = \"paper x\"\n"
                                         << "[y]\ndrive = \"program: touch " << trace << "; # \\u001b[2K\"\n"
                                         << "data_sheet = \"paper y\"\n";
  for (const char* how : {"", " --before-after --model x=/dev/null", " circle"}) {
    const ProgramRun refused = run_axistool("hil " + folder.path("own.toml") + how, "</dev/null 2>&1");
    EXPECT_EQ(refused.exit_code, 8) << how;
    EXPECT_THAT(refused.output, HasSubstr("touch " + trace + "; # \\x1b[2K"));
    EXPECT_THAT(refused.output, HasSubstr("--allow-program"));
    EXPECT_FALSE(std::filesystem::exists(trace)) << how;
  }
  EXPECT_EQ(run_axistool("hil --allow-program " + folder.path("own.toml")).exit_code, 3);  // it ends at once
  EXPECT_TRUE(std::filesystem::exists(trace));
}

TEST(AnotherProgramsMachine, CannotBeBlockedByAScenario) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("own.toml")) << "format = \"axis-scenario/1\"\nname = \"own\"\nduration_s = 1.0\n"
                                         << "[x]\ndrive = \"program: python3 " << kExample << ".py\"\n"
                                         << "data_sheet = \"paper x\"\n[y]\ndrive = \"paper y\"\n"
                                         << "[[fault]]\nat_s = 0.1\nkind = \"blocked\"\naxis = \"x\"\n";
  const ProgramRun run = run_axistool("hil " + folder.path("own.toml"));
  EXPECT_EQ(run.exit_code, 9);
  EXPECT_THAT(run.output, HasSubstr("let the program do it"));
}

}  // namespace
