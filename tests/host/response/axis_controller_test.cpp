// The controller's frequency response against the control core in the time domain.
#include "host/response/axis_controller.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "firmware/core/control/kalman_estimator.hpp"
#include "host/parameters/control_filters.hpp"
#include "tests/host/response/two_mass_experiment.hpp"

namespace {

/// Response u/y to y = [position, 0] or [0, speed] at one frequency, with the core's estimator, feedback and filters.
std::complex<double> answer_in_time(const firmware::AxisParameters<float>& p, double f_Hz, bool is_speed) {
  firmware::KalmanEstimator<float> estimator;
  estimator.configure(p.drive, p.Kobs, 1e-6F);
  firmware::ControlFilters<float> filters;
  filters.configure(p.filters);
  auto estimate = firmware::KalmanEstimator<float>::at_rest(0);
  float u = 0.0F;
  std::complex<double> in = 0.0, out = 0.0;
  for (int k = 0; k < 12'000; ++k) {
    const double turn = 2.0 * std::numbers::pi * f_Hz * 1e-3 * k;
    const auto counts = is_speed ? 0 : std::llround(1e6 * std::sin(turn));
    const float speed = is_speed ? static_cast<float>(100.0 * std::sin(turn)) : 0.0F;
    estimator.update(estimate, u, counts, speed);
    const float position = static_cast<float>(estimate.anchor_counts) * 1e-6F + estimate.offset;
    float command = -p.Kc[0] * position - p.Kc[1] * estimate.velocity;
    if (p.disturbance_cancellation_on) command += estimate.disturbance;
    u = filters.next(command);
    if (k < 6'000) continue;
    in += std::sin(turn) * (is_speed ? 100.0 : 1.0) * std::polar(1.0, -turn);
    out += static_cast<double>(u) * std::polar(1.0, -turn);
  }
  return out / in;
}

TEST(AxisController, AnswersAsTheCoreDoes) {
  const TwoMassMachine machine;
  firmware::AxisParameters<float> parameters = controller_for(machine);
  for (const bool has_filters : {false, true}) {
    if (has_filters)
      parameters.filters = host::core_filters({host::Notch{130.0, 0.3, 0.2}, host::LowPass{210.0}}, 1e-3);
    parameters.disturbance_cancellation_on = false;  // an open integrator never settles
    const host::AxisController controller(parameters);
    for (const double f_Hz : {5.0, 40.0, 130.0, 260.0}) {
      const Eigen::RowVector2cd wanted = -controller.at(f_Hz);
      for (const bool is_speed : {false, true}) {
        const std::complex<double> seen = answer_in_time(parameters, f_Hz, is_speed);
        EXPECT_LT(std::abs(seen / wanted(is_speed ? 1 : 0) - 1.0), 0.01)
            << f_Hz << ' ' << is_speed << ' ' << has_filters;
      }
    }
  }
}

}  // namespace
