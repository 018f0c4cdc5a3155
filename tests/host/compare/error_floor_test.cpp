// The error of the best possible model.
#include "host/compare/error_floor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host/compare/comparison.hpp"
#include "tests/host/effort/made_effort.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

/// During a fit, the model may have static friction that no drive overcomes, or an oscillating second mass.
TEST(ErrorFloor, OfAModelThatRunsAwayIsANumber) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = HandMade::model();
  model.effects.push_back({"stribeck", {{"static", 3000.0}, {"omega1", 0.19}, {"omega2", 0.19}}, {}, {}});
  model.effects.push_back(
      {"compliance", {{"resonance", 60.0}, {"damping_ratio", 0.02}, {"load_fraction", 0.5}}, {}, {}});
  const host::PreparedRecord prepared = host::prepare(record, model);
  host::ErrorFloor floor;
  host::renew_floor(floor, model, sim::Drive(model), prepared, 1);
  ASSERT_EQ(floor.x.size(), prepared.windows.size());
  for (const double value : floor.x) EXPECT_TRUE(std::isfinite(value) && value > 0.0) << value;
}

/// The motor of the made records, with all of its effects.
sim::DriveDescription complete_motor() {
  sim::DriveDescription model = motor();
  model.find("inertia")->parameters["J"] = kInertia;
  model.find("viscous")->parameters["B"] = kViscous;
  model.find("coulomb")->parameters["level"] = kCoulomb;
  return model;
}

// Noise of the current moves a light rotor far within a window. If it were ignored, a complete model would seem wrong
// by a factor.
TEST(ErrorFloor, HoldsTheNoiseOfAMeasuredCurrent) {
  const auto nothing = [](const Point&) { return 0.0; };
  const host::Record record = record_of(slow_turning, nothing, 0.0, 20.0, 3);
  const sim::DriveDescription model = complete_motor();
  const host::RecordSet set = host::compare_on({&record}, model);
  // Noise of 0.01 A, and steps of 0.002 A.
  EXPECT_NEAR(set.records.front().prepared.effort_noise, 0.01 * kPerAmpere, 0.1 * 0.01 * kPerAmpere);
  const double error = host::error_of(sim::Drive(model), set).combined;
  EXPECT_GT(error, 0.6);
  EXPECT_LT(error, 1.4);
}

TEST(ErrorFloor, TakesACommandAsItStands) {
  const auto nothing = [](const Point&) { return 0.0; };
  host::Record record = record_of(slow_turning, nothing, 0.0, 20.0, 3);
  record.u_V = record.i_A;  // 1 A is 1 V
  EXPECT_EQ(host::compare_on({&record}, complete_motor()).records.front().prepared.effort_noise, 0.0);
}

}  // namespace
