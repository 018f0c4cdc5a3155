// The plant's connectors: converter, encoder, tachometer, enable.
#include "sim/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::Plant;
using sim_test::kInertia;
using sim_test::kViscous;
using sim_test::viscous_drive;
using sim_test::with;

sim::DriveDescription quantised_drive() {
  sim::DriveDescription drive = viscous_drive();
  drive.data.dac_resolution_V = 0.25;
  drive.data.dac_limit_V = 10.0;
  drive.data.encoder_resolution = 0.01;
  drive.data.tach_noise_variance = 0.05;
  return drive;
}

struct Moments {
  double mean = 0.0, variance = 0.0;
};

template <typename Sample>
Moments moments(int count, Sample&& sample) {
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < count; ++k) {
    const double value = sample(k);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, squares / count - mean * mean};
}

TEST(Converter, RoundingErrorHasTheVarianceOfEq10) {
  Plant plant(quantised_drive(), 1);
  const double step_V = 0.25;
  // 4001 commands over 16 whole steps visit every place within a step equally often.
  const Moments error = moments(4001, [&](int k) {
    const double wanted = -2.0 + 4.0 * k / 4001.0;
    plant.set_command(wanted);
    return plant.command_V() - wanted;
  });
  EXPECT_NEAR(error.variance, step_V * step_V / 12.0, 1e-3 * step_V * step_V / 12.0);
  EXPECT_NEAR(error.mean, 0.0, 1e-3 * step_V);
}

TEST(Converter, RangeIsLimited) {
  Plant plant(quantised_drive(), 1);
  for (const double u_V : {10.2, 50.0, HUGE_VAL}) {
    plant.set_command(u_V);
    EXPECT_EQ(plant.command_V(), 10.0);
    plant.set_command(-u_V);
    EXPECT_EQ(plant.command_V(), -10.0);
  }
}

TEST(Encoder, RoundingErrorHasTheVarianceOfEq12) {
  Plant plant(quantised_drive(), 1);
  const double step_mm = 0.01;
  const Moments error = moments(7001, [&](int k) {
    plant.truth().x = -0.35 + 0.7 * k / 7001.0;
    return static_cast<double>(plant.encoder_counts()) * step_mm - plant.truth().x;
  });
  EXPECT_NEAR(error.variance, step_mm * step_mm / 12.0, 1e-2 * step_mm * step_mm / 12.0);
  EXPECT_NEAR(error.mean, -0.5 * step_mm, 1e-2 * step_mm) << "the edge that was passed last";
}

TEST(Encoder, CountsFromTheStartBothWays) {
  Plant plant(quantised_drive(), 1);
  plant.truth().x = 0.0349;
  EXPECT_EQ(plant.encoder_counts(), 3);
  plant.truth().x = -0.0001;
  EXPECT_EQ(plant.encoder_counts(), -1);
  plant.truth().x = 10000.005;  // ten metres
  EXPECT_EQ(plant.encoder_counts(), 1000000);
}

TEST(Tachometer, NoiseHasItsVarianceAndNoMemory) {
  Plant plant(quantised_drive(), 7);
  const int count = 40000;
  plant.truth() = sim::Drive(quantised_drive()).at(0.0, 12.0);
  double last = 12.0, products = 0.0;
  const Moments reading = moments(count, [&](int) {
    const double value = plant.read_tachometer().value();
    products += (value - 12.0) * (last - 12.0);
    return last = value;
  });
  // Four standard errors of mean, variance and covariance for independent normal readings.
  EXPECT_NEAR(reading.mean, 12.0, 4.0 * std::sqrt(0.05 / count));
  EXPECT_NEAR(reading.variance, 0.05, 4.0 * 0.05 * std::sqrt(2.0 / count));
  EXPECT_NEAR(products / count, 0.0, 4.0 * 0.05 / std::sqrt(count));
}

TEST(Tachometer, TheSeedFixesTheNoise) {
  Plant a(quantised_drive(), 3), b(quantised_drive(), 3), c(quantised_drive(), 4);
  const double first = a.read_tachometer().value();
  EXPECT_EQ(first, b.read_tachometer().value());
  EXPECT_NE(first, c.read_tachometer().value());
}

TEST(Tachometer, MayBeAbsent) {
  sim::DriveDescription drive = quantised_drive();
  drive.data.tach_noise_variance.reset();
  EXPECT_FALSE(Plant(drive, 1).read_tachometer().has_value());
}

TEST(Plant, FollowsTheQuantisedCommand) {
  Plant plant(quantised_drive(), 1);
  plant.set_command(1.1);  // 1.0 V after rounding
  plant.advance(0.3);
  const double rate = kViscous / kInertia;
  EXPECT_NEAR(plant.truth().w, 1.0 / kViscous * (1.0 - std::exp(-rate * 0.3)), 1e-9);
  EXPECT_NEAR(plant.time_s(), 0.3, 1e-12);
}

TEST(Plant, WithoutEnableTheMotorIsFreeOfCurrent) {
  // Also if the amplifier adds an offset to the command.
  Plant plant(with(with(quantised_drive(), "dac_offset", {{"offset", 0.5}}), "torque_ripple",
                   {{"cosine", 0.1}, {"sine", 0.0}, {"period", 5.0}}),
              1);
  plant.set_enabled(false);
  plant.set_command(5.0);
  plant.advance(0.1);
  EXPECT_EQ(plant.truth().w, 0.0);
  EXPECT_EQ(plant.truth().x, 0.0);
  plant.set_enabled(true);
  plant.advance(0.01);
  EXPECT_GT(plant.truth().w, 0.0);
  plant.truth().w = 10.0;
  plant.set_enabled(false);
  plant.advance(0.2);
  EXPECT_NEAR(plant.truth().w, 10.0 * std::exp(-kViscous / kInertia * 0.2), 1e-9) << "coasts";
}

TEST(Plant, RefusesAnUnknownEffect) {
  EXPECT_THROW(Plant(with(quantised_drive(), "gremlins", {}), 1), std::invalid_argument);
}

/// For a drive that moves forward, then back: readings of the scale and positions of the motor. Without a command, a
/// motor without friction of its own would float in the gap.
struct Ends {
  double forth, back, motor_forth, motor_back;
};

Ends ends_of(const sim::DriveDescription& drive) {
  Plant plant(drive, 1);
  const auto go = [&](double u_V, double for_s) {
    plant.set_command(u_V);
    plant.advance(for_s);
    return std::pair(*plant.read_load_encoder(), plant.truth().x);
  };
  const auto [forth, motor_forth] = go(2.0, 0.5);
  plant.set_command(0.0);
  plant.advance(2.0);
  const auto [back, motor_back] = go(-2.0, 2.0);
  return {forth, back, motor_forth, motor_back};
}

TEST(LoadEncoder, IsThereWhereTheDriveHasOne) {
  EXPECT_FALSE(Plant(viscous_drive(), 1).read_load_encoder().has_value());
  sim::DriveDescription drive = viscous_drive();
  drive.data.load_encoder_resolution = 0.001;
  EXPECT_EQ(Plant(drive, 1).read_load_encoder(), 0.0);
}

/// Catches a scale that reads the motor's travel.
TEST(LoadEncoder, ReadsTheTableBehindItsGap) {
  sim::DriveDescription drive = sim_test::coulomb_drive();
  drive.data.load_encoder_resolution = 1e-6;
  const double gap = 0.05;
  drive = with(drive, "backlash", {{"gap", gap}, {"resonance", 200.0}, {"damping_ratio", 0.3}, {"load_fraction", 0.3}});
  const Ends ends = ends_of(drive);
  ASSERT_GT(ends.motor_forth, 1.0);
  ASSERT_LT(ends.motor_back, ends.motor_forth - 1.0);
  // Friction acts on the table, which lags behind the motor by half of the gap.
  EXPECT_NEAR((ends.back - ends.motor_back) - (ends.forth - ends.motor_forth), gap, 0.1 * gap);
}

TEST(LoadEncoder, ReadsPitchErrorGrowthAndItsOwnErrors) {
  sim::DriveDescription drive = viscous_drive();
  drive.data.load_encoder_resolution = 1e-7;
  drive.data.load_encoder_cyclic_error = 0.002;
  drive.data.load_encoder_cyclic_period = 0.3;
  drive.data.load_encoder_cyclic_phase_rad = 1.0;
  drive = with(drive, "pitch_error", {{"lead_error", 50.0}, {"cosine", 0.01}, {"sine", -0.02}, {"period", 7.0}});
  drive = with(drive, "thermal_growth", {{"growth", 0.03}, {"time_constant", 4.0}});
  Plant plant(drive, 1);
  plant.set_command(1.0);
  plant.advance(1.5);
  const double x = plant.truth().x, turns = 2.0 * std::numbers::pi * x / 7.0;
  const double table =
      x + 50e-6 * x + 0.01 * std::cos(turns) - 0.02 * std::sin(turns) + 0.03 * (1.0 - std::exp(-1.5 / 4.0));
  const double reading = table + 0.002 * std::cos(2.0 * std::numbers::pi * table / 0.3 - 1.0);
  ASSERT_GT(x, 5.0);
  EXPECT_NEAR(*plant.read_load_encoder(), reading, 2e-7);
}

}  // namespace
