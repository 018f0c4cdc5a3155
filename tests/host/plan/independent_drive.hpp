// A feed drive that shares no code with sim/: explicit steps of 10 us, one equation after the other, with the
// connectors of a board. Parameters have the names in the truth files of the public cases.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <numbers>
#include <random>

#include "hal/axis_hal.hpp"
#include "hal/limit_inputs.hpp"

/// Units: Nm, rad, s, mm, V. An effect with the value 0 is absent.
struct IndependentDrive {
  // The data sheet.
  double torque_per_volt = 0.0, lead = 1.0, dac_step = 0.0, dac_limit = 10.0, encoder_step = 0.0, tach_variance = 0.0;
  // Base.
  double J = 0.0, B = 0.0, coulomb_positive = 0.0, coulomb_negative = 0.0;  ///< both >= 0
  double stribeck_ratio = 1.0, stribeck_speed = 0.0;
  // Effects.
  double load = 0.0;                                        ///< constant torque against the motor
  double dac_offset = 0.0, dead_zone = 0.0, delay_s = 0.0;  ///< of the converter
  double current_bandwidth_Hz = 0.0;
  double sigma0 = 0.0, sigma1 = 0.0;                           ///< bristles
  double resonance_Hz = 0.0, damping = 0.0, load_share = 0.0;  ///< a second mass
  double gap_mm = 0.0;
  double friction_per_torque = 0.0;
  double cogging = 0.0, cogging_period_mm = 1.0, cogging_phase = 0.0;
  double ripple = 0.0, ripple_per_turn = 1.0, ripple_phase = 0.0;

  void hold(double u_V) {
    const double limited = std::clamp(u_V, -dac_limit, dac_limit);
    volts_ = dac_step > 0.0 ? dac_step * std::round(limited / dac_step) : limited;
  }
  void enable(bool on) { enabled_ = on; }

  void advance(double duration_s) {
    const int steps = static_cast<int>(std::lround(duration_s / kStep));
    for (int k = 0; k < steps; ++k) step();
  }

  std::int64_t counts() const { return static_cast<std::int64_t>(std::floor(angle_ * lead / encoder_step)); }
  double tachometer() { return speed_ + std::sqrt(tach_variance) * normal_(noise_); }
  void seed(unsigned value) { noise_.seed(value); }
  double speed() const { return speed_; }
  double travel() const { return angle_ * lead; }

 private:
  static constexpr double kStep = 1e-5;

  double command() {
    double u = volts_ + dac_offset;
    if (dead_zone > 0.0) u = std::abs(u) <= dead_zone ? 0.0 : u - std::copysign(dead_zone, u);
    if (delay_s > 0.0) {
      line_.push_back(u);
      const auto length = static_cast<std::size_t>(std::lround(delay_s / kStep));
      u = line_.size() > length ? line_.front() : 0.0;
      while (line_.size() > length) line_.pop_front();
    }
    double torque = enabled_ ? torque_per_volt * u : 0.0;
    if (current_bandwidth_Hz > 0.0) {
      torque_ += (torque - torque_) * (1.0 - std::exp(-2.0 * std::numbers::pi * current_bandwidth_Hz * kStep));
      torque = torque_;
    }
    return torque * (1.0 + ripple * std::sin(ripple_per_turn * angle_ + ripple_phase));
  }

  double level(double speed, bool forward) const {
    const double coulomb = forward ? coulomb_positive : coulomb_negative;
    if (!(stribeck_speed > 0.0)) return coulomb;
    return coulomb * (1.0 + (stribeck_ratio - 1.0) * std::exp(-std::abs(speed) / stribeck_speed));
  }

  /// One mass under `torque`. Friction may hold it, but never reverses it within a step.
  void rub(double& speed, double inertia, double torque, double transmitted, double share) const {
    const double extra = friction_per_torque * std::abs(transmitted);
    if (speed == 0.0) {
      const double hold = share * (level(0.0, torque > 0.0) + extra);
      if (std::abs(torque) <= hold) return;
      speed = (torque - std::copysign(hold, torque)) / inertia * kStep;
      return;
    }
    const double way = speed > 0.0 ? 1.0 : -1.0;
    const double friction = way * share * (level(speed, way > 0.0) + extra) + share * B * speed;
    const double next = speed + (torque - friction) / inertia * kStep;
    speed = next * way <= 0.0 ? 0.0 : next;
  }

  void step() {
    const double motor = command();
    double torque = motor - load;
    if (cogging != 0.0)
      torque += cogging * std::sin(2.0 * std::numbers::pi * angle_ * lead / cogging_period_mm + cogging_phase);
    if (load_share > 0.0) {
      two_masses(torque, motor);
    } else if (sigma0 > 0.0) {
      const double g = level(speed_, speed_ > 0.0);
      // Bristles damp only creep. With this decay, the record of the public case is reproduced to its noise.
      const double fading = std::exp(-speed_ * speed_);  // over 1 rad/s
      const double bend_rate = speed_ - sigma0 * std::abs(speed_) / g * bend_;
      speed_ += (torque - sigma0 * bend_ - sigma1 * fading * bend_rate - B * speed_) / J * kStep;
      bend_ += bend_rate * kStep;
    } else {
      rub(speed_, J, torque, motor, 1.0);
    }
    angle_ += speed_ * kStep;
  }

  void two_masses(double torque, double transmitted) {
    const double motor_J = J * (1.0 - load_share), load_J = J * load_share;
    const double reduced = motor_J * load_J / J, omega = 2.0 * std::numbers::pi * resonance_Hz;
    const double half_gap = 0.5 * gap_mm / lead, twist = angle_ - load_angle_;
    const double beyond = twist - std::clamp(twist, -half_gap, half_gap);
    double spring = 0.0;
    if (gap_mm <= 0.0 || beyond != 0.0) {
      spring = reduced * omega * omega * beyond + 2.0 * damping * reduced * omega * (speed_ - load_speed_);
      if (gap_mm > 0.0 && spring * beyond < 0.0) spring = 0.0;  // a contact only pushes
    }
    speed_ += (torque - spring) / motor_J * kStep;
    rub(load_speed_, load_J, spring, transmitted, 1.0);
    load_angle_ += load_speed_ * kStep;
  }

  double volts_ = 0.0, torque_ = 0.0;
  double angle_ = 0.0, speed_ = 0.0, load_angle_ = 0.0, load_speed_ = 0.0, bend_ = 0.0;
  bool enabled_ = true;
  std::deque<double> line_;
  std::mt19937 noise_{1};
  std::normal_distribution<double> normal_;
};

/// Satisfies firmware::SupervisedHal.
class IndependentAxis {
 public:
  /// `tachometer_step`: rad/s per code of the board's converter.
  IndependentAxis(IndependentDrive& drive, double tachometer_step)
      : encoder_{drive}, tachometer_{drive, tachometer_step}, dac_{drive}, enable_{drive} {
    enable_.set(false);
    dac_.write(0);
  }

  struct Encoder {
    IndependentDrive& drive;
    hal::EncoderReading read() const { return {static_cast<std::uint32_t>(drive.counts()), true}; }
    hal::IndexReading read_index() const { return {}; }
  };
  struct Tachometer {
    IndependentDrive& drive;
    double step;
    hal::TachometerReading read() const {
      return {static_cast<std::int32_t>(std::lround(drive.tachometer() / step)), true};
    }
  };
  struct Dac {
    IndependentDrive& drive;
    bool write(std::int32_t code) const {
      drive.hold(code * drive.dac_step);
      return true;
    }
    bool is_healthy() const { return true; }
  };
  struct Enable {
    IndependentDrive& drive;
    bool on = false;
    void set(bool value) {
      on = value;
      drive.enable(value);
    }
    bool is_on() const { return on; }
    bool is_ready() const { return on; }
    void release_brake(bool) const {}
    bool is_brake_released() const { return true; }
    bool is_faulted() const { return false; }
  };
  struct Limits {
    hal::LimitState read() const { return {}; }
  };

  Encoder& encoder() { return encoder_; }
  Tachometer& tachometer() { return tachometer_; }
  Dac& dac() { return dac_; }
  Enable& drive_enable() { return enable_; }
  Limits& limits() { return limits_; }

 private:
  Encoder encoder_;
  Tachometer tachometer_;
  Dac dac_;
  Enable enable_;
  Limits limits_;
};
