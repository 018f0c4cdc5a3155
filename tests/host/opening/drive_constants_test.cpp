// Properties of the drive from a log: a motor with known winding, driven by a voltage or by a current amplifier.
#include "host/opening/drive_constants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

constexpr double kResistance = 1.3, kEmf = 0.051, kGain = 8.5, kStep_mm = 0.0015, kNoise_A = 0.01, kPeriod_s = 1e-3;
enum class Supply { voltage, current, bus };

/// A second at rest, then five seconds in motion; Euler steps of a motor with dry friction.
host::LoggedMotion motor_on(Supply supply, unsigned noise = 3) {
  std::mt19937 seed(noise);
  std::normal_distribution<double> normal;
  host::LoggedMotion logged;
  logged.voltages.resize(1);
  double angle = 0.0, speed = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const double t = kPeriod_s * k;
    const double wanted = t > 1.0 ? 6.0 * std::sin(2.0 * std::numbers::pi * 0.7 * t) + 3.0 * std::sin(14.5 * t) : 0.0;
    const double current = t <= 1.0                    ? 0.0
                           : supply == Supply::current ? kGain * 0.1 * wanted
                                                       : (wanted - kEmf * speed) / kResistance;
    const double dry = speed > 0.0 ? 0.01 : speed < 0.0 ? -0.01 : 0.0;
    double next = speed + kPeriod_s * (kEmf * current - 2e-4 * speed - dry) / 4e-4;
    if (speed * next < 0.0 || (speed == 0.0 && std::abs(kEmf * current) < 0.01)) next = 0.0;
    speed = next;
    angle += kPeriod_s * speed;
    logged.position.push_back(std::floor(angle / kStep_mm) * kStep_mm);
    logged.speed.push_back(speed + 0.05 * normal(seed));
    logged.current.push_back(current + kNoise_A * normal(seed));
    const double shown = supply == Supply::bus ? 24.0 : supply == Supply::current ? 0.1 * wanted : wanted;
    logged.voltages.front().push_back(shown + 0.005 * normal(seed));
  }
  return logged;
}

TEST(DriveConstants, AVoltageTellsTheWinding) {
  const host::DriveConstants found = host::constants_of(motor_on(Supply::voltage));
  EXPECT_NEAR(found.resistance_Ohm.value_or(0.0), kResistance, 0.02 * kResistance);
  EXPECT_NEAR(found.back_emf_V_s.value_or(0.0), kEmf, 0.02 * kEmf);
  EXPECT_FALSE(found.amplifier_gain_A_per_V.has_value());
}

/// Catches a back-EMF by chance, which is positive for every second noise.
TEST(DriveConstants, ACommandTellsTheAmplifier) {
  for (unsigned noise = 1; noise <= 8; ++noise) {
    const host::DriveConstants found = host::constants_of(motor_on(Supply::current, noise));
    EXPECT_NEAR(found.amplifier_gain_A_per_V.value_or(0.0), kGain, 0.02 * kGain);
    EXPECT_FALSE(found.back_emf_V_s.has_value());
  }
}

/// Catches a supply voltage that is taken for a command.
TEST(DriveConstants, ASupplyTellsNothing) {
  const host::DriveConstants found = host::constants_of(motor_on(Supply::bus));
  EXPECT_FALSE(found.amplifier_gain_A_per_V.has_value());
  EXPECT_FALSE(found.back_emf_V_s.has_value());
}

TEST(DriveConstants, CountsTellTheEncoderAndRestTheNoise) {
  host::LoggedMotion logged = motor_on(Supply::voltage);
  host::DriveConstants found = host::constants_of(logged);
  EXPECT_NEAR(found.encoder_step_mm.value_or(0.0), kStep_mm, 1e-9);
  EXPECT_NEAR(found.current_noise_A.value_or(0.0), kNoise_A, 0.1 * kNoise_A);
  for (std::size_t k = 0; k < logged.position.size(); ++k)
    logged.position[k] += 0.3 * kStep_mm * std::sin(0.1 * static_cast<double>(k));
  found = host::constants_of(logged);
  EXPECT_FALSE(found.encoder_step_mm.has_value());
  EXPECT_FALSE(found.current_noise_A.has_value());
}

}  // namespace
