#include "host/infer/noise_colour.hpp"

#include <algorithm>
#include <cmath>

namespace host {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// With a larger value the drift would be a random walk, and only the differences of rows would matter.
constexpr double kMostDrift = 0.98;

double squares(const NoiseColour& colour, const VectorXd& noise, const VectorXd& weights,
               const std::vector<RowRun>& runs) {
  return weights.dot(colour.whiten(noise, runs).col(0).cwiseAbs2());
}

/// The best drift without white noise, in closed form.
NoiseColour drift_of(const VectorXd& noise, const VectorXd& weights, const std::vector<RowRun>& runs) {
  double product = 0.0, square = 1e-300;
  for (const RowRun& run : runs)
    for (Index k = run.first + 1; k < run.end; ++k) {
      product += weights(k) * noise(k) * noise(k - 1);
      square += weights(k) * noise(k - 1) * noise(k - 1);
    }
  return {.drift = std::clamp(product / square, 0.0, kMostDrift)};
}

}  // namespace

double NoiseColour::innovation() const {
  return std::sqrt((1.0 - drift * drift) / (1.0 - 2.0 * drift * white + white * white));
}

MatrixXd NoiseColour::whiten(const MatrixXd& columns, const std::vector<RowRun>& runs) const {
  MatrixXd left(columns.rows(), columns.cols());
  for (const RowRun& run : runs) {
    const Index length = run.end - run.first;
    left.row(run.first) = innovation() * columns.row(run.first);
    left.middleRows(run.first + 1, length - 1) =
        columns.middleRows(run.first + 1, length - 1) - drift * columns.middleRows(run.first, length - 1);
    if (white == 0.0) continue;
    for (Index c = 0; c < left.cols(); ++c) {
      double* const at = left.col(c).data();
      for (Index k = run.first + 1; k < run.end; ++k) at[k] += white * at[k - 1];
    }
  }
  return left;
}

NoiseColour colour_of(NoiseKind kind, const VectorXd& noise, const VectorXd& weights, const std::vector<RowRun>& runs) {
  if (kind == NoiseKind::drift) return drift_of(noise, weights, runs);
  NoiseColour best;
  double least = squares(best, noise, weights, runs);
  const auto try_at = [&](double drift, double white) {
    NoiseColour one{.drift = std::clamp(drift, 0.0, kMostDrift)};
    one.white = std::clamp(white, 0.0, one.drift);
    const double sum = squares(one, noise, weights, runs);
    if (!(sum < least)) return false;
    least = sum;
    best = one;
    return true;
  };
  // The sum is flat along drift = white and may have two local minima. So it is searched on a grid, and then with
  // halved steps from the best point.
  for (const double drift : {0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.98})
    for (const double part : {0.0, 0.3, 0.6, 0.8, 0.9}) try_at(drift, part * drift);
  for (double step = 0.1; step > 0.002; step *= 0.5)
    while (try_at(best.drift + step, best.white) || try_at(best.drift - step, best.white) ||
           try_at(best.drift, best.white + step) || try_at(best.drift, best.white - step) ||
           try_at(best.drift + step, best.white + step) || try_at(best.drift - step, best.white - step)) {
    }
  return best;
}

}  // namespace host
