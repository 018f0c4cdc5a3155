// Stopping distances without current, compared with the free distance.
#include "host/commission/stopping_room.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "host/exit_codes.hpp"

namespace {

using testing::HasSubstr;

/// J 0.010 kg m^2 on the paper's screw, Coulomb 0.2 Nm: 981.7 mm from 250 mm/s (README, "The board").
constexpr host::StoppingFigures kLight{
    .inertia = 0.010, .friction = 0.2, .lead = 1.5915, .deceleration = 2000.0, .jerk = 50000.0};

std::string refusal(const host::StoppingFigures& axis, double speed, double overtravel) {
  try {
    host::check_stopping_room(axis, speed, overtravel, "mm");
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
    return failure.what();
  }
  return "";
}

TEST(StoppingRoom, IsTheLongerOfBothWays) {
  EXPECT_EQ(refusal(kLight, 250.0, 985.0), "");
  const std::string refused = refusal(kLight, 250.0, 100.0);
  EXPECT_THAT(refused, HasSubstr("moves on for 982 mm"));
  EXPECT_THAT(refused, HasSubstr("Only 100 mm are free"));
  EXPECT_THAT(refused, HasSubstr("speed=79.8 in --box")) << "v^2 J / (2 r T) = 100 mm";
  host::StoppingFigures rough = kLight;
  rough.friction =
      20.0;  // without current it stops in 10 mm, and along the ramp in v^2 / (2 a) + v a / (2 j) = 20.6 mm
  EXPECT_EQ(refusal(rough, 250.0, 21.0), "");
  EXPECT_THAT(refusal(rough, 250.0, 20.0), HasSubstr("within 20.6 mm along its ramp"));
}

TEST(StoppingRoom, TheSpeedThatItNamesWouldDoAndALittleMoreWouldNot) {
  for (const double room : {0.5, 5.0, 20.0, 300.0}) {
    for (const double friction : {0.2, 2.0, 20.0}) {
      host::StoppingFigures axis = kLight;
      axis.friction = friction;
      const double speed = host::fastest_within(axis, room);
      EXPECT_EQ(refusal(axis, 0.999 * speed, room), "") << room << ", " << friction;
      EXPECT_NE(refusal(axis, 1.001 * speed, room), "") << room << ", " << friction;
    }
  }
}

TEST(StoppingRoom, AnAxisThatFallsIsRefusedAtAnySpeedUnlessABrakeCatchesItInTime) {
  host::StoppingFigures hanging = kLight;
  hanging.weight = 1.0;
  EXPECT_THAT(refusal(hanging, 100.0, 1e6), HasSubstr("does not stop by itself"));
  EXPECT_THAT(refusal(hanging, 100.0, 1e6), testing::Not(HasSubstr("speed=")));
  hanging.brake = true;
  hanging.brake_time_s = 0.1;
  hanging.brake_effort = 20.0;
  EXPECT_EQ(refusal(hanging, 100.0, 30.0), "");
  EXPECT_NE(refusal(hanging, 100.0, 10.0), "");
}

/// 1 Nm of weight against 0.2 Nm of friction.
TEST(FeedbackAtRest, AnAxisThatFallsMustNoticeADeadEncoder) {
  host::StoppingFigures hanging = kLight;
  hanging.weight = 1.0;
  EXPECT_NO_THROW(host::check_feedback_at_rest(hanging, true));
  EXPECT_NO_THROW(host::check_feedback_at_rest(kLight, false)) << "it stays where it is";
  for (const bool brake : {false, true}) {
    hanging.brake = brake;
    try {
      host::check_feedback_at_rest(hanging, false);
      ADD_FAILURE() << "accepted";
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::refused);
      EXPECT_THAT(failure.what(), HasSubstr("encoder.fault_input"));
    }
  }
}

TEST(StoppingRoom, WithoutAnOvertravelNothingIsRefusedButTheWayIsTold) {
  const std::string said = host::check_stopping_room(kLight, 250.0, {}, "mm");
  EXPECT_THAT(said, HasSubstr("moves on for 982 mm"));
  EXPECT_THAT(said, HasSubstr("--overtravel"));
}

}  // namespace
