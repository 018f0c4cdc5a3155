#include "host/axes/circle_rests.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/axes/circle_pass.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

struct Rest {
  std::size_t first, last;  ///< samples
  double angle_rad;         ///< of the circle at `first`
};

double along(double angle, char axis) { return axis == 'x' ? std::cos(angle) : std::sin(angle); }

double encoder_mm(const CirclePass& pass, std::size_t k, char axis) {
  return (pass.radius_mm + 1e-3 * pass.encoder_um[k]) * along(pass.angle_rad[k], axis);
}

/// Range within which a resting axis seems to move, um: two encoder steps, or the noise.
double rest_range_um(const CirclePass& pass, char axis) {
  Eigen::VectorXd at(static_cast<Eigen::Index>(pass.t_s.size()));
  for (Eigen::Index k = 0; k < at.size(); ++k) at(k) = 1e3 * encoder_mm(pass, static_cast<std::size_t>(k), axis);
  constexpr double kNoises = 4.0;  // range of normal noise over tens of samples, in its standard deviations
  return std::max(2.0 * pass.count_um, kNoises * noise_of(at));
}

/// Shortest way of the circle during a rest, in ranges of a resting axis. A friction-free axis at its reversal stays
/// within the range over twice this range.
constexpr double kLeastWay = 5.0;

double turn_a_sample(const CirclePass& pass) { return pass.direction() * pass.turn_rad_s() * pass.period_s; }

/// The circle's angle at the first of these samples: the steady turn through the mean of all of them.
double first_angle(const CirclePass& pass, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t k = first; k <= last; ++k)
    sum +=
        std::remainder(pass.angle_rad[k] - pass.angle_rad[first] - turn_a_sample(pass) * static_cast<double>(k - first),
                       2.0 * std::numbers::pi);
  return pass.angle_rad[first] + sum / static_cast<double>(last - first + 1);
}

std::vector<Rest> all_rests(const CirclePass& pass, char axis) {
  const double range_mm = 1e-3 * rest_range_um(pass, axis), least_mm = kLeastWay * range_mm;
  std::vector<Rest> rests;
  for (std::size_t k = 0; k + 1 < pass.t_s.size();) {
    double low = encoder_mm(pass, k, axis), high = low, way = 0.0;
    std::size_t end = k + 1;
    for (; end < pass.t_s.size(); ++end) {
      const double now = encoder_mm(pass, end, axis);
      low = std::min(low, now);
      high = std::max(high, now);
      if (high - low > range_mm) break;
      const double across = axis == 'x' ? std::sin(pass.angle_rad[end]) : std::cos(pass.angle_rad[end]);
      way += pass.radius_mm * std::abs(turn_a_sample(pass) * across);
    }
    if (way < least_mm) {
      ++k;
      continue;
    }
    rests.push_back({k, end - 1, first_angle(pass, k, end - 1)});
    k = end;
  }
  return rests;
}

/// The circle along the axis, by the steady turn through the mean angle of a rest.
double circle_mm(const CirclePass& pass, const Rest& rest, std::size_t k, char axis) {
  const double samples = static_cast<double>(k) - static_cast<double>(rest.first);
  return pass.radius_mm * along(rest.angle_rad + turn_a_sample(pass) * samples, axis);
}

/// Part of a jump that the axis has made at a sample.
double jumped(const CirclePass& pass, const Rest& before, const Rest& after, std::size_t k, char axis) {
  const double from = encoder_mm(pass, before.last, axis), to = encoder_mm(pass, after.first, axis);
  const double part = to == from ? 0.5 : (encoder_mm(pass, k, axis) - from) / (to - from);
  return std::clamp(part, 0.0, 1.0);
}

/// Median number of samples from the end of a rest to the next, without those between one reversal and the next.
double usual_jump(const CirclePass& pass, const std::vector<Rest>& rests) {
  const double most = 0.1 * 2.0 * std::numbers::pi / std::abs(turn_a_sample(pass));
  std::vector<double> jumps;
  for (std::size_t i = 0; i + 1 < rests.size(); ++i)
    if (const auto jump = static_cast<double>(rests[i + 1].first - rests[i].last); jump < most) jumps.push_back(jump);
  return jumps.empty() ? 0.0 : median(jumps);
}

}  // namespace

double noise_of(const Eigen::VectorXd& values) {
  std::vector<double> differences;
  for (Eigen::Index k = 2; k < values.size(); ++k)
    differences.push_back(std::abs(values(k) - 2.0 * values(k - 1) + values(k - 2)));
  return differences.empty() ? 1.0 : median(differences) / (0.6745 * std::sqrt(6.0));
}

AxisRests rests_of(const CirclePass& pass, char axis) {
  const std::vector<Rest> rests = all_rests(pass, axis);
  AxisRests found;
  if (rests.empty()) return found;
  for (auto* const list : {&found.ahead_um, &found.level, &found.level_by_speed}) list->assign(pass.t_s.size(), 0.0);
  const auto add = [&](std::size_t k, const Rest& rest, std::size_t seen_at, double part) {
    const double ahead_mm = circle_mm(pass, rest, rest.last, axis) - circle_mm(pass, rest, seen_at, axis);
    const double speed_mm_s =
        (circle_mm(pass, rest, rest.last + 1, axis) - circle_mm(pass, rest, rest.last, axis)) / pass.period_s;
    found.ahead_um[k] += part * 1e3 * ahead_mm;
    found.level[k] += part * (speed_mm_s < 0.0 ? -1.0 : 1.0);
    found.level_by_speed[k] += part * speed_mm_s;
  };
  const auto jump = static_cast<std::size_t>(usual_jump(pass, rests));
  for (std::size_t i = 0; i < rests.size(); ++i) {
    const Rest& rest = rests[i];
    for (std::size_t k = rest.first; k <= rest.last; ++k) add(k, rest, k, 1.0);
    if (i > 0 && rest.first - rests[i - 1].last <= 2 * jump) {
      found.jumps = true;
      for (std::size_t k = rests[i - 1].last + 1; k < rest.first; ++k) {
        const double part = jumped(pass, rests[i - 1], rest, k, axis);
        add(k, rests[i - 1], k, 1.0 - part);
        add(k, rest, k, part);
      }
    } else {
      for (std::size_t back = 1; back < std::min(jump, rest.first); ++back)
        add(rest.first - back, rest, rest.first, 1.0 - static_cast<double>(back) / static_cast<double>(jump));
    }
    if (i + 1 < rests.size() && rests[i + 1].first - rest.last <= 2 * jump) continue;
    for (std::size_t on = 1; on < jump && rest.last + on < pass.t_s.size(); ++on)
      add(rest.last + on, rest, rest.last, 1.0 - static_cast<double>(on) / static_cast<double>(jump));
  }
  return found.jumps ? found : AxisRests{};
}

double stick_slip_speed(const CirclePass& pass) {
  // Two shortest ways from the reversal at radius R: distance d, speed v sqrt(2 d / R).
  const double way_mm = 1e-3 * kLeastWay * std::max(rest_range_um(pass, 'x'), rest_range_um(pass, 'y'));
  return pass.feed_mm_s * std::sqrt(4.0 * way_mm / pass.radius_mm);
}

}  // namespace host
