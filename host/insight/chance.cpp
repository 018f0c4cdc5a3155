#include "host/insight/chance.hpp"

#include <algorithm>
#include <random>
#include <vector>

namespace host {

double confidence_of_improvement(const SetError& before, const SetError& after) {
  // Errors of neighbouring windows belong to the same motion: blocks of ten windows are drawn together.
  constexpr std::size_t kBlock = 10;
  constexpr int kDraws = 2000;
  const std::size_t count = std::min(before.windows.size(), after.windows.size());
  std::vector<double> gains;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    double gain = 0.0;
    for (std::size_t k = begin; k < std::min(count, begin + kBlock); ++k)
      gain += before.windows[k].x + before.windows[k].w - after.windows[k].x - after.windows[k].w;
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
