#include "host/effort/spring_hardening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "host/cancellation.hpp"

namespace host {

namespace {

/// The RMS of a column in the block of every row.
std::vector<double> rms_of_blocks(const EffortRows& rows, const Eigen::MatrixXd& columns) {
  struct Sum {
    double square = 0.0, count = 0.0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Sum> sums;
  const auto sum_of = [&](std::size_t row) -> Sum& { return sums[{rows.record[row], rows.block[row]}]; };
  for (std::size_t row = 0; row < rows.size(); ++row) {
    sum_of(row).square += columns.row(static_cast<Eigen::Index>(row)).squaredNorm();
    sum_of(row).count += 1.0;
  }
  std::vector<double> rms(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) rms[row] = std::sqrt(sum_of(row).square / sum_of(row).count);
  return rms;
}

/// Where the lowest of three errors around `middle`, each a step of log(factor) apart, has its parabola's foot.
double foot_of(const std::array<double, 3>& errors, double middle, double step) {
  const double bend = errors[0] - 2.0 * errors[1] + errors[2];
  return bend > 0.0 ? middle + 0.5 * step * (errors[0] - errors[2]) / bend : middle;
}

}  // namespace

bool SpringHardening::shows_a_gap() const {
  constexpr double kLeast = 1.02;  // four springs, made and real: 0.987 to 1.001; two gaps: 1.03 and 1.10
  constexpr double kShare = 0.08;  // of the pulls' ratio, both as logarithms
  return frequency_ratio > kLeast && std::log(frequency_ratio) > kShare * std::log(pull_ratio);
}

std::optional<SpringHardening> spring_hardening(const sim::DriveDescription& model, const EffortRows& rows,
                                                const std::vector<EffortTerm>& base,
                                                const std::vector<EffortTerm>& beside, const EffortTerm& spring) {
  constexpr double kStep = 0.03;  // of log(frequency)
  constexpr int kSteps = 8;       // either way: a gap that makes more of it leaves a spring no chance
  const std::vector<double> pull = rms_of_blocks(rows, spring.columns);
  std::vector<double> sorted = pull;
  std::ranges::sort(sorted);
  if (sorted.empty()) return {};
  const double middle = sorted[sorted.size() / 2];

  std::array<EffortRows, 2> halves{rows, rows};  // little, much
  std::array<double, 2> square{}, count{};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t half = pull[row] > middle ? 1 : 0;
    halves[half].judges[row] = false;
    halves[1 - half].judges[row] = true;
    square[half] += pull[row] * pull[row];
    count[half] += 1.0;
  }
  if (count[0] == 0.0 || count[1] == 0.0) return {};

  const std::array regressions{EffortRegression(model, halves[0]), EffortRegression(model, halves[1])};
  std::vector<const EffortTerm*> further;
  for (const EffortTerm& term : beside) further.push_back(&term);
  further.push_back(nullptr);
  std::array<std::vector<double>, 2> errors;
  for (int n = -kSteps; n <= kSteps; ++n) {
    throw_if_cancelled();
    const EffortTerm moved = spring.at_frequency(std::exp(kStep * n));
    further.back() = &moved;
    for (const std::size_t half : {0U, 1U}) {
      ScreenedModel tried;
      errors[half].push_back(regressions[half].fit(base, further, tried) ? tried.train : HUGE_VAL);
    }
  }
  std::array<double, 2> frequency{};
  for (const std::size_t half : {0U, 1U}) {
    const auto least = std::ranges::min_element(errors[half]);
    const auto at = least - errors[half].begin();
    if (at == 0 || least + 1 == errors[half].end() || !std::isfinite(least[-1]) || !std::isfinite(least[1])) return {};
    frequency[half] = foot_of({least[-1], least[0], least[1]}, kStep * static_cast<double>(at - kSteps), kStep);
  }
  return SpringHardening{std::exp(frequency[1] - frequency[0]),
                         std::sqrt(square[1] / count[1] / (square[0] / count[0]))};
}

}  // namespace host
