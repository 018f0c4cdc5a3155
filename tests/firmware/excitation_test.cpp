// The excitations: the output equals the request, in float and in fixed point.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "firmware/core/arithmetic/fixed_point.hpp"
#include "firmware/core/control/dac_conversion.hpp"
#include "firmware/core/excitation/excitation_generator.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::ExcitationInput;
using firmware::ExcitationKind;

constexpr double kStep_V = firmware_test::kDacResolution_V;

/// V of the scalar; fixed point's unit is 4096 steps of the converter.
template <typename Scalar>
Scalar volts(double value) {
  if constexpr (std::is_same_v<Scalar, float>)
    return static_cast<float>(value);
  else
    return Scalar::from(value / (4096 * kStep_V));
}
template <typename Scalar>
double in_volts(Scalar value) {
  if constexpr (std::is_same_v<Scalar, float>)
    return static_cast<double>(value);
  else
    return static_cast<double>(value.raw()) / Scalar(1).raw() * 4096 * kStep_V;
}

template <typename Scalar>
class Excitation : public testing::Test {
 protected:
  Excitation() {
    plan.box = {
        .travel_counts = 1000, .margin_counts = 0, .speed = 1000, .drive_velocity = {}, .volts = volts<Scalar>(10)};
    plan.samples = 100'000;
  }
  /// Output of the converter.
  std::vector<double> play(std::size_t samples) {
    firmware::DacConversion<Scalar> dac;
    dac.configure(volts<Scalar>(kStep_V), volts<Scalar>(10));
    generator.start(plan);
    std::vector<double> out;
    for (std::size_t k = 0; k < samples; ++k) out.push_back(dac(generator.next(false)).code * kStep_V);
    return out;
  }
  firmware::ExcitationPlan<Scalar> plan;
  firmware::ExcitationGenerator<Scalar> generator;
};

using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(Excitation, Scalars);

/// Amplitude of a harmonic of `period` samples in the last period of a signal, by its definition.
double amplitude_of(const std::vector<double>& signal, std::size_t period, std::size_t harmonic) {
  std::complex<double> sum = 0.0;
  const std::size_t first = signal.size() - period;
  for (std::size_t k = 0; k < period; ++k)
    sum += signal[first + k] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(harmonic * k % period) /
                                                   static_cast<double>(period));
  return 2.0 * std::abs(sum) / static_cast<double>(period);
}

/// Catches phases that do not restart (a period of 1000 does not divide 2^32), a wrong sine, amplitudes in a wrong
/// unit, and a scalar that is too coarse. Between the lines only the converter's rounding of the sum of the lines may
/// remain.
TYPED_TEST(Excitation, AMultisineHasItsLinesAndNothingBetweenThem) {
  constexpr std::size_t kPeriod = 1000;
  const std::vector<std::uint32_t> lines = {1, 3, 7, 11, 13, 19, 27, 41, 63, 95, 141, 211, 315};
  this->plan.kind = ExcitationKind::multisine;
  this->plan.count = static_cast<std::uint8_t>(lines.size());
  this->plan.period = this->plan.fade_samples = kPeriod;
  std::vector<double> wanted(kPeriod / 2, 0.0);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double amplitude = 0.1 + 0.02 * static_cast<double>(i);
    wanted[lines[i]] = amplitude;
    this->plan.entry[i] = {volts<TypeParam>(amplitude),
                           static_cast<std::uint32_t>(std::llround(4294967296.0 * lines[i] / kPeriod)),
                           static_cast<std::uint32_t>(i * 0x1F3D5B79u)};
  }
  const std::vector<double> signal = this->play(50 * kPeriod);
  std::vector<double> ideal(kPeriod);
  for (std::size_t k = 0; k < kPeriod; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i)
      sum += wanted[lines[i]] *
             std::sin(2.0 * std::numbers::pi *
                      (static_cast<double>(lines[i] * k % kPeriod) / kPeriod +
                       static_cast<double>(static_cast<std::uint32_t>(i * 0x1F3D5B79u)) / 4294967296.0));
    ideal[k] = std::round(sum / kStep_V) * kStep_V;
  }
  double rounding = 0.0;
  for (std::size_t harmonic = 1; harmonic < kPeriod / 2; ++harmonic)
    if (wanted[harmonic] == 0.0) rounding = std::max(rounding, amplitude_of(ideal, kPeriod, harmonic));
  for (std::size_t harmonic = 1; harmonic < kPeriod / 2; ++harmonic) {
    const double found = amplitude_of(signal, kPeriod, harmonic);
    if (wanted[harmonic] > 0.0)
      EXPECT_NEAR(20.0 * std::log10(found / wanted[harmonic]), 0.0, 0.1) << "line " << harmonic;
    else
      EXPECT_LT(found, 1.1 * rounding) << "between the lines, at " << harmonic;
  }
}

/// Ten seconds at 20 kHz, one period of the slowest line. Catches oscillators whose amplitude or frequency drifts, and
/// a step that is too coarse for a slow line.
TYPED_TEST(Excitation, ALongPeriodIsAsExactAtItsEnd) {
  constexpr std::uint32_t kPeriod = 200'000;
  constexpr std::array<std::uint32_t, 4> kLines = {1, 77, 9'999, 79'999};
  this->plan.kind = ExcitationKind::multisine;
  this->plan.count = kLines.size();
  this->plan.period = kPeriod;
  for (std::size_t i = 0; i < kLines.size(); ++i)
    this->plan.entry[i] = {volts<TypeParam>(0.5),
                           static_cast<std::uint32_t>(std::llround(std::ldexp(kLines[i], 32) / kPeriod)),
                           static_cast<std::uint32_t>(i * 0x1F3D5B79u)};
  this->generator.start(this->plan);
  double most = 0.1 * kStep_V;  // accumulated rounding of the steps' words, 2^-31 each
  for (const std::uint32_t line : kLines)
    most += 0.5 * kPeriod * std::ldexp(1.0, -30) / std::cos(std::numbers::pi * line / kPeriod);
  EXPECT_LT(most, 2.5 * kStep_V);
  double worst = 0.0;
  for (std::uint32_t k = 0; k < 2 * kPeriod; ++k) {
    double wanted = 0.0;
    for (const auto& line : std::span(this->plan.entry).first(kLines.size())) {
      const std::uint32_t turn = line.second + k % kPeriod * line.first;
      wanted += 0.5 * std::sin(2.0 * std::numbers::pi * std::ldexp(static_cast<double>(turn), -32));
    }
    const double error = std::abs(in_volts(this->generator.next(false)) - wanted);
    if (k > 1) worst = std::max(worst, error);
  }
  EXPECT_LT(worst, most);
}

TYPED_TEST(Excitation, AChirpGoesFromItsFirstFrequencyToItsLast) {
  this->plan.kind = ExcitationKind::chirp;
  this->plan.amplitude = volts<TypeParam>(2.0);
  this->plan.samples = 20'000;
  this->plan.step = 1u << 22;       // 2^-10 turns a sample
  this->plan.last_step = 1u << 26;  // 2^-6
  const std::vector<double> signal = this->play(20'000);
  for (std::size_t k = 100; k < signal.size(); ++k) {
    const double n = static_cast<double>(k);
    const double turns = n / 1024.0 + (1.0 / 64 - 1.0 / 1024) * n * (n - 1.0) / 2.0 / 20'000.0;
    ASSERT_NEAR(signal[k], 2.0 * std::sin(2.0 * std::numbers::pi * turns), 0.004) << k;
  }
}

TYPED_TEST(Excitation, LevelsLastTheirTimeOrUntilTheyAreToTurn) {
  this->plan.kind = ExcitationKind::train;
  this->plan.count = 3;
  this->plan.entry[0] = {volts<TypeParam>(1.0), 3, 0};
  this->plan.entry[1] = {volts<TypeParam>(-2.0), 5, 0};
  this->plan.entry[2] = {volts<TypeParam>(0.0), 1, 0};
  this->generator.start(this->plan);
  const double expected[] = {1, 1, 1, -2, -2, 0, 1, 1, 1, -2};
  for (int k = 0; k < 10; ++k) EXPECT_NEAR(in_volts<TypeParam>(this->generator.next(k == 5)), expected[k], 1e-3) << k;
}

/// A ramp that continued from its present value would keep the axis moving long after breakaway.
TYPED_TEST(Excitation, ARampBeginsAtNothingAgainTheOtherWay) {
  this->plan.kind = ExcitationKind::ramp;
  this->plan.amplitude = volts<TypeParam>(3.0);
  this->plan.period = 1000;
  this->generator.start(this->plan);
  double value = 0.0;
  for (int k = 0; k < 500; ++k) value = in_volts<TypeParam>(this->generator.next(false));
  EXPECT_NEAR(value, 1.5, 0.01);
  EXPECT_NEAR(in_volts<TypeParam>(this->generator.next(true)), -0.003, 0.002);
}

TYPED_TEST(Excitation, ATriangleIsStraightAndGoesAwayInItsFade) {
  this->plan.kind = ExcitationKind::triangle;
  this->plan.input = ExcitationInput::reference;
  this->plan.amplitude = TypeParam(40.0f);
  this->plan.step = this->plan.last_step = 1u << 24;  // 256 samples a turn
  this->plan.fade_samples = 100;
  this->generator.start(this->plan);
  for (int k = 0; k < 256 + 32; ++k) this->generator.next(false);
  const auto counts = [&] {
    return static_cast<double>(firmware::ScalarTraits<TypeParam>::to_float(this->generator.next(false)));
  };
  EXPECT_NEAR(counts(), 20.0, 0.01) << "an eighth of a turn";
  for (int k = 0; k < 63; ++k) counts();
  EXPECT_NEAR(counts(), 20.0, 0.01) << "three eighths";
  this->generator.end();
  EXPECT_FALSE(this->generator.is_gone());
  for (int k = 0; k < 101; ++k) counts();
  EXPECT_TRUE(this->generator.is_gone());
}

TYPED_TEST(Excitation, WhatMakesNoSenseIsImpossible) {
  auto& wanted = this->plan;
  wanted.kind = ExcitationKind::chirp;
  EXPECT_TRUE(is_possible(wanted));
  wanted.input = ExcitationInput::jog;
  EXPECT_FALSE(is_possible(wanted)) << "only a train of velocities is a jog";
  wanted.kind = ExcitationKind::train;
  EXPECT_FALSE(is_possible(wanted)) << "without levels";
  wanted.count = 1;
  EXPECT_FALSE(is_possible(wanted)) << "a level without duration";
  wanted.entry[0].first = 1;
  EXPECT_TRUE(is_possible(wanted));
  wanted.box.travel_counts = 0;
  EXPECT_FALSE(is_possible(wanted)) << "a box without room";
}

}  // namespace
