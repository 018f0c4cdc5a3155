#include "host/identify/friction_fit.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/dense_matrix.hpp"
#include "host/identify/least_squares.hpp"

namespace host {

namespace {

/// Range of the velocity constants: from this part of the slowest speed to this part of the top speed. So the fast
/// points (in the paper: above a quarter of the top speed) determine Coulomb and viscous friction alone.
constexpr double kLeastOmegaShare = 0.3;
constexpr double kMostOmegaShare = 0.25;

/// Parameters of one direction in the solver. Velocity constants are logarithms, because they are positive, span
/// decades, and the points determine their relative size.
enum SideIndex : Eigen::Index { kCoulomb, kStaticRise, kLogOmega1, kLogOmega2, kSideSize };

using Parameters = Eigen::VectorXd;  ///< [B, side 0 ..., side 1 ...]; without side 1 if symmetric

struct Layout {
  bool symmetric = false;
  bool stribeck = true;
  Eigen::Index side_size() const { return stribeck ? Eigen::Index{kSideSize} : Eigen::Index{1}; }
  Eigen::Index size() const { return 1 + (symmetric ? 1 : 2) * side_size(); }
  Eigen::Index side(bool forward) const { return forward || symmetric ? 1 : 1 + side_size(); }
};

/// Eq. (19) for one point: magnitude at speed v.
template <typename T>
T curve(const T& viscous, const T* side, bool stribeck, double v) {
  using std::exp;
  T level = side[kCoulomb];
  if (stribeck) {
    const T fading = exp(-v * exp(-side[kLogOmega1])), rising = exp(-v * exp(-side[kLogOmega2]));
    level = (side[kCoulomb] + side[kStaticRise]) * fading + side[kCoulomb] * (T(1.0) - rising);
  }
  return level + viscous * v;
}

struct PointCost {
  CurvePoint point;
  double weight;
  Layout layout;
  template <typename T>
  bool operator()(T const* const* parameters, T* residual) const {
    const T* all = parameters[0];
    const bool forward = point.speed > 0.0;
    const T magnitude = curve(all[0], all + layout.side(forward), layout.stribeck, std::abs(point.speed));
    residual[0] = weight * (magnitude - std::abs(point.effort) * (forward == (point.effort > 0.0) ? 1.0 : -1.0));
    return true;
  }
};

struct Candidate {
  Layout layout;
  Parameters parameters;
  Eigen::MatrixXd jacobian;  ///< of the weighted residuals
  double cost = HUGE_VAL;    ///< sum of the squared weighted residuals
};

/// Range of the velocity constants, and the start values of the levels.
struct Range {
  double slowest = HUGE_VAL, top = 0.0, level = 0.0;
};

Range range_of(const std::vector<CurvePoint>& points) {
  Range range;
  for (const CurvePoint& point : points) {
    range.slowest = std::min(range.slowest, std::abs(point.speed));
    range.top = std::max(range.top, std::abs(point.speed));
    range.level = std::max(range.level, std::abs(point.effort));
  }
  return range;
}

std::vector<double> weights_of(const std::vector<CurvePoint>& points, double level) {
  // The friction law is not exact either, so each point has an error of at least 0.1 % of the largest friction.
  std::vector<double> weights;
  for (const CurvePoint& point : points) weights.push_back(1.0 / std::hypot(point.standard_error, 1e-3 * level));
  return weights;
}

Candidate solve_from(const std::vector<CurvePoint>& points, const std::vector<double>& weights, const Layout& layout,
                     const Range& range, Parameters start) {
  ceres::Problem problem;
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<PointCost, 9>(new PointCost{points[k], weights[k], layout});
    cost->AddParameterBlock(static_cast<int>(layout.size()));
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(cost, nullptr, start.data());
  }
  for (Eigen::Index at = 1; at < layout.size(); at += layout.side_size()) {
    problem.SetParameterLowerBound(start.data(), static_cast<int>(at + kCoulomb), 0.0);
    if (!layout.stribeck) continue;
    problem.SetParameterLowerBound(start.data(), static_cast<int>(at + kStaticRise), 0.0);
    for (const auto omega : {kLogOmega1, kLogOmega2}) {
      problem.SetParameterLowerBound(start.data(), static_cast<int>(at + omega),
                                     std::log(kLeastOmegaShare * range.slowest));
      problem.SetParameterUpperBound(start.data(), static_cast<int>(at + omega), std::log(kMostOmegaShare * range.top));
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  Candidate candidate;
  candidate.layout = layout;
  candidate.parameters = start;
  std::vector<double> residuals;
  ceres::CRSMatrix sparse;
  double half = 0.0;
  if (!problem.Evaluate({}, &half, &residuals, nullptr, &sparse)) return candidate;  // its cost stays infinite
  candidate.cost = 2.0 * half;
  candidate.jacobian = dense_matrix(sparse);
  return candidate;
}

/// The best result of several starts, with velocity constants spread over the decades between slowest and top speed.
Candidate solve(const std::vector<CurvePoint>& points, const Layout& layout) {
  const Range range = range_of(points);
  const std::vector<double> weights = weights_of(points, range.level);
  Candidate best;
  constexpr double kSpread[] = {0.15, 0.35, 0.55, 0.75};
  const double span = std::log(kMostOmegaShare * range.top / range.slowest);
  for (const double first : kSpread) {
    for (const double second : kSpread) {
      Parameters start = Parameters::Zero(layout.size());
      for (Eigen::Index at = 1; at < layout.size(); at += layout.side_size()) {
        start(at + kCoulomb) = 0.7 * range.level;
        if (!layout.stribeck) continue;
        start(at + kStaticRise) = 0.3 * range.level;
        start(at + kLogOmega1) = std::log(range.slowest) + first * span;
        start(at + kLogOmega2) = std::log(range.slowest) + second * span;
      }
      Candidate candidate = solve_from(points, weights, layout, range, std::move(start));
      if (candidate.cost < best.cost) best = std::move(candidate);
      if (!layout.stribeck) return best;  // linear: one start is enough
    }
  }
  return best;
}

double information_criterion(const Candidate& candidate, std::size_t points) {
  const double n = static_cast<double>(points);
  return n * std::log(std::max(candidate.cost, 1e-300) / n) +
         static_cast<double>(candidate.layout.size()) * std::log(n);
}

FrictionFit describe(const Candidate& best, const std::vector<CurvePoint>& points) {
  if (!std::isfinite(best.cost))
    throw Failure(ExitCode::refused,
                  "no friction curve fits the constant speeds: their torques or forces leave the "
                  "range of numbers; check units and scales");
  const Layout& layout = best.layout;
  const double degrees = std::max(1.0, static_cast<double>(points.size()) - static_cast<double>(layout.size()));
  const double excess = std::max(1.0, best.cost / degrees);  // excess scatter widens the intervals
  const RightSingular svd = right_singular(best.jacobian);
  const Eigen::VectorXd singular = svd.values.cwiseMax(1e-12 * svd.values(0));
  const Eigen::MatrixXd root = svd.vectors * singular.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd covariance = excess * root * root.transpose();
  const double quantile = student_t_95(degrees);
  const auto half_of = [&](const Eigen::VectorXd& gradient) {
    return quantile * std::sqrt(gradient.dot(covariance * gradient));
  };
  const auto unit = [&](Eigen::Index k) { return Eigen::VectorXd::Unit(layout.size(), k); };
  const auto linear = [&](double value, const Eigen::VectorXd& gradient) {
    const double half = half_of(gradient);
    return Estimate{value, {value - half, value + half}};
  };
  const Range range = range_of(points);
  const auto logarithmic = [&](Eigen::Index k) {
    // The interval of a parameter that is not determined is its search range.
    const double lowest = kLeastOmegaShare * range.slowest;
    const double value = std::exp(best.parameters(k)), half = half_of(unit(k));
    const double highest = kMostOmegaShare * range.top, reach = std::log(highest / lowest);
    const double factor = std::exp(std::min(half, reach));
    return Estimate{value, {std::max(value / factor, lowest), std::min(value * factor, highest)}};
  };

  FrictionFit fit;
  fit.has_stribeck = layout.stribeck;
  fit.viscous = linear(best.parameters(0), unit(0));
  fit.law.viscous = best.parameters(0);
  for (std::size_t d = 0; d < 2; ++d) {
    const Eigen::Index at = layout.side(d == 0);
    FrictionSideLaw& law = d == 0 ? fit.law.positive : fit.law.negative;
    law.coulomb = law.static_level = best.parameters(at + kCoulomb);
    fit.coulomb[d] = fit.static_level[d] = linear(law.coulomb, unit(at + kCoulomb));
    if (!layout.stribeck) continue;
    law.static_level = law.coulomb + best.parameters(at + kStaticRise);
    fit.static_level[d] = linear(law.static_level, unit(at + kCoulomb) + unit(at + kStaticRise));
    fit.omega1[d] = logarithmic(at + kLogOmega1);
    fit.omega2[d] = logarithmic(at + kLogOmega2);
    law.omega1 = fit.omega1[d].value;
    law.omega2 = fit.omega2[d].value;
  }
  double squares = 0.0;
  for (const CurvePoint& point : points) squares += std::pow(point.effort - fit.law.effort(point.speed), 2);
  fit.rms = std::sqrt(squares / static_cast<double>(points.size()));
  return fit;
}

/// Number of speeds in one direction that differ by a tenth or more.
std::size_t distinct_speeds(const std::vector<CurvePoint>& points, bool forward) {
  std::set<double> logarithms;
  for (const CurvePoint& point : points) {
    if ((point.speed > 0.0) == forward) logarithms.insert(std::log(std::abs(point.speed)));
  }
  std::size_t count = 0;
  double last = -HUGE_VAL;
  for (const double logarithm : logarithms) {
    if (logarithm - last < 0.1) continue;
    last = logarithm;
    ++count;
  }
  return count;
}

void require_speeds(const std::vector<CurvePoint>& points) {
  for (const bool forward : {true, false}) {
    const std::size_t speeds = distinct_speeds(points, forward);
    if (speeds >= 2) continue;
    throw Failure(ExitCode::refused,
                  fmt::format("only {} constant speed{} {} found; a friction curve needs at least two in each "
                              "direction, held for 0.3 s or more. Jog at several speeds in both directions, for "
                              "example 0.1, 0.3, 0.5, 1, 3, 5, 10, 25, 50, 75, 100 mm/s",
                              speeds, speeds == 1 ? "" : "s", forward ? "forward" : "backward"));
  }
}

/// Each direction has four values and shares the slope, so fewer than five speeds per direction cannot determine the
/// Stribeck part.
bool can_tell_stribeck(const std::vector<CurvePoint>& points) {
  constexpr std::size_t kFewest = 5;
  const Range range = range_of(points);
  return distinct_speeds(points, true) >= kFewest && distinct_speeds(points, false) >= kFewest &&
         kMostOmegaShare * range.top > range.slowest;
}

}  // namespace

FrictionFit fit_friction(const std::vector<CurvePoint>& points, bool symmetric) {
  require_speeds(points);
  const Candidate plain = solve(points, {.symmetric = symmetric, .stribeck = false});
  if (!can_tell_stribeck(points)) return describe(plain, points);
  const Layout full{.symmetric = symmetric, .stribeck = true};
  const Candidate stribeck = solve(points, full);
  const bool preferred = information_criterion(stribeck, points.size()) < information_criterion(plain, points.size());
  return describe(preferred ? stribeck : plain, points);
}

}  // namespace host
