#include "host/axes/circle_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/dense_solutions.hpp"

namespace host {

namespace {

constexpr std::size_t kBins = 360;
using Curve = std::array<double, kBins>;  ///< radial deviation by degree, um; NaN without a sample

const std::vector<double>& seen(const CirclePass& pass) {
  return pass.outer_um.empty() ? pass.encoder_um : pass.outer_um;
}

double angle_of(std::size_t bin) { return (static_cast<double>(bin) + 0.5) * std::numbers::pi / 180.0; }

Curve curve_of(const CirclePass& pass) {
  Curve sum{};
  std::array<int, kBins> count{};
  for (std::size_t k = 0; k < pass.t_s.size(); ++k) {
    const double degrees = pass.angle_rad[k] * 180.0 / std::numbers::pi;
    const auto bin = static_cast<std::size_t>(std::floor(degrees < 0.0 ? degrees + 360.0 : degrees)) % kBins;
    sum[bin] += seen(pass)[k];
    ++count[bin];
  }
  for (std::size_t i = 0; i < kBins; ++i) sum[i] = count[i] > 0 ? sum[i] / count[i] : std::nan("");
  return sum;
}

/// Shifts the curves to their common least-squares centre.
void centre(std::vector<Curve*> curves) {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(3);
  const auto row = [](std::size_t i) { return Eigen::Vector3d(1.0, std::cos(angle_of(i)), std::sin(angle_of(i))); };
  for (const Curve* curve : curves)
    for (std::size_t i = 0; i < kBins; ++i)
      if (std::isfinite((*curve)[i])) {
        gram += row(i) * row(i).transpose();
        pull += row(i) * (*curve)[i];
      }
  Eigen::VectorXd off = symmetric_solution(gram, pull);
  off(0) = 0.0;
  for (Curve* curve : curves)
    for (std::size_t i = 0; i < kBins; ++i) (*curve)[i] -= off.dot(row(i));
}

std::array<double, 2> range(const std::vector<const Curve*>& curves) {
  std::array<double, 2> found{HUGE_VAL, -HUGE_VAL};
  for (const Curve* curve : curves)
    for (const double value : *curve)
      if (std::isfinite(value)) found = {std::min(found[0], value), std::max(found[1], value)};
  return found;
}

/// Whether deviations from the nominal centre count. A ballbar is not mounted at the nominal centre, so its
/// eccentricity is not an error of the machine.
bool is_about_nominal(const CirclePass& pass) { return pass.outer_um.empty() && pass.has_reference; }

}  // namespace

std::vector<CircleFigures> circle_figures(const std::vector<CirclePass>& passes) {
  std::vector<CircleFigures> list;
  for (const CirclePass& pass : passes) {
    Curve as_seen = curve_of(pass), centred = as_seen;
    centre({&centred});
    const auto about = range({is_about_nominal(pass) ? &as_seen : &centred}), round = range({&centred});
    list.push_back({round[1] - round[0], about[1], about[0]});
  }
  return list;
}

std::optional<BidirectionalFigures> bidirectional_figures(const std::vector<CirclePass>& passes) {
  std::optional<BidirectionalFigures> worst;
  for (const CirclePass& ccw : passes)
    for (const CirclePass& cw : passes) {
      if (!ccw.is_ccw || cw.is_ccw || std::abs(ccw.feed_mm_s - cw.feed_mm_s) > 0.05 * ccw.feed_mm_s) continue;
      Curve a = curve_of(ccw), b = curve_of(cw);
      centre({&a, &b});
      const auto both = range({&a, &b});
      BidirectionalFigures found{both[1] - both[0], 0.0};
      for (std::size_t i = 0; i < kBins; ++i)
        if (std::isfinite(a[i] - b[i])) found.H_um = std::max(found.H_um, std::abs(a[i] - b[i]));
      if (!worst || found.Gb_um > worst->Gb_um) worst = found;
    }
  return worst;
}

}  // namespace host
