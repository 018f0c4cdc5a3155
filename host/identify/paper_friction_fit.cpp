// The friction fit of section 3.2, step by step as printed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/identify/friction_fit.hpp"

namespace host {

namespace {

constexpr double kFastShare = 0.25;       // 15.7 of 62.8 rad/s
constexpr double kGridPointShare = 0.01;  // N1 = 4: 0.628 of 62.8 rad/s
constexpr double kGridReachShare = 10.0 / 62.832;
constexpr int kGridSteps = 100;
constexpr double kSpeedTolerance = 0.95;  // a measured speed differs a little from the commanded one

/// Magnitudes in one direction, by ascending speed, one point per speed.
std::vector<CurvePoint> one_direction(const std::vector<CurvePoint>& points, bool forward) {
  std::vector<CurvePoint> side;
  for (const CurvePoint& point : points) {
    if ((point.speed > 0.0) == forward)
      side.push_back({std::abs(point.speed), forward ? point.effort : -point.effort, 0});
  }
  std::ranges::sort(side, {}, &CurvePoint::speed);
  std::vector<CurvePoint> merged;
  std::vector<double> counts;
  for (const CurvePoint& point : side) {
    constexpr double kSameSpeed = 1.1;
    if (!merged.empty() && point.speed < kSameSpeed * merged.back().speed) {
      const double n = counts.back();
      merged.back().speed = (n * merged.back().speed + point.speed) / (n + 1.0);
      merged.back().effort = (n * merged.back().effort + point.effort) / (n + 1.0);
      counts.back() += 1.0;
    } else {
      merged.push_back(point);
      counts.push_back(1.0);
    }
  }
  return merged;
}

std::vector<CurvePoint> fast_points(const std::vector<CurvePoint>& side, double top) {
  std::vector<CurvePoint> fast;
  std::ranges::copy_if(side, std::back_inserter(fast),
                       [top](const CurvePoint& p) { return p.speed >= kSpeedTolerance * kFastShare * top; });
  return fast;
}

double slope_of(const std::vector<CurvePoint>& points) {
  double w = 0.0, t = 0.0;
  for (const CurvePoint& point : points) {
    w += point.speed;
    t += point.effort;
  }
  w /= static_cast<double>(points.size());
  t /= static_cast<double>(points.size());
  double numerator = 0.0, denominator = 0.0;
  for (const CurvePoint& point : points) {
    numerator += (point.speed - w) * (point.effort - t);
    denominator += (point.speed - w) * (point.speed - w);
  }
  return numerator / denominator;
}

/// Eqs. (60)-(62): the pair on the grid with the smallest cost.
void search_velocity_constants(const std::vector<CurvePoint>& side, double top, double viscous, FrictionSideLaw& law) {
  const double step = kGridReachShare * top / kGridSteps;
  double best = HUGE_VAL;
  FrictionSideLaw trial = law;
  for (int i = 0; i <= kGridSteps; ++i) {
    for (int j = 0; j <= kGridSteps; ++j) {
      trial.omega1 = step * i;
      trial.omega2 = step * j;
      double cost = 0.0;
      for (const CurvePoint& point : side) {
        if (point.speed < kSpeedTolerance * kGridPointShare * top) continue;
        const double error = point.effort - viscous * point.speed - trial.at(point.speed);
        cost += 0.5 * error * error;
      }
      if (cost < best) {
        best = cost;
        law = trial;
      }
    }
  }
}

Estimate without_interval(double value) { return {value, {value, value}}; }

}  // namespace

FrictionFit fit_friction_as_paper(const std::vector<CurvePoint>& points, double observer_viscous) {
  std::array<std::vector<CurvePoint>, 2> sides = {one_direction(points, true), one_direction(points, false)};
  double top = 0.0;
  for (const auto& side : sides) {
    if (!side.empty()) top = std::max(top, side.back().speed);
  }
  double correction = 0.0;  // (53), (54)
  for (auto& side : sides) {
    const std::vector<CurvePoint> fast = fast_points(side, top);
    if (side.size() < 4 || fast.size() < 2) {
      throw Failure(ExitCode::refused,
                    fmt::format("the paper's procedure needs four or more jog speeds in each direction, two of them "
                                "above a quarter of the top speed; found {} {} ({} fast). Jog at more speeds, for "
                                "example 0.1, 0.3, 0.5, 1, 3, 5, 10, 25, 50, 75, 100 mm/s in both directions",
                                side.size(), &side == &sides[0] ? "forward" : "backward", fast.size()));
    }
    correction += 0.5 * (slope_of(fast) - observer_viscous);
  }
  FrictionFit fit;
  fit.has_stribeck = true;
  fit.law.viscous = observer_viscous + correction;  // (55)
  double squares = 0.0, count = 0.0;
  for (std::size_t d = 0; d < 2; ++d) {
    FrictionSideLaw& law = d == 0 ? fit.law.positive : fit.law.negative;
    const std::vector<CurvePoint> fast = fast_points(sides[d], top);
    for (const CurvePoint& point : fast) {  // (56)
      law.coulomb += (point.effort - fit.law.viscous * point.speed) / static_cast<double>(fast.size());
    }
    law.static_level = sides[d].front().effort - fit.law.viscous * sides[d].front().speed;  // (57)
    search_velocity_constants(sides[d], top, fit.law.viscous, law);
    fit.coulomb[d] = without_interval(law.coulomb);
    fit.static_level[d] = without_interval(law.static_level);
    fit.omega1[d] = without_interval(law.omega1);
    fit.omega2[d] = without_interval(law.omega2);
    for (const CurvePoint& point : sides[d]) {
      const double error = point.effort - fit.law.viscous * point.speed - law.at(point.speed);
      squares += error * error;
      count += 1.0;
    }
  }
  fit.viscous = without_interval(fit.law.viscous);
  fit.rms = std::sqrt(squares / count);
  return fit;
}

}  // namespace host
