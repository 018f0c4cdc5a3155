#include "host/compare/chance.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace host {

namespace {

constexpr int kDraws = 2000;

/// Gain of `after` over `before` for each block of consecutive windows.
std::vector<double> gains_of(const std::vector<double>& before, const std::vector<double>& after, std::size_t block) {
  const std::size_t count = std::min(before.size(), after.size());
  std::vector<double> gains;
  for (std::size_t begin = 0; begin < count; begin += block) {
    double gain = 0.0;
    for (std::size_t k = begin; k < std::min(count, begin + block); ++k) gain += before[k] - after[k];
    gains.push_back(gain);
  }
  return gains;
}

}  // namespace

std::size_t windows_in(double span_s, const RecordSet& set) {
  return std::max<std::size_t>(1,
                               static_cast<std::size_t>(std::lround(span_s / set.records.front().prepared.window_s())));
}

double confidence_of_improvement(const std::vector<double>& before, const std::vector<double>& after,
                                 std::size_t block) {
  const std::vector<double> gains = gains_of(before, after, block);
  if (gains.empty()) return 0.0;
  std::mt19937 random(1);  // a fixed seed: the same records give the same answer
  std::uniform_int_distribution<std::size_t> pick(0, gains.size() - 1);
  int better = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    double sum = 0.0;
    for (std::size_t k = 0; k < gains.size(); ++k) sum += gains[pick(random)];
    if (sum > 0.0) ++better;
  }
  return static_cast<double>(better) / kDraws;
}

double probability_of_luck(const std::vector<double>& before, const std::vector<double>& after, std::size_t tried,
                           std::size_t block) {
  constexpr int kSigns = 10000;
  const std::vector<double> gains = gains_of(before, after, block);
  double observed = 0.0;
  for (const double gain : gains) observed += gain;
  if (!(observed > 0.0)) return 1.0;
  std::mt19937 random(1);
  int as_good = 1;  // the observed signs are one of the possible combinations
  for (int draw = 0; draw < kSigns; ++draw) {
    double sum = 0.0;
    std::uint_fast32_t bits = 0;
    for (std::size_t k = 0; k < gains.size(); ++k) {
      if (k % 32 == 0) bits = random();
      sum += (bits >> (k % 32)) & 1U ? gains[k] : -gains[k];
    }
    if (sum >= observed) ++as_good;
  }
  return std::min(1.0, static_cast<double>(tried) * as_good / (kSigns + 1));
}

double probability_of_luck(const SetError& before, const SetError& after, std::size_t tried, const RecordSet& set) {
  return probability_of_luck(before.window_log_loss, after.window_log_loss, tried, windows_in(kLuckBlock_s, set));
}

}  // namespace host
