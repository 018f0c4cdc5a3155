#include "host/parameters/drive_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "host/exit_codes.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/identify/linear_axis.hpp"
#include "host/known_by_current.hpp"

namespace host {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

sim::DriveDescription without(sim::DriveDescription model, const std::set<std::string>& kinds) {
  std::erase_if(model.effects, [&](const sim::EffectEntry& entry) { return kinds.contains(entry.kind); });
  return model;
}

const std::set<std::string> kLoads = {"constant_torque", "cogging"};
/// Effects whose torque or force depends on position, time or load, so limits for all motions cannot include it.
const std::set<std::string> kElsewhere = {"position_dependent_friction",
                                          "thermal_friction_drift",
                                          "spring_torque",
                                          "load_dependent_friction",
                                          "external_torque",
                                          "torque_ripple",
                                          "free_curve"};

/// Torques or forces of a drive at steady speed, Nm or N.
class EffortBalance {
 public:
  explicit EffortBalance(const sim::DriveDescription& model)
      : drive_(without(without(model, kLoads), kElsewhere)),
        full_(rigid_axis(model).effort_per_volt * model.data.dac_limit_V) {
    sim::DriveDescription loads{model.name, model.data, {}};
    double longest = 0.0;
    for (const sim::EffectEntry& entry : model.effects) {
      if (!kLoads.contains(entry.kind) && entry.kind != "inertia") continue;
      loads.effects.push_back(entry);
      if (entry.has("period")) longest = std::max(longest, entry.at("period"));
    }
    const sim::Drive loaded(loads);
    constexpr int kPlaces = 2000;
    least_load_ = kInfinite;
    most_load_ = -kInfinite;
    for (int place = 0; place < kPlaces; ++place) {
      const double sum = loaded.with_loads(0.0, 0.0, 0.0, longest * place / kPlaces);
      least_load_ = std::min(least_load_, sum);
      most_load_ = std::max(most_load_, sum);
    }
  }

  /// Largest torque or force of the motor, `push` +1 along the motion of direction `way`, -1 against it.
  double most(int way, int push, double speed) const {
    double effort = way * push * full_;
    for (const auto& limit : drive_.effort_limit) effort = limit(effort, way * speed);
    return std::abs(effort);
  }

  /// Torque or force of the motor against friction and loads at constant speed.
  double need(int way, int push, double speed) const {
    Motion motion;
    motion.t_s = motion.travel = motion.acceleration = motion.effort = {0.0};
    motion.speed = {way * std::max(speed, 1e-9)};  // at rest, breakaway friction
    const double friction = std::abs(inverse_effort(drive_, motion).front());
    const double helping = way > 0 ? least_load_ : -most_load_, pulling = way > 0 ? most_load_ : -least_load_;
    return push > 0 ? friction - helping : pulling - friction;
  }

  double inertia() const { return drive_.inertia; }
  double effort_per_volt() const { return drive_.effort_per_volt; }
  std::optional<double> resonance_Hz() const {
    return drive_.second_mass ? std::optional(drive_.second_mass->resonance_Hz) : std::nullopt;
  }

 private:
  sim::Drive drive_;
  double full_, least_load_, most_load_;
};

/// The worst case over all speeds up to a limit.
struct Worst {
  int way = 1, push = 1;
  double speed = 0.0;
  double room = kInfinite;  ///< torque or force left for acceleration, Nm or N
};

Worst worst_up_to(const EffortBalance& balance, double speed, double reserve) {
  Worst worst;
  constexpr int kSpeeds = 100;
  for (int step = 0; step <= kSpeeds; ++step)
    for (const int way : {1, -1})
      for (const int push : {1, -1}) {
        const double w = speed * step / kSpeeds;
        const double room = (1.0 - reserve) * balance.most(way, push, w) - balance.need(way, push, w);
        if (room < worst.room) worst = {way, push, w, room};
      }
  return worst;
}

/// The highest speed at which half of the room at standstill is left; infinite if it never falls to half.
double speed_with_half(const EffortBalance& balance, double reserve) {
  const double half = worst_up_to(balance, 0.0, reserve).room / 2.0;
  const auto keeps = [&](double speed) { return worst_up_to(balance, speed, reserve).room >= half; };
  double good = 0.0, bad = 1.0;
  for (; keeps(bad); bad *= 2.0) {
    if (bad > 1e6) return kInfinite;
    good = bad;
  }
  for (int k = 0; k < 40; ++k) {
    const double tried = (good + bad) / 2.0;
    (keeps(tried) ? good : bad) = tried;
  }
  return good;
}

std::string what_bounds(const sim::DriveDescription& model, const Worst& at) {
  const double most = EffortBalance(model).most(at.way, at.push, at.speed);
  for (const char* kind : {"voltage_limit", "current_saturation"})
    if (EffortBalance(without(model, {kind})).most(at.way, at.push, at.speed) > most)
      return kind == std::string_view("voltage_limit") ? "the voltage limit" : "the current limit";
  return "the converter's range";
}

std::string what_slows(const EffortBalance& balance, double speed, double reserve) {
  if (std::isinf(speed)) return "nothing in the model";
  const Worst at = worst_up_to(balance, speed, reserve);
  const double lost = (1.0 - reserve) * (balance.most(at.way, at.push, 0.0) - balance.most(at.way, at.push, at.speed));
  const double grown = balance.need(at.way, at.push, at.speed) - balance.need(at.way, at.push, 0.0);
  return lost > grown ? "the voltage limit" : "friction that grows with speed";
}

}  // namespace

DriveLimits drive_limits(const sim::DriveDescription& model, const LimitWishes& wishes) {
  require_volts(model.data, model.name, "limits of a command");
  const EffortBalance balance(model);
  const double lead = model.data.lead;
  const ReferenceLimits usual = ReferenceLimits::usual_for(model.data.kind);
  const Worst still = worst_up_to(balance, 0.0, wishes.reserve);
  if (!(still.room > 0.0)) {
    const char* unit = model.data.kind == sim::DriveKind::rotary ? "Nm" : "N";
    throw Failure(ExitCode::refused,
                  fmt::format("axis {}: friction and loads need {:.3g} {} at standstill. The drive has {:.3g} {}; a "
                              "reserve of {:g} % leaves {:.3g} {}, so nothing remains for acceleration. Check the "
                              "model's gains and limits, or lower --reserve",
                              model.name, balance.need(still.way, still.push, 0.0), unit,
                              balance.most(still.way, still.push, 0.0), unit, 100.0 * wishes.reserve,
                              (1.0 - wishes.reserve) * balance.most(still.way, still.push, 0.0), unit));
  }

  DriveLimits limits;
  limits.reserve = wishes.reserve;
  const double fastest = speed_with_half(balance, wishes.reserve);
  limits.velocity = {lead * fastest, what_slows(balance, fastest, wishes.reserve)};
  limits.written.velocity = std::min(usual.velocity, limits.velocity.value);
  if (wishes.top_speed_mm_s) {
    const double per_mm = usual.velocity / ReferenceLimits{}.velocity;
    limits.written.velocity = std::min(per_mm * *wishes.top_speed_mm_s, limits.velocity.value);
  }
  const Worst moving = worst_up_to(balance, limits.written.velocity / lead, wishes.reserve);
  limits.acceleration = {lead * moving.room / balance.inertia(), what_bounds(model, moving)};
  const std::optional<double> resonance_Hz = wishes.measured_Hz ? wishes.measured_Hz : balance.resonance_Hz();
  const bool rings = resonance_Hz && *resonance_Hz < wishes.loop_Hz;
  const double slowest_Hz = rings ? *resonance_Hz : wishes.loop_Hz;
  limits.jerk = {limits.acceleration.value * slowest_Hz,
                 fmt::format("{} {:.3g} Hz", rings ? "the resonance of" : "the loop of", slowest_Hz)};
  limits.written.acceleration = limits.acceleration.value;
  if (!wishes.as_the_drive_allows)
    limits.written.acceleration = std::min(limits.written.acceleration, usual.acceleration);
  limits.written.jerk = limits.written.acceleration * slowest_Hz;
  if (!wishes.as_the_drive_allows) limits.written.jerk = std::min(limits.written.jerk, usual.jerk);

  double most_used = -1.0;
  constexpr int kSpeeds = 100;
  for (int step = 0; step <= kSpeeds; ++step)
    for (const int way : {1, -1})
      for (const int push : {1, -1}) {
        const double w = limits.written.velocity / lead * step / kSpeeds;
        const double most = balance.most(way, push, w);
        const double need = balance.inertia() * limits.written.acceleration / lead + balance.need(way, push, w);
        if (need <= most_used * most) continue;
        most_used = need / most;
        limits.command_V = need / balance.effort_per_volt();
        limits.limit_V = most / balance.effort_per_volt();
      }
  std::set<std::string> left_out;
  for (const sim::EffectEntry& entry : model.effects)
    if (kElsewhere.contains(entry.kind)) left_out.insert(entry.kind);
  limits.not_counted.assign(left_out.begin(), left_out.end());
  return limits;
}

nlohmann::json drive_limits_json(const DriveLimits& limits) {
  const auto one = [](const DriveLimit& limit) -> nlohmann::json {
    return {{"value", std::isinf(limit.value) ? nlohmann::json(nullptr) : nlohmann::json(limit.value)},
            {"by", limit.by}};
  };
  return {
      {"reserve", limits.reserve},
      {"drive",
       {{"velocity", one(limits.velocity)}, {"acceleration", one(limits.acceleration)}, {"jerk", one(limits.jerk)}}},
      {"written",
       {{"velocity", limits.written.velocity},
        {"acceleration", limits.written.acceleration},
        {"jerk", limits.written.jerk}}},
      {"command_V", limits.command_V},
      {"limit_V", limits.limit_V},
      {"not_counted", limits.not_counted}};
}

}  // namespace host
