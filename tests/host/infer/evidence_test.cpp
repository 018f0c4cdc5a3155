// Rows from a random number generator, with expected values in closed form.
#include "host/infer/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/infer/posterior.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 400;

VectorXd autoregressive(double correlation, double scale, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, scale);
  VectorXd noise(kRows);
  noise(0) = normal(random) / std::sqrt(1.0 - correlation * correlation);
  for (Index k = 1; k < kRows; ++k) noise(k) = correlation * noise(k - 1) + normal(random);
  return noise;
}

MatrixXd line() {
  MatrixXd columns(kRows, 2);
  columns.col(0).setOnes();
  columns.col(1) = VectorXd::LinSpaced(kRows, -1.0, 1.0);
  return columns;
}

VectorXd wave(double waves) { return (VectorXd::LinSpaced(kRows, 0.0, 2.0 * 3.14159265358979 * waves)).array().sin(); }

/// Hats over the row number.
host::Memory memory_over_rows() {
  host::Memory memory;
  constexpr Index kKnots = 10;
  memory.columns = MatrixXd::Zero(kRows, kKnots);
  for (Index k = 0; k < kRows; ++k) {
    const double at = static_cast<double>(k) / (kRows - 1) * (kKnots - 1);
    const auto n = std::min<Index>(static_cast<Index>(at), kKnots - 2);
    memory.columns(k, n) = 1.0 - (at - static_cast<double>(n));
    memory.columns(k, n + 1) = at - static_cast<double>(n);
  }
  memory.groups = {{"position", 0, kKnots}};
  memory.usual = 1.0;
  return memory;
}

host::Evidence evidence_of(const VectorXd& y) { return host::Evidence(y, {{0, kRows}}, memory_over_rows(), 1e-3); }

MatrixXd with(const VectorXd& column) {
  MatrixXd columns(kRows, 3);
  columns << line(), column;
  return columns;
}

const VectorXd kWide2 = VectorXd::Constant(2, 10.0);
const VectorXd kWide3 = (VectorXd(3) << 10.0, 10.0, 0.3).finished();

}  // namespace

TEST(Evidence, FindsNoiseAndItsCorrelation) {
  const host::EvidenceFit fit =
      evidence_of(line() * Eigen::Vector2d(2.0, 1.0) + autoregressive(0.6, 0.1, 1)).fit(line(), kWide2);
  EXPECT_NEAR(fit.colour.from_row_to_row(), 0.6, 0.1);
  // The scale of Student's t with 4 degrees of freedom is below the standard deviation of Gaussian noise.
  EXPECT_GT(fit.noise, 0.06);
  EXPECT_LT(fit.noise, 0.11);
  EXPECT_NEAR(fit.factors(0), 2.0, 0.1);
}

/// A drift of 0.95 per row and white noise of three times its step. A single correlation cannot describe both.
TEST(NoiseColour, TellsADriftFromTheWhiteNoiseBesideIt) {
  constexpr Index kMany = 8000;
  constexpr double kDrift = 0.95, kStep = 0.1, kWhite = 0.3;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  VectorXd noise(kMany);
  double drift = 0.0;
  for (Index k = 0; k < kMany; ++k) {
    drift = kDrift * drift + kStep * normal(random);
    noise(k) = drift + kWhite * normal(random);
  }
  const host::NoiseColour colour =
      host::colour_of(host::NoiseKind::drift_and_white, noise, VectorXd::Ones(kMany), {{0, kMany}});
  const double of_drift = kStep * kStep / (1.0 - kDrift * kDrift);
  EXPECT_NEAR(colour.drift, kDrift, 0.02);
  EXPECT_NEAR(colour.from_row_to_row(), kDrift * of_drift / (of_drift + kWhite * kWhite), 0.05);
  const VectorXd left = colour.whiten(noise, {{0, kMany}});
  EXPECT_NEAR(left.head(kMany - 1).dot(left.tail(kMany - 1)) / left.squaredNorm(), 0.0, 3.0 / std::sqrt(1.0 * kMany));
}

TEST(Evidence, NoiseThatIsCorrelatedIsNoEffect) {
  // A period that is claimed from correlated noise alone costs a mechanic a day, so at most a few of 100 draws may do
  // so.
  int claimed = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const host::Evidence evidence = evidence_of(autoregressive(0.8, 0.1, seed));
    const double odds = evidence.fit(with(wave(3.0)), kWide3).log_evidence - evidence.fit(line(), kWide2).log_evidence;
    if (host::posterior({0.0, odds})[1] >= host::kClaimed) ++claimed;
  }
  EXPECT_LE(claimed, 5);
}

TEST(Evidence, AWaveIsFoundInCorrelatedNoise) {
  const host::Evidence evidence = evidence_of(0.3 * wave(25.0) + autoregressive(0.5, 0.1, 3));
  EXPECT_GT(evidence.fit(with(wave(25.0)), kWide3).log_evidence - evidence.fit(line(), kWide2).log_evidence, 20.0);
}

TEST(Evidence, WhatIsSmoothGoesToTheMemoryRatherThanToTheNearestEffect) {
  // A bump: half a wave is the closest of all candidates.
  const VectorXd bump = (-(VectorXd::LinSpaced(kRows, -4.0, 4.0).array()).square()).exp();
  const host::Evidence evidence = evidence_of(2.0 * bump + autoregressive(0.3, 0.05, 5));
  const VectorXd half = (VectorXd::LinSpaced(kRows, 0.0, 3.14159265358979)).array().sin();
  const double beside = evidence.fit(with(half), kWide3).log_evidence - evidence.fit(line(), kWide2).log_evidence;
  EXPECT_LT(beside, std::log(host::kClaimed / (1.0 - host::kClaimed))) << "it would be claimed";
  EXPECT_GT(evidence.fit(line(), kWide2).sizes(0), 20.0 * evidence.no_memory()(0));
}

TEST(Evidence, OneWildRowDecidesNothing) {
  VectorXd y = autoregressive(0.0, 0.1, 7);
  VectorXd spike = VectorXd::Zero(kRows);
  spike.segment(200, 3).setOnes();
  y(201) += 5.0;
  const host::Evidence evidence = evidence_of(y);
  EXPECT_LT(evidence.fit(with(spike), kWide3).log_evidence - evidence.fit(line(), kWide2).log_evidence, 1.0);
}

TEST(Evidence, ApproximateGainsAgreeWithFitsAtTheSameNoise) {
  const host::Evidence evidence = evidence_of(0.05 * wave(25.0) + autoregressive(0.5, 0.1, 9));
  const host::EvidenceFit before = evidence.fit(line(), kWide2);
  const VectorXd gains = evidence.gains(before, wave(25.0), {0}, VectorXd::Constant(1, 0.3));
  EXPECT_NEAR(gains(0), evidence.fit_from(before, with(wave(25.0)), kWide3).log_evidence - before.log_evidence, 1.5);
}

TEST(Posterior, OfEqualEvidenceIsEqual) {
  const std::vector<double> probabilities = host::posterior({-1000.0, -1000.0});
  EXPECT_NEAR(probabilities[0], 0.5, 1e-9);
  EXPECT_NEAR(probabilities[1], 0.5, 1e-9);
}
