// Motions and the torques that they need, in closed form, without a simulator.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kInertia = 2e-5, kViscous = 5e-4, kCoulomb = 0.02, kPerAmpere = 0.03;

/// One radian is one millimetre; the motor gives 0.03 Nm/A.
inline sim::DriveDescription motor() {
  sim::DriveDescription model;
  model.data.amplifier_gain_A_per_V = 1.0;
  model.data.torque_constant_Nm_per_A = kPerAmpere;
  model.data.encoder_resolution = kTurn / 20000.0;
  model.effects.push_back({"inertia", {{"J", 1.1 * kInertia}}, {}, {}});
  model.effects.push_back({"viscous", {{"B", 0.8 * kViscous}}, {}, {}});
  model.effects.push_back({"coulomb", {{"level", 1.2 * kCoulomb}}, {}, {}});
  return model;
}

/// Travel, speed and acceleration at a time.
struct Point {
  double x, w, a;
};

/// Turns at 3 to 9 rad/s, alternately forward and backward. The speed passes smoothly through zero.
inline Point slow_turning(double t_s) {
  const double slow = kTurn * 0.05, wave = kTurn * 0.31;
  return {-8.0 / slow * std::cos(slow * t_s) - 1.0 / wave * std::cos(wave * t_s),
          8.0 * std::sin(slow * t_s) + std::sin(wave * t_s),
          8.0 * slow * std::cos(slow * t_s) + wave * std::cos(wave * t_s)};
}

/// A record of a motion and of the torque that it needs in addition to inertia and friction. The sampling has jitter
/// (s); the current has steps of 2 mA.
template <typename Motion, typename Further>
host::Record record_of(Motion motion, Further further, double from_s, double to_s, unsigned seed,
                       double jitter = 2e-5) {
  host::Record record;
  record.path = "made.csv";
  record.sample_period_s = 0.001;
  record.header["effort_timing_samples"] = "0";  // the current acts at the time of its row
  std::mt19937 random(seed);
  std::normal_distribution<double> jitter_s(0.0, jitter), noise_A(0.0, 0.01);
  const double step = kTurn / 20000.0;
  for (double t_s = from_s; t_s < to_s; t_s += record.sample_period_s) {
    const Point point = motion(t_s + jitter_s(random));
    const double effort = kInertia * point.a + kViscous * point.w + std::copysign(kCoulomb, point.w) + further(point);
    record.t_s.push_back(t_s - from_s);
    record.x.push_back(step * std::round(point.x / step));
    record.i_A.push_back(0.002 * std::round((effort / kPerAmpere + noise_A(random)) / 0.002));
  }
  return record;
}
