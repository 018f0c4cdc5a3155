// A record with a given motion: acceleration, constant speed, braking, rest, and the same backward.
#pragma once

#include <cmath>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

struct HandMade {
  static constexpr double kPeriod_s = 0.001;
  static constexpr double kInertia = 0.008, kViscous = 0.03, kCoulomb = 2.0;

  static sim::DriveDescription model() {
    sim::DriveDescription drive;
    drive.name = "hand-made";
    drive.data.amplifier_gain_A_per_V = 6.5;
    drive.data.torque_constant_Nm_per_A = 0.48;
    drive.data.lead = 1.6;
    drive.data.encoder_resolution = 0.002;
    drive.data.dac_resolution_V = 0.0003;
    drive.data.tach_noise_variance = 0.01;
    drive.effects = {{"inertia", {{"J", kInertia}}, {}, {}},
                     {"viscous", {{"B", kViscous}}, {}, {}},
                     {"coulomb", {{"positive", kCoulomb}, {"negative", -kCoulomb}}, {}, {}}};
    return drive;
  }

  /// Acceleration, rad/s^2, over one cycle of 5 s: +100 for 0.5 s, 0 for 1 s, -100 for 0.5 s, rest for 0.5 s, then
  /// mirrored.
  static double acceleration(double t_s) {
    const double phase = std::fmod(t_s, 5.0);
    const double half = std::fmod(phase, 2.5);
    const double sign = phase < 2.5 ? 1.0 : -1.0;
    if (half < 0.5) return sign * 100.0;
    if (half < 1.5) return 0.0;
    return half < 2.0 ? -sign * 100.0 : 0.0;
  }

  /// The tachometer signal contains a fast sine with the size of its noise.
  static host::Record record(double duration_s = 10.0) {
    const sim::DataSheet data = model().data;
    host::Record record;
    record.path = "hand-made.csv";
    record.columns = {"t_s", "u_V", "x_mm", "w_rad_s"};
    record.sample_period_s = kPeriod_s;
    double x = 0.0, w = 0.0;
    for (int k = 0; k < static_cast<int>(duration_s / kPeriod_s); ++k) {
      const double t_s = k * kPeriod_s, a = acceleration(t_s + 0.5 * kPeriod_s);
      const double going = w != 0.0 ? w : a, sign = going > 0.0 ? 1.0 : going < 0.0 ? -1.0 : 0.0;
      record.t_s.push_back(t_s);
      record.u_V.push_back((kInertia * a + kViscous * w + kCoulomb * sign) / data.effort_per_volt());
      record.x.push_back(std::round(x / data.encoder_resolution) * data.encoder_resolution);
      record.w.push_back(w + 0.1 * std::sin(1.7 * k));
      x += data.lead * (w + 0.5 * a * kPeriod_s) * kPeriod_s;
      w += a * kPeriod_s;
      if (std::abs(w) < 1e-9) w = 0.0;
    }
    return record;
  }
};
