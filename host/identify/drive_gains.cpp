#include "host/identify/drive_gains.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr int kChanges = 5;  // a dead time of three samples and the step response of a current loop

}  // namespace

std::optional<AmplifierGain> amplifier_gain(const std::vector<Record>& records, double dac_limit_V) {
  constexpr double kFollows = 0.1;
  std::size_t rows = 0;
  for (const Record& record : records) {
    if (record.u_V.empty() || record.i_A.empty()) return {};
    rows += record.size();
  }
  if (records.empty()) return {};
  BlockedRegression<2 + kChanges> regression(rows_per_block(rows, records.front().sample_period_s));
  Eigen::Matrix<double, 2 + kChanges, 2 + kChanges> moment = decltype(moment)::Zero();
  double sum = 0.0, squares = 0.0;
  std::size_t count = 0;
  for (const Record& record : records) {
    for (std::size_t k = kChanges; k < record.size(); ++k) {
      const double* const u = &record.u_V[k];
      const bool is_free = std::all_of(u - kChanges, u + 1, [&](double one) { return std::abs(one) < dac_limit_V; });
      if (!is_free || !std::isfinite(record.i_A[k])) continue;
      BlockedRegression<2 + kChanges>::Row row;
      row << u[0], 1.0, u[0] - u[-1], u[-1] - u[-2], u[-2] - u[-3], u[-3] - u[-4], u[-4] - u[-5];
      regression.add(row, record.i_A[k]);
      moment += row * row.transpose();
      sum += record.i_A[k];
      squares += record.i_A[k] * record.i_A[k];
      ++count;
    }
    regression.end_block();
  }
  const Regression found = regression.solve();
  const double norm = squares - sum * sum / static_cast<double>(std::max<std::size_t>(count, 1));
  // Only few blocks contain steps of the command, so their scatter may be less than the variance of white noise.
  const double white =
      std::pow(found.relative_residual, 2) * squares / static_cast<double>(count) * moment.inverse()(0, 0);
  const double gain = found.parameters(0);
  const double half = found.t_quantile * std::sqrt(std::max(found.covariance(0, 0), white));
  // The residual relative to the current about its mean, because an offset explains nothing.
  const double left = found.relative_residual * std::sqrt(squares / norm);
  if (!(norm > 0.0) || !(left < kFollows) || !(gain > 0.0) || !std::isfinite(half)) return {};
  return AmplifierGain{{gain, {gain - half, gain + half}}, found.parameters(1), left};
}

GainCheck check_gain(const Estimate& bare, const Estimate& loaded, double added, double assumed) {
  const double grown = loaded.value - bare.value, half = std::hypot(bare.half_width(), loaded.half_width());
  if (!(grown > half))
    throw Failure(
        ExitCode::refused,
        fmt::format("the added inertia of {:.4g} does not show: the identified one grows by {:.3g} +- {:.2g}. "
                    "Add more (a quarter of {:.3g} or more), and excite both records alike",
                    added, grown, half, bare.value));
  GainCheck check{added, grown, {}, {}, assumed, assumed * added / grown};
  const auto factor_at = [&](double one) { return added / one; };
  check.factor = {factor_at(grown), {factor_at(grown + half), factor_at(grown - half)}};
  // J = added * bare / (loaded - bare): both estimates affect it.
  const double value = added * bare.value / grown;
  const double spread =
      added / (grown * grown) * std::hypot(loaded.value * bare.half_width(), bare.value * loaded.half_width());
  check.inertia = {value, {value - spread, value + spread}};
  return check;
}

}  // namespace host
