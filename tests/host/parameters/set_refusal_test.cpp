// Sets that must not close a loop are refused, with the relation and the poles in words.
#include "host/parameters/set_refusal.hpp"

#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/parameters/parameter_file.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace {

/// What is said of the paper's x axis after a change; "" where it is accepted.
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

TEST(SetRefusal, ASlowerVelocityLimitNeedsNoOtherMonitors) {
  for (const double velocity : {1.0, 5.0, 50.0})
    EXPECT_EQ(said_after({{"x.limits.velocity", velocity}}), "") << velocity;
}

}  // namespace
