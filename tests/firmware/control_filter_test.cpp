// Notch and low-pass: response, initial state, and the filters that a loop accepts.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/control/pole_check.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace {

using firmware_test::kLead_mm_per_rad;
using firmware_test::kPaperX;
using firmware_test::paper_values;
using firmware_test::set;

template <typename Scalar>
class ControlFilter : public testing::Test {
 protected:
  static double real(Scalar value) { return static_cast<double>(firmware::ScalarTraits<Scalar>::to_float(value)); }
  static firmware::AxisParameters<Scalar> parameters(const firmware::ParameterValues& values) {
    return firmware::axis_parameters<Scalar>(values.axis(0));
  }
};
using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(ControlFilter, Scalars);

/// Compares with the transfer function of the continuous filter at the prewarped frequency. Without prewarping the
/// notch would shift by a twentieth; with swapped coefficients there would be no notch.
TYPED_TEST(ControlFilter, LeavesWhatItsNumbersSay) {
  constexpr double kPeriod_s = 1e-3, kNotch_Hz = 120.0, kDamping = 0.3, kDepth = 0.2, kLowPass_Hz = 180.0;
  firmware::ParameterValues values = paper_values();
  set(values, "x.notch.on", 1);
  set(values, "x.notch.frequency", kNotch_Hz);
  set(values, "x.notch.damping", kDamping);
  set(values, "x.notch.depth", kDepth);
  set(values, "x.low_pass.on", 1);
  set(values, "x.low_pass.frequency", kLowPass_Hz);
  set(values, "x.low_pass.damping", 0.7);
  const auto warped = [](double f_Hz) { return std::tan(std::numbers::pi * f_Hz * kPeriod_s); };
  for (const double f_Hz : {2.0, 40.0, 100.0, 120.0, 150.0, 250.0, 400.0}) {
    firmware::ControlFilters<TypeParam> filters;
    filters.configure(this->parameters(values).filters);
    std::complex<double> in = 0.0, out = 0.0;
    for (int k = 0; k < 4000; ++k) {
      const double turn = 2.0 * std::numbers::pi * f_Hz * kPeriod_s * k;
      const auto x = TypeParam(static_cast<float>(std::sin(turn)));
      const double y = this->real(filters.next(x));
      if (k < 2000) continue;  // settled; whole periods follow
      in += this->real(x) * std::polar(1.0, -turn);
      out += y * std::polar(1.0, -turn);
    }
    const std::complex<double> s(0.0, warped(f_Hz));
    const double w = warped(kNotch_Hz), l = warped(kLowPass_Hz);
    const std::complex<double> wanted = (s * s + 2.0 * kDamping * kDepth * w * s + w * w) /
                                        (s * s + 2.0 * kDamping * w * s + w * w) * l * l /
                                        (s * s + 1.4 * l * s + l * l);
    EXPECT_NEAR(std::abs(out / in - wanted), 0.0, 2e-4) << f_Hz;
  }
}

/// A controller that holds a weight must not drop it when its loop closes.
TYPED_TEST(ControlFilter, BeginsWithoutABump) {
  firmware::ParameterValues values = paper_values();
  set(values, "x.notch.on", 1);
  set(values, "x.low_pass.on", 1);
  set(values, "x.low_pass.frequency", 20);
  firmware::ControlFilters<TypeParam> filters;
  filters.configure(this->parameters(values).filters);
  for (int enabled = 0; enabled < 2; ++enabled) {
    for (int k = 0; k < 50; ++k) EXPECT_NEAR(this->real(filters.next(TypeParam(2.5f))), 2.5, 1e-5) << k;
    filters.next(TypeParam(-1.0f));
    filters.reset();
  }
}

/// Largest pole of drive, feedback and filters together, in double precision.
double largest_pole(const firmware::AxisParameters<float>& p) {
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  const auto step = [&](Eigen::Matrix<double, 6, 1> state) {
    double value = -static_cast<double>(p.Kc[0]) * state(0) - static_cast<double>(p.Kc[1]) * state(1);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const auto& f = p.filters[static_cast<std::size_t>(i)];
      double& band = state(2 + 2 * i);
      double& low = state(3 + 2 * i);
      if (!f.on) {
        band = low = 0.0;
        continue;
      }
      const double rest = value - low, v1 = static_cast<double>(f.a1) * band + static_cast<double>(f.a2) * rest,
                   v2 = low + static_cast<double>(f.a2) * band + static_cast<double>(f.a3) * rest;
      band = 2.0 * v1 - band;
      low = 2.0 * v2 - low;
      value = f.is_low_pass ? v2 : value + static_cast<double>(f.of_band) * v1;
    }
    const double x = state(0) + static_cast<double>(p.drive.Ad12) * state(1) + static_cast<double>(p.drive.Bd1) * value;
    state(1) = static_cast<double>(p.drive.Ad22) * state(1) + static_cast<double>(p.drive.Bd2) * value;
    state(0) = x;
    return state;
  };
  for (Eigen::Index i = 0; i < 6; ++i) A.col(i) = step(Eigen::Matrix<double, 6, 1>::Unit(i));
  return A.eigenvalues().cwiseAbs().maxCoeff();
}

/// Every unstable loop is refused; a loop whose poles are well inside the circle is not.
TYPED_TEST(ControlFilter, IsRefusedWhereTheLoopDoesNotStandIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int refused = 0, accepted = 0;
  for (int i = 0; i < 400; ++i) {
    firmware::ParameterValues values = paper_values();
    set(values, "x.notch.on", i % 3 != 0);
    set(values, "x.notch.frequency", 8.0 * std::pow(50.0, part(random)));
    set(values, "x.notch.damping", 0.1 * std::pow(10.0, part(random)));
    set(values, "x.low_pass.on", i % 3 != 1);
    set(values, "x.low_pass.frequency", 8.0 * std::pow(50.0, part(random)));
    const double pole = largest_pole(firmware::axis_parameters<float>(values.axis(0)));
    const bool is_sound = firmware::are_filters_sound(this->parameters(values));
    (is_sound ? accepted : refused) += 1;
    EXPECT_FALSE(is_sound && pole >= 1.0) << pole;
    EXPECT_FALSE(!is_sound && pole < 0.97) << pole;  // the paper's loop alone: 0.88
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(accepted, 50);
}

/// Bounded algebra in single precision is also correct at 20 kHz, where the poles of a slow loop are close to 1. The
/// paper's x axis as a continuous drive, sampled as fast; its loop placed at 8 Hz, damped by 0.8.
TEST(ControlFilterAtAFastRate, IsJudgedAsInDoublePrecision) {
  constexpr double kPeriod_s = 5e-5, kLoop_Hz = 8.0, kDamping = 0.8;
  const double pole = -std::log(kPaperX.Ad22) / 1e-3, gain = kPaperX.Bd2 / (1.0 - kPaperX.Ad22) * pole;
  const double a22 = std::exp(-pole * kPeriod_s), a12 = kLead_mm_per_rad * (1.0 - a22) / pole;
  const double b2 = gain * (1.0 - a22) / pole, b1 = kLead_mm_per_rad * gain / pole * (kPeriod_s - (1.0 - a22) / pole);
  const double w = 2.0 * std::numbers::pi * kLoop_Hz, radius = std::exp(-kDamping * w * kPeriod_s);
  const double trace = 2.0 * radius * std::cos(w * std::sqrt(1.0 - kDamping * kDamping) * kPeriod_s);
  const double k1 = (1.0 - trace + radius * radius) / (b1 * (1.0 - a22) + b2 * a12);
  const double k2 = (2.0 - trace - (1.0 - a22) - b1 * k1) / b2;
  int refused = 0, accepted = 0;
  for (double low_pass_Hz = 4.0; low_pass_Hz < 400.0; low_pass_Hz *= 1.1) {
    firmware::ParameterValues values = paper_values();
    set(values, "x.drive.sample_period", kPeriod_s);
    set(values, "x.low_pass.on", 1);
    set(values, "x.low_pass.frequency", low_pass_Hz);
    auto p = firmware::axis_parameters<float>(values.axis(0));
    p.drive = {static_cast<float>(a12), static_cast<float>(a22), static_cast<float>(b1), static_cast<float>(b2)};
    p.Kc = {static_cast<float>(k1), static_cast<float>(k2)};
    const double largest = largest_pole(p);
    const double share = (1.0 - radius * radius) / 20.0;  // a tenth of the loop's own decay
    const bool is_sound = firmware::are_filters_sound(p);
    (is_sound ? accepted : refused) += 1;
    if (largest > 1.0 - 0.9 * share) {
      EXPECT_FALSE(is_sound) << low_pass_Hz;
    }
    if (largest < 1.0 - 1.1 * share) {
      EXPECT_TRUE(is_sound) << low_pass_Hz;
    }
  }
  EXPECT_GT(refused, 5);
  EXPECT_GT(accepted, 5);
}

TYPED_TEST(ControlFilter, IsRefusedNearHalfTheControlRate) {
  firmware::ParameterValues values = paper_values();
  set(values, "x.notch.frequency", 451);
  EXPECT_EQ(firmware::check_poles(this->parameters(values)), firmware::Refusal::none) << "it is off";
  set(values, "x.notch.on", 1);
  EXPECT_EQ(firmware::check_poles(this->parameters(values)), firmware::Refusal::filters);
}

}  // namespace
