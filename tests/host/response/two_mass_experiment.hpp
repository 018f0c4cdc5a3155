// The two-mass machine with a controller designed for one mass: records of it, and its exact open loop.
#pragma once

#include "host/dense_solutions.hpp"
#include "host/identify/axis_design.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "tests/host/response/two_mass_machine.hpp"

inline firmware::AxisParameters<float> controller_for(const TwoMassMachine& machine) {
  sim::DriveDescription model;
  model.data.amplifier_gain_A_per_V = machine.torque_per_volt;
  model.data.torque_constant_Nm_per_A = 1.0;
  model.data.lead = machine.lead;
  model.data.sample_period_s = machine.period_s;
  model.data.dac_resolution_V = machine.converter_step;
  model.data.encoder_resolution = machine.count;
  model.data.tach_noise_variance = machine.tachometer_noise * machine.tachometer_noise;
  sim::EffectEntry inertia, viscous;
  inertia.kind = "inertia";
  inertia.parameters["J"] = machine.motor_inertia + machine.load_inertia;
  viscous.kind = "viscous";
  viscous.parameters["B"] = machine.viscous;
  model.effects = {inertia, viscous};
  return host::axis_parameters(model, host::design_axis(model, {}), 0.01);
}

/// A band of lines in periods of 1024 samples, with its peak amplitude.
struct Band {
  std::vector<std::size_t> lines;
  double peak_V;
};

inline const std::vector<Band>& bands() {
  static const std::vector<Band> all = {{{5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29}, 0.6},
                                        {{31, 35, 39, 43, 47, 51, 55, 59, 63, 67, 71, 75, 79, 83}, 1.5},
                                        {{87, 95, 103, 111, 119, 125, 129, 133, 137, 141, 149}, 2.0},
                                        {{161, 175, 183, 191, 199, 211, 223, 227}, 8.0}};
  return all;
}

inline std::vector<host::Record> rides(const TwoMassMachine& machine, const firmware::AxisParameters<float>& controller,
                                       unsigned seed, std::size_t realisations = 4) {
  std::vector<host::Record> records;
  for (std::size_t band = 0; band < bands().size(); ++band)
    for (std::size_t m = 0; m < realisations; ++m) {
      RideSettings settings;
      settings.peak_V = bands()[band].peak_V;
      records.push_back(ride_with_lines(machine, controller, bands()[band].lines, settings, m % 2 == 0,
                                        static_cast<unsigned>(seed * 100 + band * 20 + m)));
    }
  return records;
}

/// Drive and estimator as one system in the time domain, cut at the drive's input; uses no frequency response.
class ExactOpenLoop {
 public:
  ExactOpenLoop(const TwoMassMachine& machine, const firmware::AxisParameters<float>& parameters)
      : period_s_(machine.period_s) {
    const Gains g(parameters);
    Eigen::Matrix<double, 5, 5> held = Eigen::Matrix<double, 5, 5>::Zero();
    for (int i = 0; i < 4; ++i) held.block<4, 1>(0, i) = machine.derivative(Eigen::Vector4d::Unit(i), 0.0, false);
    held.block<4, 1>(0, 4) = machine.derivative(Eigen::Vector4d::Zero(), 1.0, false);
    const Eigen::Matrix<double, 5, 5> sampled = host::exponential(held * period_s_);
    Eigen::Matrix<double, 2, 4> seen = Eigen::Matrix<double, 2, 4>::Zero();
    seen(0, 2) = machine.lead;
    seen(1, 1) = 1.0;
    Eigen::Matrix3d A;
    A << 1.0, g.a12, -g.b1, 0.0, g.a22, -g.b2, 0.0, 0.0, 1.0;
    const Eigen::Vector3d B(g.b1, g.b2, 0.0);
    feedback_ << g.k1, g.k2, g.cancels ? -1.0 : 0.0;
    Eigen::Matrix3d innovation = Eigen::Matrix3d::Identity();
    innovation.leftCols<2>() -= g.estimator;
    A_.setZero();
    A_.topLeftCorner<4, 4>() = sampled.topLeftCorner<4, 4>();
    A_.bottomLeftCorner<3, 4>() = g.estimator * seen * sampled.topLeftCorner<4, 4>();
    A_.bottomRightCorner<3, 3>() = innovation * (A - B * feedback_);
    B_.head<4>() = sampled.topRightCorner<4, 1>();
    B_.tail<3>() = g.estimator * seen * sampled.topRightCorner<4, 1>();
  }

  std::complex<double> at(double f_Hz) const {
    const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f_Hz * period_s_);
    const Eigen::Matrix<std::complex<double>, 7, 7> rest =
        z * Eigen::Matrix<std::complex<double>, 7, 7>::Identity() - A_.cast<std::complex<double>>();
    const Eigen::Matrix<std::complex<double>, 7, 1> state = rest.partialPivLu().solve(B_.cast<std::complex<double>>());
    return (feedback_.cast<std::complex<double>>() * state.tail<3>())(0);
  }

  /// The gain beyond which a pole of the closed loop leaves the unit circle.
  double gain_margin() const {
    double low = 1.0, high = 100.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = std::sqrt(low * high);
      (is_stable(middle) ? low : high) = middle;
    }
    return low;
  }
  bool is_stable(double gain) const {
    Eigen::Matrix<double, 7, 7> closed = A_;
    closed.rightCols<3>() -= gain * B_ * feedback_;
    return host::eigenvalues(closed).cwiseAbs().maxCoeff() < 1.0;
  }

 private:
  double period_s_;
  Eigen::Matrix<double, 7, 7> A_;
  Eigen::Matrix<double, 7, 1> B_;
  Eigen::RowVector3d feedback_;
};
