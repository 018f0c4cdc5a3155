// The spectrum of a residual in closed form: its line, its power, and its units.
#include "host/compare/residual_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace host {
namespace {

constexpr double kFrequency_Hz = 12.5, kAmplitude_Nm = 0.3;

/// 20 s of a sine; if `rests`, the axis rests for a fifth of the time.
ResidualEffort humming(bool rests) {
  ResidualEffort samples;
  for (std::size_t slot = 0; slot < 4000; ++slot) {
    if (rests && slot % 100 < 20) continue;
    samples.record.push_back(0);
    samples.slot.push_back(slot);
    samples.missing.push_back(kAmplitude_Nm * std::sin(2.0 * std::numbers::pi * kFrequency_Hz *
                                                       static_cast<double>(slot) * samples.period_s));
  }
  return samples;
}

double power_of(const ScatterSeries& spectrum) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spectrum.x.size(); ++k) sum += spectrum.y[k] * spectrum.y[k];
  return sum * (spectrum.x[1] - spectrum.x[0]);
}

// Parseval's theorem. Catches a two-sided density, a missing window correction, and rests that reduce the density.
TEST(ResidualSpectrum, HoldsThePowerOfASineAtItsFrequency) {
  for (const bool rests : {false, true}) {
    const ScatterSeries spectrum = spectrum_of_residual(humming(rests));
    ASSERT_EQ(spectrum.x.size(), 128U);
    const auto peak = std::ranges::max_element(spectrum.y) - spectrum.y.begin();
    EXPECT_NEAR(spectrum.x[static_cast<std::size_t>(peak)], kFrequency_Hz, 0.4) << "half a line";
    EXPECT_NEAR(power_of(spectrum), kAmplitude_Nm * kAmplitude_Nm / 2.0, 0.02 * kAmplitude_Nm * kAmplitude_Nm);
  }
}

TEST(ResidualSpectrum, IsEmptyWhereTheAxisHardlyMoves) {
  ResidualEffort samples = humming(false);
  samples.record.resize(100);
  samples.slot.resize(100);
  samples.missing.resize(100);
  EXPECT_TRUE(spectrum_of_residual(samples).x.empty());
}

}  // namespace
}  // namespace host
