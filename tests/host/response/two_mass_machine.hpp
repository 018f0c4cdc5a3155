// A machine independent of the simulator, and the experiments on it: two masses on a spring, friction with a Stribeck
// peak, an encoder at the table, a noisy tachometer at the motor, Runge-Kutta steps; and its exact response.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "firmware/core/axis_parameters.hpp"
#include "host/dense_solutions.hpp"
#include "host/record/record.hpp"

struct TwoMassMachine {
  double torque_per_volt = 3.095, motor_inertia = 0.0051, load_inertia = 0.00255;  // Nm/V, kg m^2
  double resonance_Hz = 130.0, damping = 0.03, viscous = 0.03;                     // Nm s/rad, at the motor
  double coulomb = 1.5, stribeck = 0.6, stribeck_speed = 1.5;                      // Nm, Nm, rad/s; at the motor
  double lead = 1.5915494309189535, count = 0.00244140625, converter_step = 0.00030517578125;
  double tachometer_noise = 0.22;  // rad/s
  double period_s = 0.001;

  double reduced() const { return motor_inertia * load_inertia / (motor_inertia + load_inertia); }
  double stiffness() const { return reduced() * std::pow(2.0 * std::numbers::pi * resonance_Hz, 2); }
  double spring_damping() const { return 2.0 * damping * std::sqrt(stiffness() * reduced()); }

  /// d/dt of motor angle, motor speed, load angle, load speed.
  Eigen::Vector4d derivative(const Eigen::Vector4d& state, double volts, bool with_friction = true) const {
    const double spring = stiffness() * (state(0) - state(2)) + spring_damping() * (state(1) - state(3));
    const double speed = state(1);
    const double level = coulomb + stribeck * std::exp(-std::abs(speed) / stribeck_speed);
    const double friction = viscous * speed + (with_friction ? level * std::tanh(speed / 0.05) : 0.0);
    return {speed, (torque_per_volt * volts - friction - spring) / motor_inertia, state(3), spring / load_inertia};
  }

  void advance(Eigen::Vector4d& state, double volts) const {
    constexpr int kSteps = 5;
    const double h = period_s / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector4d a = derivative(state, volts), b = derivative(state + 0.5 * h * a, volts),
                            c = derivative(state + 0.5 * h * b, volts), d = derivative(state + h * c, volts);
      state += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
  }

  /// Position of the table (mm/V) and speed of the motor (rad/s/V), sampled after a hold, of the machine without
  /// Coulomb friction: the response to a small motion added to a jog.
  Eigen::Vector2cd response(double f_Hz) const {
    Eigen::Matrix<double, 5, 5> held = Eigen::Matrix<double, 5, 5>::Zero();
    for (int i = 0; i < 4; ++i) held.block<4, 1>(0, i) = derivative(Eigen::Vector4d::Unit(i), 0.0, false);
    held.block<4, 1>(0, 4) = derivative(Eigen::Vector4d::Zero(), 1.0, false);
    const Eigen::Matrix<double, 5, 5> sampled = host::exponential(held * period_s);
    const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f_Hz * period_s);
    const Eigen::Matrix4cd rest = z * Eigen::Matrix4cd::Identity() - sampled.topLeftCorner<4, 4>();
    const Eigen::Vector4cd state =
        rest.partialPivLu().solve(sampled.topRightCorner<4, 1>().cast<std::complex<double>>());
    return {lead * state(2), state(1)};
  }
};

/// The controller's numbers in double precision.
struct Gains {
  double a12, a22, b1, b2, k1, k2;
  Eigen::Matrix<double, 3, 2> estimator;
  bool cancels;

  explicit Gains(const firmware::AxisParameters<float>& p)
      : a12(static_cast<double>(p.drive.Ad12)),
        a22(static_cast<double>(p.drive.Ad22)),
        b1(static_cast<double>(p.drive.Bd1)),
        b2(static_cast<double>(p.drive.Bd2)),
        k1(static_cast<double>(p.Kc[0])),
        k2(static_cast<double>(p.Kc[1])),
        cancels(p.disturbance_cancellation_on) {
    for (std::size_t row = 0; row < 3; ++row)
      estimator.row(static_cast<Eigen::Index>(row)) << static_cast<double>(p.Kobs[row][0]),
          static_cast<double>(p.Kobs[row][1]);
  }
};

/// An independent implementation of the control law: estimate, feedback, velocity feed-forward.
class HandWrittenLoop {
 public:
  HandWrittenLoop(const TwoMassMachine& machine, const firmware::AxisParameters<float>& parameters, unsigned seed)
      : machine_(machine), gains_(parameters), random_(seed) {}

  /// One period; `reference` mm, `speed_reference` rad/s, `added_V` at the controller's output.
  void step(host::Record& record, double reference, double speed_reference, double added_V) {
    const double x = std::floor(machine_.lead * state_(2) / machine_.count) * machine_.count;
    const double w = state_(1) + machine_.tachometer_noise * normal_(random_);
    const double net = u_ - estimate_(2);
    const Eigen::Vector3d ahead(estimate_(0) + gains_.a12 * estimate_(1) + gains_.b1 * net,
                                gains_.a22 * estimate_(1) + gains_.b2 * net, estimate_(2));
    estimate_ = ahead + gains_.estimator * Eigen::Vector2d(x - ahead(0), w - ahead(1));
    double volts = gains_.k1 * (reference - estimate_(0)) - gains_.k2 * (estimate_(1) - speed_reference) + added_V;
    if (gains_.cancels) volts += estimate_(2);
    u_ = std::round(std::clamp(volts, -9.9, 9.9) / machine_.converter_step) * machine_.converter_step;
    record.t_s.push_back(static_cast<double>(record.t_s.size()) * machine_.period_s);
    record.u_V.push_back(u_);
    record.x.push_back(x);
    record.w.push_back(w);
    record.x_ref.push_back(reference);
    record.w_ref.push_back(speed_reference);
    machine_.advance(state_, u_);
  }

 private:
  const TwoMassMachine& machine_;
  Gains gains_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  Eigen::Vector4d state_ = Eigen::Vector4d::Zero();
  Eigen::Vector3d estimate_ = Eigen::Vector3d::Zero();
  double u_ = 0.0;
};

struct RideSettings {
  double ride_mm_s = 15.0;
  std::size_t period = 1024, periods = 3;
  double peak_V = 1.0;
};

inline std::string joined(const auto& values) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : " ") + std::to_string(value);
  return text;
}

/// A multisine at the controller's output on a jog: half a period of run-up, one of fade, then whole periods.
inline host::Record ride_with_lines(const TwoMassMachine& machine, const firmware::AxisParameters<float>& parameters,
                                    const std::vector<std::size_t>& lines, const RideSettings& settings, bool forward,
                                    unsigned seed) {
  std::mt19937 random(seed * 977u + 5u);
  std::uniform_real_distribution<double> turns(0.0, 1.0);
  std::vector<double> phases;
  for (std::size_t i = 0; i < lines.size(); ++i) phases.push_back(turns(random));
  std::vector<double> wave(settings.period);
  double peak = 0.0;
  for (std::size_t k = 0; k < settings.period; ++k) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      wave[k] += std::sin(
          2.0 * std::numbers::pi *
          (static_cast<double>(lines[i] * k % settings.period) / static_cast<double>(settings.period) + phases[i]));
    peak = std::max(peak, std::abs(wave[k]));
  }
  host::Record record;
  record.path = "two masses";
  record.sample_period_s = machine.period_s;
  record.header = {{"excitation", "multisine"},
                   {"excitation_input", "controller's output"},
                   {"excitation_period_samples", std::to_string(settings.period)},
                   {"excitation_lines", joined(lines)},
                   {"excitation_phases_turns", joined(phases)},
                   {"excitation_ride", std::to_string(settings.ride_mm_s)}};
  HandWrittenLoop loop(machine, parameters, seed);
  double reference = 0.0;
  const auto lead_in = 100 + random() % 37;  // records begin anywhere in a period
  for (std::size_t k = 0; k < lead_in; ++k) loop.step(record, reference, 0.0, 0.0);
  const std::size_t run = (settings.periods + 1) * settings.period + settings.period / 2;
  for (std::size_t k = 0; k < run; ++k) {
    const double speed = settings.ride_mm_s * std::min(1.0, static_cast<double>(k) / 100.0) * (forward ? 1.0 : -1.0);
    reference += speed * machine.period_s;
    const double fade = std::min(1.0, static_cast<double>(k) / static_cast<double>(settings.period));
    loop.step(record, reference, speed / machine.lead, settings.peak_V / peak * fade * wave[k % settings.period]);
  }
  return record;
}
