// The commands for boards, on a simulated board, as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/record/read_record.hpp"
#include "tests/host/axistool/run_workflow.hpp"
#include "tests/host/axistool/simulated_board.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

class DeviceCommands : public testing::Test {
 protected:
  std::string file(const char* name) const { return folder_.path(name); }

  ProgramRun run(const std::string& command) const { return board_.run(command); }

  /// Runs a command that must end with `exit_code`; returns the JSON on standard output.
  nlohmann::json json(const std::string& command, int exit_code = 0) const {
    const ProgramRun done = board_.run(command + " --json -", "2>/dev/null");
    EXPECT_EQ(done.exit_code, exit_code) << command << "\n" << done.output;
    return nlohmann::json::parse(done.output, nullptr, false);
  }

  std::string design() const {
    EXPECT_EQ(run_axistool("design " + kCase + "/model.toml -o " + file("params.toml")).exit_code, 0);
    return file("params.toml");
  }

  /// Sets the design on the board, with long time-outs, so that a loaded computer does not look like a lost host.
  void fit() const { ASSERT_EQ(run("set-params " + design() + " host.timeout=5").exit_code, 0); }

  /// Number of lines of a capture that has not ended.
  std::ptrdiff_t lines_on_disk(const char* name) const {
    std::ifstream in(file(name) + ".unfinished");
    return std::count(std::istreambuf_iterator<char>(in), {}, '\n');
  }

  TemporaryFolder folder_;
  SimulatedBoardProcess board_{folder_.path(""), {"--x", kCase + "/model.toml"}};
};

TEST_F(DeviceCommands, FromRecordToRecord) {
  const ProgramRun workflow = run_workflow(board_.address(), kCase, folder_.path(""));
  ASSERT_EQ(workflow.exit_code, 0) << workflow.output;
  EXPECT_EQ(host::read_record(file("jogs.csv")).size(), 2000u);
  const nlohmann::json comparison = nlohmann::json::parse(std::ifstream(file("comparison.json")));
  EXPECT_LT(comparison["relative_error"].get<double>(), 0.05) << "torque that the identified model leaves unexplained";
}

TEST_F(DeviceCommands, ParametersOutliveAPowerCutOnceTheyAreSaved) {
  const std::string params = design();
  ASSERT_EQ(run("set-params " + params).exit_code, 0);
  EXPECT_EQ(run("diff-params " + params).exit_code, 0);
  ASSERT_EQ(run("save").exit_code, 0);
  ASSERT_EQ(run("set-params x.feedback.k1=20").exit_code, 0);
  EXPECT_EQ(run("diff-params " + params).exit_code, 1);
  board_.end(SIGKILL);
  std::filesystem::remove(folder_.path("board.socket"));
  const SimulatedBoardProcess again(folder_.path(""), {"--x", kCase + "/model.toml"});
  EXPECT_EQ(again.run("diff-params " + params).exit_code, 0);
  EXPECT_THAT(again.run("info").output, HasSubstr("loaded"));
}

TEST_F(DeviceCommands, SetParamsSaysWhatIsWrongAndChangesNothing) {
  const ProgramRun high = run("set-params x.feedback.k1=3 x.kalman.k11=5.2");
  EXPECT_EQ(high.exit_code, 2);
  EXPECT_THAT(high.output, HasSubstr("x.kalman.k11 = 5.2 is above its maximum 2.0 (1)"));
  const ProgramRun typo = run("set-params x.kalman.k1l=0.2");
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_THAT(typo.output, HasSubstr("did you mean x.kalman.k11"));
  std::ofstream(file("bad.toml")) << "format = \"axis-params/1\"\n[x.kalman]\nk12 = 0.1\nk11 = 5.2\n";
  const ProgramRun bad = run("set-params " + file("bad.toml"));
  EXPECT_EQ(bad.exit_code, 9);
  EXPECT_THAT(bad.output, HasSubstr("bad.toml: line 4: x.kalman.k11 = 5.2 is above its maximum 2.0 (1)"));
  std::ofstream(file("stage.toml")) << "format = \"axis-params/1\"\n[stage.kalman]\nk12 = 0.1\n";
  EXPECT_THAT(run("set-params " + file("stage.toml")).output, HasSubstr("--axis x"));
  EXPECT_EQ(run("set-params x.drive.fitted=true").exit_code, 9) << "fitted without a design";
  EXPECT_EQ(run("diff-params --defaults").exit_code, 0) << "none of the refused values was set";
  EXPECT_EQ(run("set-params " + file("stage.toml") + " --axis y").exit_code, 0);
  EXPECT_EQ(json("get-params y.kalman.k12")["parameters"]["y.kalman.k12"], 0.1F);
}

TEST_F(DeviceCommands, ADryRunChangesNothing) {
  const std::string params = design();
  const nlohmann::json change = json("set-params " + params + " --save --dry-run");
  EXPECT_FALSE(change["applied"].get<bool>());
  EXPECT_GT(change["changes"].size(), 20u);
  EXPECT_EQ(run("diff-params --defaults").exit_code, 0);
  EXPECT_EQ(run("enable x --dry-run").exit_code, 0);
  EXPECT_EQ(run("reset-params --dry-run").exit_code, 0);
}

TEST_F(DeviceCommands, ABackupIsRestoredBitByBit) {
  ASSERT_EQ(run("set-params " + design() + " x.feedback.k2=0.8123457 y.limits.jerk=333").exit_code, 0);
  const nlohmann::json before = json("get-params");
  ASSERT_EQ(run("backup " + file("backup.toml")).exit_code, 0);
  EXPECT_EQ(run("reset-params").exit_code, 8) << "asks first, and nobody answers";
  ASSERT_EQ(run("reset-params --save --yes").exit_code, 0);
  EXPECT_EQ(run("diff-params --defaults").exit_code, 0);
  ASSERT_EQ(run("restore " + file("backup.toml") + " --yes").exit_code, 0);
  EXPECT_EQ(json("get-params"), before);
  EXPECT_EQ(run("diff-params " + file("backup.toml")).exit_code, 0);
}

TEST_F(DeviceCommands, ABackupBringsTablesOfPitchErrorsToAnEmptyBoard) {
  ASSERT_EQ(run("set-params " + design()).exit_code, 0);
  std::ofstream(file("screw.csv")) << "x_mm,error_um\n0,0\n10,4\n20,-3\n30,1\n40,0\n50,2\n";
  ASSERT_EQ(run("pitch " + file("screw.csv") + " --axis x --yes").exit_code, 0);
  const nlohmann::json before = json("pitch --axis x"), told = json("info");
  EXPECT_THAT(told["axes"][0]["pitch_table"].get<std::string>(), HasSubstr("6 points, 0 to 50"));
  ASSERT_EQ(run("backup " + file("backup.toml")).exit_code, 0);
  ASSERT_EQ(run("set-params x.pitch.on=false").exit_code, 0);
  ASSERT_EQ(run("pitch --axis x --remove --yes").exit_code, 0);
  ASSERT_EQ(run("reset-params --save --yes").exit_code, 0);
  ASSERT_EQ(run("restore " + file("backup.toml") + " --yes").exit_code, 0);
  EXPECT_EQ(json("pitch --axis x"), before);
  EXPECT_EQ(run("diff-params " + file("backup.toml")).exit_code, 0);
}

TEST_F(DeviceCommands, MotionIsRefusedWhereItMust) {
  EXPECT_EQ(run("enable x --yes").exit_code, 8) << "not fitted";
  fit();
  EXPECT_EQ(run("jog x 10").exit_code, 8) << "not enabled";
  EXPECT_EQ(run("enable x").exit_code, 8) << "nobody answers the question";
  ASSERT_EQ(run("enable x --yes").exit_code, 0);
  EXPECT_EQ(run("save").exit_code, 8);
  EXPECT_EQ(run("set-params x.feedback.k1=20").exit_code, 8);
  EXPECT_EQ(run("move x 5").exit_code, 8) << "not homed";
  ASSERT_EQ(run("home x --here").exit_code, 0);
  EXPECT_THAT(run("jog x 10 --for 0.1").output, HasSubstr(" mm"));
  const nlohmann::json moved = json("move x 5");
  EXPECT_NEAR(moved["to"].get<double>(), 5.0, 0.01);
  EXPECT_NEAR(json("move x -2 --relative")["to"].get<double>(), 3.0, 0.01);
  EXPECT_EQ(run("jog z 10").exit_code, 2);
  const ProgramRun fast = run("jog x 5000");
  EXPECT_EQ(fast.exit_code, 8) << "otherwise the board would silently move slower than commanded";
  EXPECT_THAT(fast.output, HasSubstr("x.limits.velocity = 250"));
  EXPECT_EQ(run("capture -o " + file("fast.csv") + " --jog 20:0.1,-5000:0.1").exit_code, 8);
  EXPECT_EQ(run("disable").exit_code, 0);
  EXPECT_EQ(json("faults")["axes"][0]["fault"], "none");
}

/// The log survives the clearing of the fault, saves, and a power failure.
TEST_F(DeviceCommands, FaultsAreLogged) {
  ASSERT_EQ(run("set-params " + design() + " host.timeout=0.2 --save").exit_code, 0);
  EXPECT_TRUE(json("faults")["log"].empty());
  ASSERT_EQ(run("enable x --yes").exit_code, 0);
  Child jog = board_.start("jog x 10 --for 60");
  EXPECT_TRUE(wait_until([&] { return board_.moves(); }));
  jog.kill();
  nlohmann::json faults;
  EXPECT_TRUE(wait_until([&] {
    faults = nlohmann::json::parse(run_axistool("faults" + board_.device() + "--json -", "2>/dev/null").output);
    return !faults["log"].empty();
  }));
  ASSERT_FALSE(faults["log"].empty());
  const nlohmann::json entry = faults["log"].back();  // of x; the other axis is not fitted and has no entry
  EXPECT_EQ(entry["fault"], "host_heartbeat_lost");
  EXPECT_EQ(entry["axis"], "x");
  EXPECT_EQ(entry["activity"], "moving");
  EXPECT_EQ(entry["position_unit"], "mm");
  EXPECT_GT(entry["position"].get<double>(), 1.0);
  EXPECT_FALSE(entry["homed"].get<bool>());
  ASSERT_EQ(run("clear-faults").exit_code, 0);
  ASSERT_EQ(run("save").exit_code, 0);
  board_.end(SIGKILL);
  std::filesystem::remove(folder_.path("board.socket"));
  const SimulatedBoardProcess again(folder_.path(""), {"--x", kCase + "/model.toml"});
  const ProgramRun told = again.run("faults");
  EXPECT_EQ(told.exit_code, 0) << "there is none now";
  EXPECT_THAT(told.output, AllOf(HasSubstr("#1 "), HasSubstr("fault 19 host_heartbeat_lost, moving, at "),
                                 HasSubstr(" mm (not homed)"), HasSubstr(", no fault")));
}

TEST_F(DeviceCommands, CaptureEnablesTheAxisThatItJogs) {
  fit();
  const std::string capture = "capture -o " + file("jogs.csv") + " --jog 20:0.2,-20:0.2";
  EXPECT_EQ(run(capture).exit_code, 8) << "nobody answers the question";
  const ProgramRun done = run(capture + " --yes");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const host::Record record = host::read_record(file("jogs.csv"));
  EXPECT_GT(*std::max_element(record.x.begin(), record.x.end()) - record.x.front(), 2.0);
  EXPECT_EQ(run("jog x 10").exit_code, 8) << "still enabled";
}

TEST_F(DeviceCommands, ATriggerKeepsWhatWasBefore) {
  fit();
  ASSERT_EQ(run("enable x --yes").exit_code, 0);
  ASSERT_EQ(run("capture -o " + file("bump.csv") +
                " --jog 1:1,50:0.4 --trigger 'w_ref_rad_s>10' --pre 0.1 --for 0.2 --channels u_V,x_mm,w_rad_s,d_hat_V")
                .exit_code,
            0);
  const host::Record record = host::read_record(file("bump.csv"));
  ASSERT_EQ(record.size(), 300u);
  EXPECT_NEAR(std::stod(record.header.at("trigger_s")), 0.1, 1e-9);
  EXPECT_LE(record.w_ref[99], 10.0);
  EXPECT_GT(record.w_ref[100], 10.0);
  EXPECT_EQ(record.extra.at(0).name, "d_hat_V");
  const ProgramRun never = run("capture -o " + file("never.csv") + " --trigger 'x_mm>1e6' --wait 0.3");
  EXPECT_EQ(never.exit_code, 7);
  EXPECT_FALSE(std::filesystem::exists(file("never.csv")));
}

TEST_F(DeviceCommands, APulledPlugEndsACaptureAtOnce) {
  Child capture = board_.start("capture -o " + file("long.csv") + " --for 60");
  EXPECT_TRUE(wait_until([&] { return lines_on_disk("long.csv") > 500; }));
  board_.end(SIGKILL);
  EXPECT_EQ(capture.wait(), 3);
  EXPECT_FALSE(std::filesystem::exists(file("long.csv")));
  EXPECT_GT(host::read_record(file("long.csv.unfinished")).size(), 400u) << "the received rows are on disk";
  EXPECT_EQ(run("info").exit_code, 3) << "nobody is there";
}

/// Catches a capture that leaves no file if a signal ends it.
TEST_F(DeviceCommands, ASignalEndsACaptureWithWhatCame) {
  Child capture = board_.start("capture -o " + file("cut.csv") + " --for 3600 --json -", file("told.json"));
  EXPECT_TRUE(wait_until([&] { return lines_on_disk("cut.csv") > 600; }));
  EXPECT_EQ(capture.end(SIGINT), 0);
  EXPECT_TRUE(nlohmann::json::parse(std::ifstream(file("told.json")))["cut_short"].get<bool>());
  const host::Record record = host::read_record(file("cut.csv"));
  EXPECT_GT(record.size(), 500u);
  EXPECT_FALSE(std::filesystem::exists(file("cut.csv.unfinished")));
}

TEST_F(DeviceCommands, TellAboutTheBoard) {
  const nlohmann::json info = json("info");
  EXPECT_EQ(info["format"], "axis-board/1");
  EXPECT_TRUE(info["simulated"].get<bool>());
  EXPECT_EQ(info["axes"][0]["state"], "not fitted");
  EXPECT_THAT(run("capture x -o " + file("raw.csv") + " --for 0.1").output, HasSubstr("axis x is not fitted"));
  const nlohmann::json doctor = json("doctor");
  for (const auto& check : doctor["checks"]) EXPECT_NE(check["result"], "bad") << check;
  const nlohmann::json bench = json("bench --for 1");
  EXPECT_EQ(bench["lost_rows"], 0);
  EXPECT_LE(bench["open_ms"].get<double>(), bench["connect_ms"].get<double>());
  EXPECT_GT(bench["capture_rows"], 0);
  EXPECT_EQ(run("clear-faults").exit_code, 0);
}

/// No command may assume that a board has two axes.
class AxesOfABoard : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Counts, AxesOfABoard, testing::Values(1, 3));

TEST_P(AxesOfABoard, AreAsManyAsItSays) {
  const TemporaryFolder folder;
  const std::string last = GetParam() == 1 ? "x" : "z", next = GetParam() == 1 ? "y" : "a";
  const SimulatedBoardProcess board(folder.path(""),
                                    {"--axes", std::to_string(GetParam()), "--" + last, kCase + "/model.toml"});
  const auto json = [&](const std::string& command) {
    return nlohmann::json::parse(board.run(command + " --json -", "2>/dev/null").output, nullptr, false);
  };
  EXPECT_EQ(json("info")["axes"].size(), GetParam());
  EXPECT_EQ(json("faults")["axes"].size(), GetParam());
  const std::string params = folder.path("params.toml");
  ASSERT_EQ(run_axistool("design " + kCase + "/model.toml -o " + params).exit_code, 0);
  const std::string meant = params + " --axis " + last;
  ASSERT_EQ(board.run("set-params " + meant + " host.timeout=5 --save").exit_code, 0);
  EXPECT_EQ(board.run("diff-params " + meant).exit_code, 0);
  EXPECT_EQ(board.run("set-params " + next + ".feedback.k1=1").exit_code, 9) << "there is no such axis";
  EXPECT_EQ(board.run("get-params " + next).exit_code, 9);
  ASSERT_EQ(board.run("enable " + last + " --yes").exit_code, 0);
  EXPECT_EQ(board.run("jog " + next + " 1").exit_code, 2);
  EXPECT_NEAR(json("move " + last + " 2 --relative")["to"].get<double>(), 2.0, 0.01);
  EXPECT_EQ(board.run("disable").exit_code, 0);
  ASSERT_EQ(board.run("backup " + folder.path("backup.toml")).exit_code, 0);
  ASSERT_EQ(board.run("reset-params --yes").exit_code, 0);
  ASSERT_EQ(board.run("restore " + folder.path("backup.toml") + " --yes").exit_code, 0);
  EXPECT_EQ(board.run("diff-params " + meant).exit_code, 0);
  EXPECT_EQ(json("bench --for 0.5")["lost_rows"], 0);
}

TEST(DeviceOption, NamesWhatItTakes) {
  const ProgramRun odd = run_axistool("info --device com3");
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_THAT(odd.output, AllOf(HasSubstr("usb:SERIAL"), HasSubstr("socket:PATH")));
  EXPECT_THAT(run_axistool("info --device socket:/nowhere/at/all").output, HasSubstr("axistool sim"));
}

/// Catches a doctor that only repeats that it has found no board.
TEST(Doctor, SaysWhatToCheckWhereNoBoardAnswers) {
  const ProgramRun none = run_axistool("doctor --device usb:NOWHERE");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.output, AllOf(HasSubstr("cable"), HasSubstr("udev rule"), HasSubstr("axistool sim")));
}

}  // namespace
