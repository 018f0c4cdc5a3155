// Even and odd powers of a static nonlinearity at lines without excitation; expected values by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/response/frequency_response.hpp"

namespace {

constexpr std::size_t kPeriod = 512;
const std::vector<std::size_t> kLines{5, 9, 13, 21, 25, 33, 37, 45};

/// speed = u + even u^2 + odd u^3 + noise.
std::vector<host::Record> runs_of(double even, double odd, double noise) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> turns(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<host::Record> records;
  for (int run = 0; run < 4; ++run) {
    host::Record record;
    record.path = "run";
    record.sample_period_s = 1e-3;
    std::vector<double> phases;
    std::string lines, words;
    for (const std::size_t line : kLines) {
      phases.push_back(turns(random));
      lines += std::to_string(line) + " ";
      words += std::to_string(phases.back()) + " ";
    }
    for (std::size_t k = 0; k < 6 * kPeriod; ++k) {
      double u = 0.0;
      for (std::size_t i = 0; i < kLines.size(); ++i)
        u += 0.3 * std::sin(2.0 * std::numbers::pi * (static_cast<double>(kLines[i] * k) / kPeriod + phases[i]));
      record.t_s.push_back(1e-3 * static_cast<double>(k));
      record.u_V.push_back(u);
      record.w.push_back(u + even * u * u + odd * u * u * u + noise * normal(random));
    }
    record.header = {{"excitation", "multisine"},
                     {"excitation_input", "open loop"},
                     {"excitation_period_samples", std::to_string(kPeriod)},
                     {"excitation_lines", lines.substr(0, lines.size() - 1)},
                     {"excitation_phases_turns", words.substr(0, words.size() - 1)}};
    records.push_back(std::move(record));
  }
  return records;
}

double root_mean_square(const std::vector<host::DistortionLine>& lines) {
  double squares = 0.0;
  for (const host::DistortionLine& line : lines) squares += line.level * line.level;
  return std::sqrt(squares / static_cast<double>(lines.size()));
}

TEST(Distortion, OfAnEvenPowerIsInEvenLinesAlone) {
  const auto response = host::frequency_response(runs_of(0.1, 0.0, 0.0));
  EXPECT_EQ(response.even.size(), kLines.size() - 1) << "every gap has even lines";
  EXPECT_GT(root_mean_square(response.even), 0.02);
  EXPECT_LT(root_mean_square(response.odd), 1e-6);
}

TEST(Distortion, OfAnOddPowerIsInOddLinesAlone) {
  const auto response = host::frequency_response(runs_of(0.0, 0.1, 0.0));
  EXPECT_EQ(response.odd.size(), kLines.size() - 1);
  EXPECT_GT(root_mean_square(response.odd), 0.02);
  EXPECT_LT(root_mean_square(response.even), 1e-6);
}

/// Noise alone is not distortion: noise of 0.2 leaves 0.026 in the mean of five periods, which is subtracted.
TEST(Distortion, IsNotWhatNoiseLeaves) {
  const auto noisy = host::frequency_response(runs_of(0.0, 0.0, 0.2));
  EXPECT_LT(root_mean_square(noisy.even), 0.01);
  const auto both = host::frequency_response(runs_of(0.1, 0.0, 0.2));
  const auto clean = host::frequency_response(runs_of(0.1, 0.0, 0.0));
  EXPECT_NEAR(root_mean_square(both.even), root_mean_square(clean.even), 0.1 * root_mean_square(clean.even));
}

}  // namespace
