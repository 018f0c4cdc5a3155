// Sets of parameters that must not close a loop are refused, with the relation and the poles in the message.
#include "host/parameters/set_refusal.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "host/exit_codes.hpp"
#include "host/parameters/parameter_file.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace {

/// The refusal of the paper's x axis after a change; "" if it is accepted.
std::string said_after(std::initializer_list<std::pair<const char*, double>> changes) {
  auto values = firmware_test::paper_values();
  for (const auto& [name, value] : changes) firmware_test::set(values, name, value);
  try {
    host::require_fitting_set(values);
  } catch (const host::Failure& error) {
    return error.what();
  }
  return "";
}
bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(SetRefusal, ASoundSetIsAccepted) { EXPECT_EQ(said_after({}), ""); }

TEST(SetRefusal, NamesThePolesOfAnEstimatorThatLooksAtNothing) {
  const std::string said = said_after({{"x.kalman.k11", 0},
                                       {"x.kalman.k12", 0},
                                       {"x.kalman.k21", 0},
                                       {"x.kalman.k22", 0},
                                       {"x.kalman.k31", 0},
                                       {"x.kalman.k32", 0}});
  EXPECT_TRUE(says(said, "unstable") && says(said, "x.kalman.k11") && says(said, "poles are")) << said;
  EXPECT_TRUE(says(said, "0.9974")) << "the drive's own pole: " << said;
}

TEST(SetRefusal, NamesThePolesOfALoopThatRings) {
  const std::string said = said_after({{"x.feedback.k2", 1.95 / firmware_test::kPaperX.Bd2}});
  EXPECT_TRUE(says(said, "undamped") && says(said, "feedback.k2") && says(said, "-0.9")) << said;
}

TEST(SetRefusal, MonitorsThatWouldNotProtectAreRefusedWithTheirCeiling) {
  EXPECT_TRUE(says(said_after({{"x.monitor.following_error", 50}}), "would not protect"));
  EXPECT_TRUE(says(said_after({{"x.monitor.following_error_per_speed", 1}}), "would not protect"));
  EXPECT_TRUE(
      says(said_after({{"x.monitor.disagreement", 500}, {"x.monitor.encoder_jump", 600}}), "would not protect"));
  EXPECT_TRUE(says(said_after({{"x.monitor.encoder_jump", 1000}}), "would not protect"));
  EXPECT_TRUE(says(said_after({{"x.monitor.overspeed", 5000}}), "would not protect"));
  EXPECT_TRUE(says(said_after({{"x.monitor.polarity_command", 9.5}}), "9 V"));
  EXPECT_TRUE(says(said_after({{"x.monitor.oscillation", 8}}), "7 V"));
  EXPECT_TRUE(says(said_after({{"x.monitor.saturation_time", 2}}), "would not protect"));
}

/// The number that follows `before`.
double figure_after(const std::string& text, const std::string& before) {
  const std::size_t at = text.find(before);
  return at == std::string::npos ? -1.0 : std::strtod(text.c_str() + at + before.size(), nullptr);
}

/// With a smaller lead the same limit is a higher shaft speed: the message states the relation with correct values.
TEST(SetRefusal, WhatWouldFitIsSaidAndFits) {
  const std::string said = said_after({{"x.drive.lead", 0.1}});
  EXPECT_TRUE(says(said, "limits.velocity / drive.lead = 250 / 0.1 = 2500")) << said;
  const double above = figure_after(said, "more, ") > 0 ? figure_after(said, ": above ") : -1.0;
  const double slower = figure_after(said, "limits.velocity below ");
  ASSERT_GT(above, 2500.0) << said;
  ASSERT_GT(slower, 0.0) << said;
  EXPECT_TRUE(says(said_after({{"x.drive.lead", 0.1}, {"x.monitor.overspeed", 0.999 * above}}), "monitor.overspeed"));
  EXPECT_FALSE(says(said_after({{"x.drive.lead", 0.1}, {"x.monitor.overspeed", 1.001 * above}}), "monitor.overspeed"));
  EXPECT_FALSE(says(said_after({{"x.drive.lead", 0.1}, {"x.limits.velocity", 0.99 * slower}}), "monitor.overspeed"));
}

TEST(SetRefusal, TheCeilingsThatAreSaidAreThoseThatHold) {
  for (const char* name : {"x.monitor.overspeed", "x.monitor.following_error"}) {
    const double most = figure_after(said_after({{name, 9000}}), "at most ");
    ASSERT_GT(most, 0.0) << name;
    EXPECT_EQ(said_after({{name, 0.999 * most}}), "") << name;
    EXPECT_NE(said_after({{name, 1.001 * most}}), "") << name;
  }
}

/// Catches a weight that sinks undetected: the encoder is dead and no motion is commanded.
TEST(SetRefusal, ABrakeNeedsFeedbackAtRest) {
  const std::string said = said_after({{"x.brake.fitted", 1}, {"x.tachometer.fitted", 0}, {"x.kalman.k12", 0}});
  EXPECT_TRUE(says(said, "x.brake.fitted")) << said;
  EXPECT_TRUE(says(said, "fit one")) << said;
  EXPECT_EQ(said_after({{"x.brake.fitted", 1}}), "");
  EXPECT_EQ(said_after(
                {{"x.brake.fitted", 1}, {"x.tachometer.fitted", 0}, {"x.kalman.k12", 0}, {"x.encoder.fault_input", 1}}),
            "");
}

TEST(SetRefusal, ASlowerVelocityLimitNeedsNoOtherMonitors) {
  for (const double velocity : {1.0, 5.0, 50.0})
    EXPECT_EQ(said_after({{"x.limits.velocity", velocity}}), "") << velocity;
}

}  // namespace
