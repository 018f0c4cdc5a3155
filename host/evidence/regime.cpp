#include "host/evidence/regime.hpp"

#include <algorithm>
#include <cmath>

#include "host/statistics.hpp"

namespace host {

namespace {

constexpr double kReversalTravel_m = 50e-6;

/// Speeds below this part of the record's top speed are low: friction curves fall within some 5 of 100 rad/s.
constexpr double kLowSpeed = 0.05;

/// The speed counts as constant while the acceleration is below this part of its 95 % quantile.
constexpr double kConstantSpeed = 0.1;

/// A reversal counts once the axis has moved back by this many encoder steps.
constexpr double kStepsOfTravel = 2.0;

/// The acceleration is computed over this many samples on each side.
constexpr std::size_t kRowsAround = 3;

std::vector<double> acceleration_of(const std::vector<double>& w, double period_s) {
  std::vector<double> acceleration(w.size());
  for (std::size_t k = 0; k < w.size(); ++k) {
    const std::size_t from = k - std::min(k, kRowsAround), to = std::min(w.size() - 1, k + kRowsAround);
    acceleration[k] = (w[to] - w[from]) / (static_cast<double>(to - from) * period_s);
  }
  return acceleration;
}

/// Rows within `reach` of travel after each turning point. A turning point counts once the axis has moved back by
/// `believed`.
std::vector<bool> rows_after_reversals(const std::vector<double>& x, double reach, double believed) {
  std::vector<bool> after(x.size(), false);
  std::size_t extreme = 0;
  double direction = 0.0;  // 0 until the axis has moved
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double moved = x[k] - x[extreme];
    if (direction == 0.0) {
      if (std::abs(moved) > believed) {
        direction = moved > 0.0 ? 1.0 : -1.0;
        extreme = k;
      }
    } else if (moved * direction >= 0.0) {
      extreme = k;
    } else if (-moved * direction > believed) {
      for (std::size_t row = extreme; row < x.size() && std::abs(x[row] - x[extreme]) <= reach; ++row)
        after[row] = true;
      direction = -direction;
      extreme = k;
    }
  }
  return after;
}

}  // namespace

std::string_view regime_name(Regime regime) {
  constexpr std::string_view kNames[] = {"standstill",   "reversal", "low_speed",        "constant_speed",
                                         "acceleration", "braking",  "saturated_command"};
  return kNames[static_cast<std::size_t>(regime)];
}

double reversal_travel(const sim::DataSheet& data) {
  const double travel = data.kind == sim::DriveKind::rotary ? 1000.0 * kReversalTravel_m : kReversalTravel_m;
  return std::max(travel, 2.0 * kStepsOfTravel * data.encoder_resolution);
}

std::vector<Regime> regimes_of(const PreparedRecord& prepared, const sim::DataSheet& data) {
  const SmoothedMotion& motion = prepared.motion();
  const std::size_t n = motion.w.size();
  const std::vector<double> acceleration = acceleration_of(motion.w, prepared.period_s);
  std::vector<double> sizes(n);
  std::ranges::transform(acceleration, sizes.begin(), [](double a) { return std::abs(a); });
  constexpr double kLarge = 0.95;
  const double constant = kConstantSpeed * quantile(sizes, kLarge);
  double top_speed = 0.0;
  for (const double w : motion.w) top_speed = std::max(top_speed, std::abs(w));
  const std::vector<bool> reversed =
      rows_after_reversals(motion.x, reversal_travel(data),
                           std::max(kStepsOfTravel * data.encoder_resolution, 1e-3 * reversal_travel(data)));
  const double limit_V = data.dac_limit_V - 0.51 * data.dac_resolution_V;
  std::vector<Regime> regimes(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double w = motion.w[k], a = acceleration[k];
    if (data.dac_limit_V > 0.0 && std::abs(prepared.u_V[k]) >= limit_V)
      regimes[k] = Regime::saturated_command;
    else if (motion.standing[k])
      regimes[k] = Regime::standstill;
    else if (reversed[k])
      regimes[k] = Regime::reversal;
    else if (std::abs(w) <= kLowSpeed * top_speed)
      regimes[k] = Regime::low_speed;
    else if (std::abs(a) <= constant)
      regimes[k] = Regime::constant_speed;
    else
      regimes[k] = a * w > 0.0 ? Regime::acceleration : Regime::braking;
  }
  return regimes;
}

}  // namespace host
