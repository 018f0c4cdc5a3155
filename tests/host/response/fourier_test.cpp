// The transform equals its definition, from several threads at once.
#include "host/fourier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

namespace {

/// The defining sum of a line.
std::complex<double> line_of(const std::vector<double>& x, std::size_t line) {
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
    sum +=
        x[k] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(line * k) / static_cast<double>(x.size()));
  return sum;
}

std::vector<double> signal_of(std::size_t length) {
  std::vector<double> x(length);
  for (std::size_t k = 0; k < length; ++k)
    x[k] = std::sin(0.7 * static_cast<double>(k)) + 0.01 * static_cast<double>(k % 7);
  return x;
}

TEST(Fourier, LinesAreTheSumsOfTheirDefinition) {
  for (const std::size_t length : {1U, 2U, 33U, 100U}) {
    const std::vector<double> x = signal_of(length);
    const auto lines = host::spectrum_of(x);
    ASSERT_EQ(lines.size(), length / 2 + 1);
    for (std::size_t line = 0; line < lines.size(); ++line)
      EXPECT_LT(std::abs(lines[line] - line_of(x, line)), 1e-10) << length << ' ' << line;
  }
}

TEST(Fourier, ThreadsMayTransformAtOnce) {
  constexpr std::size_t kThreads = 8;
  std::vector<double> worst(kThreads, 0.0);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < kThreads; ++n)
    threads.emplace_back([&worst, n] {
      for (std::size_t length = 40 + n; length < 140; length += kThreads) {
        const std::vector<double> x = signal_of(length);
        const auto lines = host::spectrum_of(x);
        worst[n] = std::max(worst[n], std::abs(lines[length / 3] - line_of(x, length / 3)));
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const double error : worst) EXPECT_LT(error, 1e-9);
}

TEST(Fourier, HannWindowsThatOverlapByHalfAddUpToOne) {
  const std::vector<double> window = host::hann_window(64);
  for (std::size_t k = 0; k < 32; ++k) EXPECT_NEAR(window[k] + window[k + 32], 1.0, 1e-15);
  EXPECT_EQ(window[0], 0.0);
}

}  // namespace
