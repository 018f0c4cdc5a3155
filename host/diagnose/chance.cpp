#include "host/diagnose/chance.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace host {

double confidence_of_improvement(const SetError& before, const SetError& after, std::size_t block,
                                 double common_square) {
  constexpr int kDraws = 2000;
  const std::size_t count = std::min(before.windows.size(), after.windows.size());
  std::vector<double> gains;
  for (std::size_t begin = 0; begin < count; begin += block) {
    double gain = 0.0;
    for (std::size_t k = begin; k < std::min(count, begin + block); ++k)
      gain += before.windows[k].weighed(common_square) - after.windows[k].weighed(common_square);
    gains.push_back(gain);
  }
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

}  // namespace host
