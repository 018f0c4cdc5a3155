#include "host/parameters/monitor_relations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/core/supervision/monitor_check.hpp"

namespace host {

namespace {

namespace ceilings = firmware::monitor_ceilings;

/// Values of the axis for the relations, in double precision.
struct AxisFigures {
  double period_s, lead, fastest, count, full_change;

  explicit AxisFigures(const firmware::AxisParameters<float>& p)
      : period_s(static_cast<double>(p.sample_period_s)),
        lead(static_cast<double>(p.lead)),
        fastest(static_cast<double>(p.velocity_limit) / lead),
        count(static_cast<double>(p.encoder_resolution) / (lead * period_s)),
        full_change(static_cast<double>(p.drive.Bd2) * static_cast<double>(p.dac_limit_V)) {}

  /// The highest threshold that still protects; see ceilings::Scaled::is_speed_below.
  double ceiling(double time_s, double times, double counts) const {
    return std::max({full_change * time_s / period_s, fastest * times, count * counts});
  }
};

std::string fastest_text(const firmware::AxisParameters<float>& p, const AxisFigures& axis) {
  return fmt::format("limits.velocity / drive.lead = {:.4g} / {:.4g} = {:.4g}", p.velocity_limit, p.lead, axis.fastest);
}

}  // namespace

std::string overspeed_relation(const firmware::AxisParameters<float>& p) {
  const AxisFigures axis(p);
  const double least = axis.fastest + axis.count,
               most = axis.ceiling(static_cast<double>(ceilings::kOverspeed_s), 3, 8);
  const auto overspeed = static_cast<double>(p.monitors.overspeed);
  if (!(overspeed > least))
    return fmt::format(
        "it must be above {} and a count a sample more, {:.4g}: above {:.4g} and at most {:.4g} fits; or keep it, with "
        "limits.velocity below {:.4g}",
        fastest_text(p, axis), axis.count, least, most, std::max(0.0, (overspeed - axis.count) * axis.lead));
  return fmt::format(
      "it must be at most {:.4g}, three times {} or the speed that full command reaches in {:g} s; more would not "
      "protect: above {:.4g} and at most {:.4g} fits",
      most, fastest_text(p, axis), ceilings::kOverspeed_s, least, most);
}

std::string disagreement_relation(const firmware::AxisParameters<float>& p) {
  const AxisFigures axis(p);
  const auto floor = static_cast<double>(p.monitors.disagreement_floor);
  const auto jump = static_cast<double>(p.monitors.encoder_jump);
  const double most_floor = axis.ceiling(static_cast<double>(ceilings::kDisagreement_s), 1, 8);
  const double most_jump = axis.ceiling(static_cast<double>(ceilings::kJump_s), 2, 32);
  if (!(jump > floor))
    return fmt::format(
        "it must be below monitor.encoder_jump = {:.4g}; at most {:.4g} of the one and {:.4g} of the "
        "other fit",
        jump, most_floor, most_jump);
  if (floor > most_floor)
    return fmt::format(
        "it must be at most {:.4g}, {} or the speed that full command reaches in {:g} s; more would not protect",
        most_floor, fastest_text(p, axis), ceilings::kDisagreement_s);
  return fmt::format(
      "monitor.encoder_jump = {:.4g} beside it must be at most {:.4g}, twice {} or the speed that full command reaches "
      "in "
      "{:g} s; more would not protect",
      jump, most_jump, fastest_text(p, axis), ceilings::kJump_s);
}

std::string following_error_relation(const firmware::AxisParameters<float>& p) {
  const AxisFigures axis(p);
  constexpr double kCommand_s = static_cast<double>(ceilings::kFollowing_s);
  constexpr double kVelocity_s = static_cast<double>(ceilings::kFollowingTime_s);
  const double by_command = 0.5 * axis.full_change / axis.period_s * axis.lead * kCommand_s * kCommand_s;
  const double by_velocity = static_cast<double>(p.velocity_limit) * kVelocity_s;
  const double most = std::max(by_command, by_velocity), most_per_speed = axis.lead * kVelocity_s;
  if (static_cast<double>(p.monitors.following_error_floor) > most)
    return fmt::format(
        "it must be above 0 and at most {:.4g}, what full command moves the axis in {:g} s or {:g} s of "
        "limits.velocity; "
        "more would not protect",
        most, ceilings::kFollowing_s, ceilings::kFollowingTime_s);
  return fmt::format(
      "monitor.following_error_per_speed = {:.4g} beside it must be at most {:.4g}, {:g} s of drive.lead; more would "
      "not "
      "protect",
      p.monitors.following_error_per_velocity, most_per_speed, ceilings::kFollowingTime_s);
}

}  // namespace host
