#include "sim/drive.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/catalogue.hpp"
#include "sim/friction.hpp"
#include "sim/presliding_motion.hpp"
#include "sim/two_mass_motion.hpp"

namespace sim {

namespace {

/// Exact mean over `duration` of a first-order lag that starts at `value` and follows a constant `target`; moves
/// `value`.
double lag_mean(double& value, double target, double time_constant, double duration) {
  const double gap = value - target;
  const double z = -duration / time_constant;
  const double mean = target + gap * phi1(z);
  value = target + gap * std::exp(z);
  return mean;
}

/// The contact of a drive on which further effects act; the state keeps what it remembers.
struct RichContact {
  const Drive& drive;
  DriveState& state;
  double level;      ///< factor on Coulomb and static friction
  double viscosity;  ///< factor on viscous friction
  double carried;    ///< friction from the transmitted effort

  FrictionPoint sliding(int side, double speed) const {
    const FrictionSide& friction = drive.friction[static_cast<std::size_t>(side)];
    const double breakaway = friction.breakaway * (1.0 + state.breakaway_gain);
    const bool remembers = drive.friction_memory_s > 0.0;
    FrictionPoint curve = stribeck_curve(friction, breakaway, remembers ? state.friction_speed : speed);
    if (remembers) curve.slope = 0.0;
    FrictionPoint all = viscous(side, speed);
    all.effort += level * curve.effort + carried;
    all.slope += level * curve.slope;
    if (all.effort < 0.0) return {0.0, 0.0};  // friction never drives, whatever a fit tries
    return all;
  }

  /// The part that fluid and not the contact carries.
  FrictionPoint viscous(int side, double speed) const {
    const double coefficient = viscosity * drive.friction[static_cast<std::size_t>(side)].viscous;
    FrictionPoint all{coefficient * speed, coefficient};
    for (const auto& further : drive.sliding_friction) {
      const FrictionPoint part = further(speed);
      all.effort += part.effort;
      all.slope += part.slope;
    }
    return all;
  }

  double breakaway(int side) const {
    const double gain = drive.dwell_gain > 0.0 ? 1.0 + dwell_gain() : 1.0;
    return level * drive.friction[static_cast<std::size_t>(side)].breakaway * gain + carried;
  }
  double dwell_gain() const { return drive.dwell_gain * -std::expm1(-state.rest_s / drive.dwell_time_s); }
  void broke_away() const {
    if (drive.dwell_gain > 0.0) state.breakaway_gain = dwell_gain();
  }
  void came_to_rest() const { state.rest_s = 0.0; }
  void rested(double duration_s) const { state.rest_s += duration_s; }
};

template <typename Factors, typename... Arguments>
double product(const Factors& factors, Arguments... arguments) {
  double value = 1.0;
  for (const auto& factor : factors) value *= factor(arguments...);
  return value;
}

template <typename Terms>
double sum_at(const Terms& terms, double x) {
  double value = 0.0;
  for (const auto& term : terms) value += term(x);
  return value;
}

}  // namespace

Drive::Drive(const DriveDescription& description)
    : effort_per_volt(description.data.effort_per_volt()), lead(description.data.lead) {
  for (const EffectEntry& entry : description.effects) {
    const EffectInfo* info = find_effect(entry.kind);
    if (info == nullptr) throw std::invalid_argument("unknown effect kind: " + entry.kind);
    info->install(entry, description.data, *this);
  }
  settle();
}

void Drive::settle() {
  for (std::size_t direction = 0; direction < friction.size(); ++direction) {
    FrictionSide& side = friction[direction];
    side.coulomb *= direction_factor[direction].level;
    side.breakaway = std::max(side.breakaway * direction_factor[direction].level, side.coulomb);
    side.viscous *= direction_factor[direction].viscous;
    const auto rate = [](double omega) { return omega > 0.0 ? 1.0 / omega : 0.0; };
    curves_[direction] = {side.coulomb, side.breakaway, side.viscous, rate(side.omega1), rate(side.omega2)};
  }
  mobility_ = 1.0 / inertia;
  max_step_s = HUGE_VAL;
  if (bristles) max_step_s = std::min(max_step_s, presliding_step_s(*bristles, inertia));
  if (second_mass) max_step_s = std::min(max_step_s, two_mass_step_s(*second_mass));
  for (const FrictionSide& side : friction) stribeck_ = stribeck_ || side.omega1 > 0.0 || side.omega2 > 0.0;
  plain_ = command.empty() && delay_s <= 0.0 && current_lag_s <= 0.0 && effort_limit.empty() && effort_factor.empty() &&
           load_effort.empty() && level_factor.empty() && viscous_factor.empty() && sliding_friction.empty() &&
           transmitted_share == 0.0 && friction_memory_s <= 0.0 && dwell_gain <= 0.0 && !bristles && !second_mass &&
           tach_lag_s <= 0.0;
}

double Drive::memory_s() const {
  // Five time constants leave less than 1 % of what was before; a bristle and a second mass settle within 0.1 s.
  constexpr double kTimeConstants = 5.0, kContact_s = 0.1;
  double memory = delay_s;
  for (const double lag_s : {current_lag_s, friction_memory_s, tach_lag_s})
    memory = std::max(memory, kTimeConstants * lag_s);
  if (dwell_gain > 0.0) memory = std::max(memory, kTimeConstants * dwell_time_s);
  if (bristles || second_mass) memory = std::max(memory, kContact_s);
  return memory;
}

DriveState Drive::at(double x, double w) const {
  DriveState state;
  state.x = state.load_x = x;
  state.w = state.load_w = state.tach = w;
  state.friction_speed = std::abs(w);
  return state;
}

double Drive::command_effort(double u_V, double w) const {
  for (const auto& stage : command) u_V = stage(u_V);
  double effort = effort_per_volt * u_V;
  for (const auto& limit : effort_limit) effort = limit(effort, w);
  return effort;
}

double Drive::deliver(DriveState& state, double u_V, double w, double duration_s) const {
  const double wanted = command_effort(u_V, w);
  if (current_lag_s <= 0.0) return state.effort = wanted;
  return lag_mean(state.effort, wanted, current_lag_s, duration_s);
}

void Drive::filter_tach(DriveState& state, double w_before, double duration_s) const {
  if (tach_lag_s <= 0.0) {
    state.tach = state.w;
    return;
  }
  // The speed runs straight from its value before to its value after: the exact response to a ramp.
  const double slope = (state.w - w_before) / duration_s;
  state.tach =
      state.w - tach_lag_s * slope + (state.tach - w_before + tach_lag_s * slope) * std::exp(-duration_s / tach_lag_s);
}

void Drive::move(DriveState& state, double effort, double t_s, double duration_s) const {
  const double middle_x = state.x + 0.5 * duration_s * lead * state.w;
  const double motor = effort * product(effort_factor, middle_x);
  double net = motor;
  for (const auto& load : load_effort) net += load(t_s, middle_x);
  RichContact contact{*this, state, product(level_factor, t_s, middle_x), product(viscous_factor, t_s),
                      transmitted_share * std::abs(motor)};
  const double w_before = state.w;
  if (second_mass) {
    move_two_masses(*second_mass, inertia, lead, state, net, duration_s, contact);
  } else if (bristles) {
    move_on_bristles(*bristles, inertia, lead, state, net, duration_s, contact);
  } else {
    SlidingMass mass{state.x, state.w, mobility_, lead};
    slide(mass, net, duration_s, contact);
    state.x = mass.x;
    state.w = mass.w;
  }
  if (friction_memory_s > 0.0)
    lag_mean(state.friction_speed, 0.5 * std::abs(w_before + state.w), friction_memory_s, duration_s);
  filter_tach(state, w_before, duration_s);
}

void Drive::hold(DriveState& state, double u_V, double t_s, double duration_s) const {
  // The mean of a sine over an eighth of its period is within 2.5 % of its middle value. What passes several periods in
  // a sixth of the interval averages out whatever is done.
  constexpr double kPeriodShare = 0.125;
  constexpr double kMostParts = 6.0;
  const double by_travel = std::abs(state.w) * lead * duration_s / (kPeriodShare * finest_period);
  const double wanted_parts = std::max(duration_s / max_step_s, std::min(by_travel, kMostParts));
  const int parts = std::max(1, static_cast<int>(std::ceil(wanted_parts - 1e-9)));
  const double part_s = duration_s / parts;
  for (int part = 0; part < parts; ++part) {
    const double at_s = t_s + part * part_s;
    move(state, deliver(state, u_V, limiting_speed(state, u_V, at_s, part_s), part_s), at_s, part_s);
  }
}

double Drive::limiting_speed(const DriveState& state, double u_V, double t_s, double duration_s) const {
  // A limit that moves with the speed is taken at the middle of the step, found by a trial: order 2.
  if (effort_limit.empty() || command_effort(u_V, state.w) == command_effort(u_V, 0.0)) return state.w;
  DriveState trial = state;
  move(trial, deliver(trial, u_V, state.w, duration_s), t_s, duration_s);
  return 0.5 * (state.w + trial.w);
}

void Drive::step(DriveState& state, double u_V, double t_s, double duration_s) const {
  if (plain_) {
    SlidingMass mass{state.x, state.w, mobility_, lead};
    const double effort = effort_per_volt * u_V;
    if (stribeck_) {
      PlainContact<true> contact{curves_};
      slide(mass, effort, duration_s, contact);
    } else {
      PlainContact<false> contact{curves_};
      slide(mass, effort, duration_s, contact);
    }
    state.x = mass.x;
    state.w = mass.w;
    state.tach = mass.w;
    return;
  }
  if (delay_s <= 0.0) {
    hold(state, u_V, t_s, duration_s);
    return;
  }
  const std::size_t whole = whole_periods_of_delay(duration_s);
  const double rest_s = std::min(delay_s - static_cast<double>(whole) * duration_s, duration_s);
  const double newer = whole == 0 ? u_V : state.past_u_V[whole - 1];
  if (rest_s > 0.0) hold(state, state.past_u_V[whole], t_s, rest_s);
  if (rest_s < duration_s) hold(state, newer, t_s + rest_s, duration_s - rest_s);
  remember_command(state, u_V, whole);
}

std::size_t Drive::whole_periods_of_delay(double period_s) const {
  const auto whole = static_cast<std::size_t>(delay_s / period_s);
  return std::min(whole, DriveState{}.past_u_V.size() - 1);
}

void Drive::remember_command(DriveState& state, double u_V, std::size_t whole) const {
  for (std::size_t k = whole; k > 0; --k) state.past_u_V[k] = state.past_u_V[k - 1];
  state.past_u_V[0] = u_V;
}

double Drive::deliver_over(DriveState& state, double u_V, double duration_s) const {
  if (delay_s <= 0.0) return deliver(state, u_V, state.w, duration_s);
  const std::size_t whole = whole_periods_of_delay(duration_s);
  const double older_s = std::min(delay_s - static_cast<double>(whole) * duration_s, duration_s);
  double impulse = 0.0;
  if (older_s > 0.0) impulse += older_s * deliver(state, state.past_u_V[whole], state.w, older_s);
  if (older_s < duration_s)
    impulse += (duration_s - older_s) *
               deliver(state, whole == 0 ? u_V : state.past_u_V[whole - 1], state.w, duration_s - older_s);
  remember_command(state, u_V, whole);
  return impulse / duration_s;
}

bool Drive::shapes_effort() const {
  return !command.empty() || delay_s > 0.0 || current_lag_s > 0.0 || !effort_limit.empty() || !effort_factor.empty() ||
         !load_effort.empty();
}

double Drive::sliding_effort(DriveState& state, double effort, double t_s) const {
  const RichContact contact{*this, state, product(level_factor, t_s, state.x), product(viscous_factor, t_s),
                            transmitted_share * std::abs(effort)};
  const double magnitude = contact.sliding(state.w >= 0.0 ? 0 : 1, std::abs(state.w)).effort;
  return state.w >= 0.0 ? magnitude : -magnitude;
}

void Drive::observe(DriveState& state, double u_V, double x1, double t_s, double duration_s) const {
  // An alpha-beta tracker: the motor is drawn towards its measured travel as by a spring and a damper, which cannot
  // excite the second mass. Alpha 0.15 averages the travel over some seven samples.
  constexpr double kAlpha = 0.15;
  constexpr double kBeta = kAlpha * kAlpha / (2.0 - kAlpha);
  step(state, u_V, t_s, duration_s);
  const double off = x1 - state.x;
  state.x += kAlpha * off;
  state.w += kBeta * off / (lead * duration_s);
}

double Drive::follow(DriveState& state, double u_V, double x1, double w1, double t_s, double duration_s) const {
  if (second_mass) {
    observe(state, u_V, x1, t_s, duration_s);
    return 0.0;
  }
  const double w0 = state.w;
  const double middle_x = 0.5 * (state.x + x1);
  const double mean_w = 0.5 * (w0 + w1);
  double effort = deliver_over(state, u_V, duration_s) * product(effort_factor, middle_x);
  for (const auto& load : load_effort) effort += load(t_s, middle_x);
  if (friction_memory_s > 0.0) lag_mean(state.friction_speed, std::abs(mean_w), friction_memory_s, duration_s);
  if (dwell_gain > 0.0) follow_rest(state, w0, w1, effort, duration_s);
  const FrictionSide& side = friction[mean_w >= 0.0 ? 0 : 1];
  if (bristles)
    follow_bristles(*bristles, side, inertia, state, mean_w, effort - inertia * (w1 - w0) / duration_s, duration_s);
  state.x = x1;
  state.w = w1;
  filter_tach(state, w0, duration_s);
  return effort;
}

void Drive::follow_rest(DriveState& state, double w0, double w1, double effort, double duration_s) const {
  if (w0 == 0.0 && w1 == 0.0) {
    state.rest_s += duration_s;
    state.slide_s = state.restuck = 0.0;
    state.breakaway_gain = dwell_gain * -std::expm1(-state.rest_s / dwell_time_s);
    return;
  }
  // A smoothed start may swing through zero for a moment; only a motion that has lasted can come to rest unseen.
  constexpr double kRealMotion_s = 0.02;
  state.rest_s = 0.0;
  if (w0 * w1 < 0.0 && state.slide_s > kRealMotion_s) {
    state.breakaway_gain = state.slide_s = state.restuck = 0.0;
  }
  state.slide_s += duration_s;
  if (state.breakaway_gain <= 0.0) return;
  // At creep a stop of a millisecond goes unseen, and the gain of the rest goes with it. The friction that the motion
  // shows is held against the level with the gain and the level without, averaged over some 30 ms.
  constexpr double kAveraging_s = 0.03;
  const double w = 0.5 * (w0 + w1);
  const FrictionSide& side = friction[w >= 0.0 ? 0 : 1];
  const double without = stribeck_curve(side, side.breakaway, std::abs(w)).effort + side.viscous * std::abs(w);
  const double with = stribeck_curve(side, side.breakaway * (1.0 + state.breakaway_gain), std::abs(w)).effort +
                      side.viscous * std::abs(w);
  const double shown = (w >= 0.0 ? 1.0 : -1.0) * (effort - inertia * (w1 - w0) / duration_s);
  const double levels_apart = with - without;
  if (levels_apart <= 1e-3 * with) return;
  const double verdict = (0.5 * (with + without) - shown) / levels_apart;
  state.restuck += (verdict - state.restuck) * duration_s / kAveraging_s;
  if (state.slide_s > 2.0 * kAveraging_s && state.restuck > 0.25) state.breakaway_gain = 0.0;
}

double Drive::encoder(const DriveState& state) const { return state.x + encoder_error_at(state.x); }

double Drive::encoder_error_at(double x) const { return sum_at(encoder_error, x); }

double Drive::tachometer(const DriveState& state) const {
  return tach_gain * state.tach * (1.0 + sum_at(tach_ripple, state.x)) + tach_offset;
}

}  // namespace sim
