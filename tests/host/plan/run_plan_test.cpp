// A planned run as a file, and its execution by an axis.
#include "host/plan/run_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/plan/information.hpp"

namespace {

using testing::HasSubstr;

host::RunPlan some_run() {
  host::RunPlan run;
  run.pieces = {{"steps", {{3.25, -3.25}, {{"hold", 0.1}}}, "", 1.5, 1},
                {"multisine", {{}, {{"amplitude", 1.0 / 3.0}, {"ride", 20.0}}}, "output", 2.0, 7}};
  run.box = {40.0, 150.0, 3.5, 10.0};
  run.rivals = {"cogging", "backlash + input_delay"};
  run.expected_odds = 12.5;
  return run;
}

TEST(RunPlan, ComesBackFromItsFile) {
  const host::RunPlan run = some_run(), read = host::parse_run_plan(host::run_plan_toml(run), "run.toml");
  EXPECT_EQ(host::run_plan_toml(read), host::run_plan_toml(run));
  ASSERT_EQ(read.pieces.size(), 2U);
  EXPECT_EQ(read.pieces[0].numbers.list, run.pieces[0].numbers.list);
  EXPECT_EQ(read.pieces[1].numbers.named, run.pieces[1].numbers.named);
  EXPECT_EQ(read.pieces[1].closed_loop, "output");
  EXPECT_EQ(read.pieces[1].seed, 7U);
  EXPECT_EQ(read.rivals, run.rivals);
  EXPECT_EQ(read.box.volts, 3.5);
}

std::string complaint(const std::string& text) {
  try {
    host::parse_run_plan(text, "run.toml");
  } catch (const host::Failure& failure) {
    return failure.what();
  }
  return "";
}

TEST(RunPlan, NamesWhatIsWrongWithAFile) {
  const std::string good = host::run_plan_toml(some_run());
  const auto with = [&](const std::string& old, const std::string& other) {
    std::string text = good;
    return text.replace(text.find(old), old.size(), other);
  };
  EXPECT_THAT(complaint(with("axis-run-plan/1", "axis-model/1")), HasSubstr("axistool plan"));
  EXPECT_THAT(complaint(with("travel = 40.0", "travel = -1.0")), HasSubstr("above 0"));
  EXPECT_THAT(complaint(with("time_s = 1.5", "time_s = 15.0")), HasSubstr("more than the box's time"));
  EXPECT_THAT(complaint(with("kind = ", "kidn = ")), HasSubstr("kind"));
  EXPECT_THAT(complaint(with("values = [3.25", "values = [\"a\"")), HasSubstr("number"));
  EXPECT_THAT(complaint(with("[box]", "bax = 1\n[box]")), HasSubstr("bax"));
}

/// The window of a piece that does not begin in the middle is the remaining range on both sides.
TEST(RunPlan, KeepsAPieceWithinTheBoxOfTheWholeRun) {
  host::ExcitationScale scale;
  scale.encoder_resolution = 0.001;
  scale.dac_resolution_V = 0.001;
  scale.lead = 1.0;
  scale.rate_Hz = 1000.0;
  const host::RunPlan run = some_run();
  EXPECT_EQ(host::design_piece(run.pieces[0], run.box, 0.0, scale).request.travel_counts, 20000);
  EXPECT_EQ(host::design_piece(run.pieces[0], run.box, -15.0, scale).request.travel_counts, 5000);
  EXPECT_EQ(host::design_piece(run.pieces[0], run.box, 0.0, scale).request.samples, 1500U);
  EXPECT_THROW(host::design_piece(run.pieces[0], run.box, 20.5, scale), host::Failure);
}

/// Error of a rival that is refitted as far as the training records allow; computed by hand for one parameter.
TEST(Information, IsWhatIsLeftAfterTheRivalHasBent) {
  const host::Information known{Eigen::MatrixXd::Constant(1, 1, 3.0), Eigen::VectorXd::Zero(1), 0.0};
  host::Information seen{Eigen::MatrixXd::Constant(1, 1, 1.0), Eigen::VectorXd::Constant(1, -6.0), 36.0};
  seen += known;  // the minimum of (6 - d)^2 + 3 d^2 is 27, at d = 1.5
  EXPECT_NEAR(seen.least(), 27.0, 0.1);
}

}  // namespace
