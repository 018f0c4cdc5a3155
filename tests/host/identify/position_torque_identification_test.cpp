// Axes on which gravity, a spring or the drag of a fluid is larger than friction. Motions and torques are in closed
// form, without a simulator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/evidence/measurement_gate.hpp"
#include "host/identify/identification.hpp"
#include "host/model/model_file.hpp"
#include "tests/host/effort/made_effort.hpp"

namespace {

using testing::Contains;
using testing::HasSubstr;

template <typename Motion, typename Further>
host::Identification identified(Motion motion, Further further) {
  const sim::DriveDescription drive = motor();
  sim::DriveDescription sheet = drive;
  sheet.effects.clear();
  const auto measured = host::MeasurementGate(sheet).admit({record_of(motion, further, 0.0, 20.0, 6)});
  return host::identify_drive(measured, sheet, host::IdentificationMethod::unbiased_ls);
}

/// The model as the next command reads it from the file of this command.
sim::DriveDescription read_again(const host::Identification& found) {
  return host::parse_model(host::format_model(found.model), "model.toml");
}

/// Turns and swings with many accelerations at every position.
Point lively(double t_s) {
  Point sum{0.0, 0.0, 0.0};
  for (const auto& [amplitude, hertz] : {std::pair(1.0, 0.31), {0.4, 0.83}, {0.12, 2.3}}) {
    const double omega = kTurn * hertz;
    sum.x += amplitude * std::sin(omega * t_s);
    sum.w += amplitude * omega * std::cos(omega * t_s);
    sum.a -= amplitude * omega * omega * std::sin(omega * t_s);
  }
  return sum;
}

// Without the curve over the travel, the weight would make the inertia arbitrary.
TEST(PositionTorque, AWeightOnAnArmDoesNotBendTheInertia) {
  const host::Identification found = identified(lively, [](const Point& at) { return 0.12 * std::sin(at.x + 0.3); });
  EXPECT_TRUE(found.beside_travel);
  EXPECT_NEAR(found.estimate.inertia.value, kInertia, 0.05 * kInertia);
  EXPECT_NEAR(found.estimate.viscous.value, kViscous, 0.1 * kViscous);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("depends on position")));
  EXPECT_EQ(read_again(found).find("inertia")->at("J"), found.model.find("inertia")->at("J"));
}

TEST(PositionTorque, WhereNothingGoesWithThePositionNoCurveIsDrawn) {
  const host::Identification found = identified(lively, [](const Point&) { return 0.0; });
  EXPECT_FALSE(found.beside_travel);
  EXPECT_NEAR(found.estimate.inertia.value, kInertia, 0.02 * kInertia);
}

// A vertical axis needs upward torque in both directions, which no friction level can have.
TEST(PositionTorque, AWeightBeyondFrictionLeavesAModelThatCanBeRead) {
  constexpr double kWeight = 2.5 * kCoulomb;
  const host::Identification found = identified(lively, [](const Point&) { return kWeight; });
  ASSERT_TRUE(found.estimate.negative.has_value());
  EXPECT_NEAR(found.estimate.negative->value, kWeight - kCoulomb, 0.1 * kCoulomb)
      << "the estimate itself is not changed";
  const sim::DriveDescription model = read_again(found);
  EXPECT_NEAR(model.find("coulomb")->at("level"), kCoulomb, 0.05 * kCoulomb);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("friction cannot drive the axis")));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("constant_torque")));
}

// Drag with the square of the speed tilts the fitted line so much that its level has the wrong sign in both directions.
TEST(PositionTorque, ADragThatSteepensLeavesAModelThatCanBeRead) {
  const auto fast = [](double t_s) {
    const Point at = lively(t_s);
    return Point{20.0 * at.x, 20.0 * at.w, 20.0 * at.a};
  };
  const host::Identification found =
      identified(fast, [](const Point& at) { return 2e-5 * at.w * std::abs(at.w) - std::copysign(kCoulomb, at.w); });
  ASSERT_TRUE(found.estimate.positive.has_value());
  ASSERT_LT(found.estimate.positive->value, 0.0);
  EXPECT_EQ(read_again(found).find("coulomb")->at("level"), 0.0);
}

}  // namespace
