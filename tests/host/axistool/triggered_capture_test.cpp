// axistool capture with a trigger that the board detects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/record/read_record.hpp"
#include "tests/host/axistool/simulated_board.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

class BoardTrigger : public testing::Test {
 protected:
  std::string file(const char* name) const { return folder_.path(name); }
  ProgramRun run(const std::string& command) const { return board_.run(command, "2>/dev/null"); }

  /// Runs the command, which waits for its trigger, while the axis jogs.
  nlohmann::json capture_while_jogging(const std::string& options) const {
    auto capture =
        std::async(std::launch::async, [&] { return run("capture -o " + file("c.csv") + " --json - " + options); });
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    do {  // again if the capture started too late
      EXPECT_EQ(run("jog x 30 --for 0.5").exit_code, 0);
      if (capture.wait_for(std::chrono::seconds(2)) == std::future_status::ready) break;
      EXPECT_EQ(run("jog x -30 --for 0.5").exit_code, 0);
    } while (capture.wait_for(std::chrono::seconds(0)) != std::future_status::ready);
    const ProgramRun done = capture.get();
    EXPECT_EQ(done.exit_code, 0) << done.output;
    return nlohmann::json::parse(done.output, nullptr, false);
  }

  TemporaryFolder folder_;
  SimulatedBoardProcess board_{folder_.path(""), {"--x", kCase + "/model.toml"}};
};

TEST_F(BoardTrigger, CatchesTheFirstSampleOfAMotionWithWhatWasBefore) {
  ASSERT_EQ(run_axistool("design " + kCase + "/model.toml -o " + file("params.toml")).exit_code, 0);
  ASSERT_EQ(run("set-params " + file("params.toml") + " host.timeout=5").exit_code, 0);
  ASSERT_EQ(run("enable x --yes").exit_code, 0);
  const nlohmann::json told = capture_while_jogging("--trigger x.motion --pre 50ms --for 0.2");
  EXPECT_EQ(told["rows"], 250);
  EXPECT_DOUBLE_EQ(told["trigger_s"].get<double>(), 0.05);
  const host::Record record = host::read_record(file("c.csv"));
  ASSERT_EQ(record.size(), 250u);
  EXPECT_EQ(record.w_ref[49], 0.0);
  EXPECT_GT(record.w_ref[50], 0.0);
  EXPECT_EQ(record.header.at("trigger_s"), "0.05");
  const nlohmann::json crossing = capture_while_jogging("--trigger 'x.position > 20mm' --pre 20ms --for 0.05");
  EXPECT_EQ(crossing["rows"], 70);
  const host::Record passage = host::read_record(file("c.csv"));
  EXPECT_LE(passage.x[19], 20.0);
  EXPECT_GT(passage.x[20], 20.0);
  EXPECT_NEAR(passage.x_ref[20], passage.x[20], 0.5) << "the reference is continued from its low half";
  ASSERT_EQ(run("capture --last -o " + file("again.csv")).exit_code, 0);
  EXPECT_EQ(host::read_record(file("again.csv")).x, passage.x);
}

TEST_F(BoardTrigger, SaysWhatIsWrongWithAnEvent) {
  const auto failure = [&](const std::string& trigger) {
    return board_.run("capture -o " + file("c.csv") + " --wait 0.1 --trigger '" + trigger + "'");
  };
  EXPECT_THAT(failure("x.positon_error > 20um").output, HasSubstr("position_error"));
  EXPECT_EQ(failure("x.position_error > 20kg").exit_code, 2);
  EXPECT_EQ(failure("x.position_error > 20").exit_code, 2) << "20 of what?";
  EXPECT_EQ(failure("any.motion").exit_code, 2);
  EXPECT_EQ(failure("x.position_error > 20um").exit_code, 7) << "it does not come";
  EXPECT_EQ(board_.run("capture --last -o " + file("c.csv")).exit_code, 8) << "there is none";
}

}  // namespace
