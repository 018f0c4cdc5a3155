// axistool run on a simulated board in a separate process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/record/read_record.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/axistool/simulated_board.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

const std::string kModel = AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml";
const std::string kPrograms = AXIS_TEST_DATA "/gcode/";

class RunCommand : public testing::Test {
 public:
  explicit RunCommand(std::vector<std::string> more = {})
      : board_(folder_.path(""), [&] {
          std::vector<std::string> all = {"--x", kModel, "--y", kModel};
          all.insert(all.end(), more.begin(), more.end());
          return all;
        }()) {}

 protected:
  std::string file(const char* name) const { return folder_.path(name); }
  std::string written(const char* name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  ProgramRun run(const std::string& command, const std::string& streams = "2>&1") const {
    return board_.run(command, streams);
  }

  /// Sets a design on both axes, which have the same drive. The board has long time-outs, so that a loaded computer
  /// does not look like a lost host.
  void fit() const {
    ASSERT_EQ(run_axistool("design " + kModel + " -o " + file("x.toml")).exit_code, 0);
    std::ifstream in(file("x.toml"));
    std::string text{std::istreambuf_iterator<char>(in), {}};
    for (std::size_t at = 0; (at = text.find("[x.", at)) != std::string::npos;) text[at + 1] = 'y';
    ASSERT_EQ(run("set-params " + file("x.toml") +
                  " host.timeout=5 x.monitor.travel_min=-90 x.monitor.travel_max=90 "
                  "y.monitor.travel_min=-90 y.monitor.travel_max=90")
                  .exit_code,
              0);
    ASSERT_EQ(run("set-params " + written("y.toml", text)).exit_code, 0);
    for (const char* axis : {"x", "y"}) ASSERT_EQ(run(std::string("home ") + axis + " --here").exit_code, 0);
  }

  TemporaryFolder folder_;
  SimulatedBoardProcess board_;
};

/// The paper's circle, streamed over the protocol: as accurate as the same loop in one process.
TEST_F(RunCommand, FollowsTheCircleAndMeasuresItsContour) {
  fit();
  const std::string circle = written("circle.ngc", "F10200 G3 X0 Y0 I35 J0\nM2\n");  // 170 mm/s
  const ProgramRun done = run("run " + circle + " --yes --json - --capture " + file("c.csv"), "2>/dev/null");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const auto told = nlohmann::json::parse(done.output);
  EXPECT_EQ(told["format"], "axis-run/1");
  EXPECT_EQ(told["stopped_because"], "completed");
  EXPECT_NEAR(told["duration_s"], 1.435, 0.02);
  EXPECT_LT(told["contour_um"], 12.0);
  EXPECT_GT(told["contour_um"], 0.5) << "an encoder of 2.4 um cannot show a smaller error";
  const host::Record record = host::read_record(file("c.csv"));
  EXPECT_NEAR(*std::max_element(record.x.begin(), record.x.end()), 70.0, 0.05);
  EXPECT_NEAR(record.x.back(), 0.0, 0.02) << "it ends where it began";
}

/// Compares the command stated by the dry run (from the model) with the one that the same program needs on the plant
/// (in the loop), in both directions, because friction differs by direction.
TEST_F(RunCommand, ADryRunSaysTheLargestCommandAndWhere) {
  fit();
  for (const char* to : {"60", "-60"}) {
    const std::string line = written("line.ngc", std::string("F12000\nG1 X") + to + "\nM2\n");
    const ProgramRun dry = run("run " + line + " --dry-run --json -", "2>/dev/null");
    ASSERT_EQ(dry.exit_code, 0) << dry.output;
    const auto need = nlohmann::json::parse(dry.output)["commands"][0];
    EXPECT_EQ(need["axis"], "x");
    EXPECT_EQ(need["line"], 2);
    ASSERT_EQ(run("run " + line + " --yes --capture " + file("c.csv")).exit_code, 0);
    const host::Record record = host::read_record(file("c.csv"));
    double most_V = 0.0;
    for (const double u : record.u_V) most_V = std::max(most_V, std::abs(u));
    std::printf("to %s mm: stated %.3f V, needed %.3f V\n", to, need["command_V"].get<double>(), most_V);
    EXPECT_NEAR(need["command_V"], most_V, 0.05 * most_V + 0.03);
    ASSERT_EQ(run("run " + written("back.ngc", "G0 X0\nM2\n") + " --yes").exit_code, 0);
  }
}

/// Catches a force of another axis, one that holds the axis's friction, and one without its band. No force acts, and
/// the model is exact, so that the estimate is its noise.
TEST_F(RunCommand, CapturesTheProcessForceOfEachAxisWithAModel) {
  fit();
  const std::string line = written("line.ngc", "F3000\nG1 X60 Y-45\nM2\n");
  ASSERT_EQ(run("run " + line + " --yes --capture " + file("c.csv") + " --model " + kModel + " " + kModel).exit_code,
            0);
  const host::Record record = host::read_record(file("c.csv"));
  for (const std::string prefix : {"", "y_"}) {
    const auto force = std::ranges::find(record.extra, prefix + "process_force_N", &host::ExtraChannel::name);
    ASSERT_NE(force, record.extra.end()) << prefix;
    const double band_N = std::stod(record.header.at(prefix + "process_force_band_N"));
    const std::size_t begin = record.size() / 4, end = 3 * record.size() / 4;
    double squares = 0.0;
    for (std::size_t k = begin; k < end; ++k) squares += force->values[k] * force->values[k];
    const double rms_N = std::sqrt(squares / static_cast<double>(end - begin));
    std::printf("%sprocess force without a process: %.1f N RMS, band +-%.1f N\n", prefix.c_str(), rms_N, band_N);
    EXPECT_GT(rms_N, 0.0);
    EXPECT_LT(1.96 * rms_N, 1.25 * band_N);
  }
}

TEST_F(RunCommand, AProgramThatTheDriveCannotFollowIsNamed) {
  fit();
  const std::string line = written("line.ngc", "F1200 G1 X5\nF12000 G1 X60\nM2\n");
  EXPECT_EQ(run("run " + line + " --dry-run --model " + kModel).exit_code, 0);
  std::ifstream in(kModel);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string weak = written("weak.toml", text + "\n[[effect]]\nkind = \"current_saturation\"\nlimit_A = 9.0\n");
  const ProgramRun refused =
      run("run " + line + " --dry-run --json " + file("dry.json") + " --model " + weak + " " + kModel);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("line.ngc:2: x needs"));
  std::ifstream told(file("dry.json"));
  EXPECT_GT(nlohmann::json::parse(told)["commands"][0]["share"], 1.0);
  EXPECT_EQ(run("run " + line + " --dry-run --model " + kModel + " " + kModel + " " + kModel).exit_code, 2);
}

TEST_F(RunCommand, AProgramBeyondTheTravelIsRefusedBeforeAnythingMoves) {
  fit();
  const ProgramRun refused = run("run " + written("far.ngc", "F6000 G1 X10\nX95\nM2\n") + " --yes");
  EXPECT_EQ(refused.exit_code, 8);
  EXPECT_THAT(refused.output, HasSubstr("far.ngc:2: x = 95"));
  EXPECT_THAT(run("info").output, testing::Not(HasSubstr("enabled")));
}

/// Runs a circle of 44 s in a separate process and sends it a signal after the axis has begun to move (on a busy
/// computer this time is unknown). Returns the exit code or, negative, the signal that ended it.
int signalled_on_the_circle(const SimulatedBoardProcess& board, const std::string& program, const std::string& more,
                            int signal) {
  Child process = board.start("run " + program + more);
  EXPECT_TRUE(wait_until([&board] { return board.moves(); }));
  return process.end(signal);
}

TEST_F(RunCommand, AnInterruptStopsOnThePath) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  fit();
  const std::string circle = written("circle.ngc", "F300 G3 X0 Y0 I35 J0\nM2\n");
  EXPECT_EQ(signalled_on_the_circle(board_, circle, " --yes --json " + file("run.json"), SIGINT), 1);
  std::ifstream in(file("run.json"));
  const auto told = nlohmann::json::parse(in);
  EXPECT_EQ(told["stopped_because"], "interrupted");
  EXPECT_LT(told["duration_s"], 40.0);
  EXPECT_LT(told["contour_um"], 12.0) << "also while it stops";
}

/// Runs a program on a pseudo-terminal and types keys.
class OnTerminal {
 public:
  explicit OnTerminal(const std::string& command) {
    process_ = ::forkpty(&keyboard_, nullptr, nullptr, nullptr);
    if (process_ != 0) return;
    ::execl("/bin/sh", "sh", "-c", ("exec " + command + " > /dev/null 2>&1").c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;
  ~OnTerminal() {
    if (process_ > 0) ::kill(process_, SIGKILL);
    ::close(keyboard_);
  }
  bool type(const std::string& keys) const {
    return ::write(keyboard_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size());
  }
  int wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  int keyboard_ = -1;
  pid_t process_ = -1;
};

/// Keys change the speed of a running path: feeds and rapids separately, never beyond the plan.
TEST_F(RunCommand, KeysOverrideFeedsAndRapidsWhileItRuns) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  fit();
  const std::string circle = written("circle.ngc", "F3000 G3 X0 Y0 I35 J0\nM2\n");  // 220 mm at 50 mm/s
  /// Duration relative to the plan.
  const auto duration = [&](const std::string& keys) {
    OnTerminal terminal("\"" AXISTOOL_PROGRAM "\" run" + board_.device() + circle + " --yes --json " +
                        file("run.json") + " --capture " + file("run.csv"));
    EXPECT_TRUE(wait_until([this] { return board_.moves(); }));
    EXPECT_TRUE(terminal.type(keys));
    EXPECT_EQ(terminal.wait(), 0);
    std::ifstream in(file("run.json"));
    const auto told = nlohmann::json::parse(in);
    EXPECT_LT(told["contour_um"], 12.0) << "the axes stay on the path at any speed";
    return host::read_record(file("run.csv")).t_s.back() / told["planned_s"].get<double>();
  };
  EXPECT_NEAR(duration("+++<<<<<<<<<<>"), 1.0, 0.05) << "feeds stay at the planned speed, and the program has no rapid";
  const double slowed = duration("-----");
  EXPECT_GT(slowed, 1.2);
  EXPECT_LT(slowed, 2.05);
}

/// The path stops during a feed hold, but the time of the hold counts.
TEST_F(RunCommand, TheClockGoesOnWhileTheFeedIsHeld) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  fit();
  const std::string circle = written("circle.ngc", "F6000 G3 X0 Y0 I35 J0\nM2\n");  // 2.3 s
  Child process = board_.start("run " + circle + " --yes --json " + file("run.json"));
  ASSERT_TRUE(wait_until([this] { return board_.moves(); }));
  process.signal(SIGTSTP);
  ASSERT_TRUE(wait_until([this] { return !board_.moves(); }));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  process.signal(SIGTSTP);
  EXPECT_EQ(process.wait(), 0);
  std::ifstream in(file("run.json"));
  const auto told = nlohmann::json::parse(in);
  EXPECT_NEAR(told["duration_s"], told["planned_s"].get<double>(), 0.01) << "of the path";
  EXPECT_GT(told["clock_s"], told["duration_s"].get<double>() + 1.0);
}

/// A machine with walls on both sides in x and none in y.
class ProbingCommand : public RunCommand {
 protected:
  ProbingCommand() : RunCommand({"--probe", "x=20.0007", "--probe", "x=-20.0007"}) {}

  void fit_probe() const {
    fit();
    ASSERT_EQ(run("set-params probe.input=1").exit_code, 0);
  }
  nlohmann::json told(const std::string& program, int exit_code = 0) const {
    const ProgramRun done = run("run " + written("probe.ngc", program) + " --yes --json -", "2>/dev/null");
    EXPECT_EQ(done.exit_code, exit_code) << program << done.output;
    return nlohmann::json::parse(done.output, nullptr, false);
  }
  /// Position of the encoder count at the wall.
  static double at_count(double mm) { return std::floor(mm / kCount_mm) * kCount_mm; }

  static constexpr double kCount_mm = 10.0 / 4096.0;
};

TEST_F(ProbingCommand, MeasuresWhereItTouchesAndGoesOnFromThere) {
  fit_probe();
  const auto both =
      told("F600\nG38.2 X40\nG91\nG38.4 X-5\nG90\nG0 X0\nG38.3 X-40\nG38.5 X0\nG38.3 Y10\nG1 X0 Y0\nM2\n");
  EXPECT_EQ(both["stopped_because"], "completed");
  const auto& probes = both["probes"];
  ASSERT_EQ(probes.size(), 5u);
  const double expected[] = {20.0007, 20.0007, -20.0007, -20.0007};
  const char* words[] = {"G38.2", "G38.4", "G38.3", "G38.5", "G38.3"};
  const int lines[] = {2, 4, 7, 8, 9};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(probes[k]["word"], words[k]);
    EXPECT_EQ(probes[k]["line"], lines[k]);
    EXPECT_EQ(probes[k]["found"], k < 4);
    if (k < 4)
      EXPECT_NEAR(probes[k]["position_mm"]["x"], at_count(expected[k]), 1e-6) << k;
    else
      EXPECT_TRUE(probes[k]["position_mm"].is_null());
  }
  const ProgramRun text = run("run " + written("one.ngc", "F600\nG38.2 X40\nG0 X0\n") + " --yes");
  EXPECT_EQ(text.exit_code, 0) << text.output;
  EXPECT_THAT(text.output, HasSubstr("line 2: contact at x 20.0000 mm, y"));
}

/// The parts of a program and the rests between them give one record.
TEST_F(ProbingCommand, IsCapturedFromBeginningToEnd) {
  fit_probe();
  const std::string program =
      written("probe.ngc", "F600\nG38.2 X40\nG91\nG38.4 X-5\nG90\nG0 X0\nG38.3 X-40\nG0 X0\nM2\n");
  const ProgramRun done = run("run " + program + " --yes --json - --capture " + file("p.csv"), "2>/dev/null");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const auto told = nlohmann::json::parse(done.output);
  const host::Record record = host::read_record(file("p.csv"));
  // Beyond each edge by the stopping distance.
  const double right_mm = told["probes"][0]["position_mm"]["x"], left_mm = told["probes"][2]["position_mm"]["x"];
  const auto [least, most] = std::minmax_element(record.x.begin(), record.x.end());
  EXPECT_GT(*most, right_mm);
  EXPECT_LT(*most, right_mm + 2.0);
  EXPECT_LT(*least, left_mm);
  EXPECT_GT(*least, left_mm - 2.0);
  EXPECT_NEAR(record.x.back(), 0.0, 0.02);
  EXPECT_EQ(told["lost_rows"], 0);
  double longest_step_s = 0.0, farthest_step_mm = 0.0;
  for (std::size_t k = 1; k < record.t_s.size(); ++k) {
    longest_step_s = std::max(longest_step_s, record.t_s[k] - record.t_s[k - 1]);
    farthest_step_mm = std::max(farthest_step_mm, std::abs(record.x[k] - record.x[k - 1]));
  }
  EXPECT_NEAR(longest_step_s, record.sample_period_s, 1e-6);
  EXPECT_LT(farthest_step_mm, 0.3) << "250 mm/s at most";
  EXPECT_LT(told["contour_um"], 12.0) << "each part is compared with its own path";
}

TEST_F(ProbingCommand, WithoutContactTheStrictFormsFail) {
  fit_probe();
  const ProgramRun none = run("run " + written("none.ngc", "F600\nG38.2 X15\nG0 X0\n") + " --yes");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.output, HasSubstr("none.ngc:2: G38.2 ended without contact"));
  const auto json = told("F600\nG38.2 X14\nG0 X0\n", 1);
  EXPECT_EQ(json["stopped_because"], "probe");
  EXPECT_EQ(json["probes"][0]["found"], false);
  ASSERT_EQ(told("F600\nG38.2 X30\n")["probes"][0]["found"], true);
  const ProgramRun still = run("run " + written("still.ngc", "F600\nG91 G38.4 X1\n") + " --yes");
  EXPECT_EQ(still.exit_code, 1);
  EXPECT_THAT(still.output, HasSubstr("G38.4 ended without loss of contact"));
  EXPECT_EQ(told("F600\nG91 G38.5 X1\nG90 G38.4 X0\nG38.3 X5\nG0 X0\n")["stopped_because"], "completed");
}

TEST_F(ProbingCommand, WhatIsThereAlreadyEndsTheLenientFormsAtOnce) {
  fit_probe();
  const auto probes = told("F600\nG38.2 X40\nG38.3 X45\nG91 G38.4 X-5\nG38.5 X-1\nM2\n")["probes"];
  ASSERT_EQ(probes.size(), 4u);
  for (const auto& probe : probes) EXPECT_EQ(probe["found"], true);
  // Position at rest: past the edge by the stopping distance.
  EXPECT_GT(probes[1]["position_mm"]["x"], probes[0]["position_mm"]["x"]);
  EXPECT_LT(probes[1]["position_mm"]["x"], 22.0);
  EXPECT_LT(probes[3]["position_mm"]["x"], probes[2]["position_mm"]["x"]);
  const ProgramRun strict = run("run " + written("strict.ngc", "F600\nG38.2 X40\nG38.2 X45\n") + " --yes");
  EXPECT_EQ(strict.exit_code, 8) << strict.output;
}

TEST_F(ProbingCommand, RefusesWhatCannotBeProbed) {
  fit();
  const auto refused = [this](const std::string& program, const std::string& cause) {
    const ProgramRun done = run("run " + written("refused.ngc", program) + " --yes");
    EXPECT_EQ(done.exit_code, 8) << done.output;
    EXPECT_THAT(done.output, HasSubstr(cause));
  };
  const std::string program = "F600\nG38.2 X40\n";
  refused(program, "probes in line 2, but no probe is wired");
  ASSERT_EQ(run("set-params probe.input=1").exit_code, 0);
  EXPECT_THAT(run("info").output, HasSubstr("probe        not in contact"));
  refused("F600\nG38.4 X5\n", "not in contact before the one away");
  ASSERT_EQ(told(program)["probes"][0]["found"], true);
  EXPECT_THAT(run("info").output, HasSubstr("probe        in contact"));
  refused("F600\nG38.2 X40\n", "in contact before the move towards it");
}

TEST_F(ProbingCommand, JogMoveAndHomingIntoAWallAreStoppedAndNamed) {
  fit_probe();
  ASSERT_EQ(run("set-params x.homing.mode=1 x.homing.velocity=20 x.homing.travel=80").exit_code, 0);
  ASSERT_EQ(run("enable x --yes").exit_code, 0);
  for (const std::string into : {"jog x 40 --for 60", "move x 60 --relative", "home x"}) {
    const ProgramRun done = run(into + " --json " + file("motion.json"));
    EXPECT_EQ(done.exit_code, 1) << into;
    EXPECT_THAT(done.output, HasSubstr("the touch probe made contact")) << into;
    std::ifstream in(file("motion.json"));
    EXPECT_NE(nlohmann::json::parse(in)["command"], nullptr);
    const ProgramRun away = run("jog x -30 --for 0.8");
    EXPECT_EQ(away.exit_code, 0) << into << away.output;
  }
}

TEST_F(ProbingCommand, ARapidIntoAWallIsStoppedAndNamed) {
  fit_probe();
  const ProgramRun done = run("run " + written("rapid.ngc", "G0 X60\nG0 X0\n") + " --yes --json " + file("run.json"));
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.output, HasSubstr("the probe made contact while the program did not probe"));
  std::ifstream in(file("run.json"));
  EXPECT_EQ(nlohmann::json::parse(in)["stopped_because"], "unexpected contact");
  const ProgramRun back = run("run " + written("back.ngc", "G0 X0\n") + " --yes");
  EXPECT_EQ(back.exit_code, 0) << back.output << "away from it again, once it is at rest";
}

/// If the program is killed, the board stops by itself and reports why.
TEST_F(RunCommand, AKilledHostIsNamed) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  fit();
  ASSERT_EQ(run("set-params host.timeout=1").exit_code, 0);
  const std::string circle = written("circle.ngc", "F300 G3 X0 Y0 I35 J0\nM2\n");
  EXPECT_EQ(signalled_on_the_circle(board_, circle, " --yes", SIGKILL), -SIGKILL);
  EXPECT_TRUE(wait_until([&] { return run("faults").output.find("host_heartbeat_lost") != std::string::npos; }));
}

TEST(RunAlone, AProgramIsJudgedBeforeAMachineIsAskedFor) {
  TemporaryFolder folder;
  std::ofstream(folder.path("bad.ngc")) << "G21\nG41 X10\n";
  const ProgramRun bad = run_axistool("run " + folder.path("bad.ngc") + " --device socket:/nowhere");
  EXPECT_EQ(bad.exit_code, 9);
  EXPECT_THAT(bad.output, HasSubstr("bad.ngc:2: G41"));
}

TEST(RunAlone, ADryRunNeedsNoBoard) {
  TemporaryFolder folder;
  std::ofstream(folder.path("p.toml")) << "format = \"axis-params/1\"\n[x.limits]\nacceleration = 500.0\n[y.limits]\n"
                                          "acceleration = 500.0\n";
  const ProgramRun dry = run_axistool("run " + kPrograms + "square.ngc --dry-run --params " + folder.path("p.toml"));
  EXPECT_EQ(dry.exit_code, 0) << dry.output;
  EXPECT_THAT(dry.output, HasSubstr("x 0.000 to 40.000 mm, y 0.000 to 40.000 mm"));
  EXPECT_THAT(dry.output, HasSubstr("the command that y needs is unknown"));
}

}  // namespace
