#include "sim/drive.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/catalogue.hpp"
#include "sim/contact.hpp"
#include "sim/presliding_motion.hpp"
#include "sim/two_mass_motion.hpp"

namespace sim {

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
  if (second_mass) {
    max_step_s = std::min(max_step_s, two_mass_step_s(*second_mass));
    coupling_.emplace(*second_mass, inertia, lead);
  }
  const bool stribeck =
      std::ranges::any_of(friction, [](const FrictionSide& side) { return side.omega1 > 0.0 || side.omega2 > 0.0; });
  const bool rich = !level_factor.empty() || !viscous_factor.empty() || !further_level.empty() ||
                    !friction_after_reversal.empty() || transmitted_share != 0.0 || friction_memory_s > 0.0 ||
                    dwell_gain > 0.0;
  bare_ = !rich && current_lag_s <= 0.0 && tach_lag_s <= 0.0 && effort_limit.empty() && effort_factor.empty() &&
          load_effort.empty() && effort_behind_screw.empty();
  straight_command_ = command.empty() && effort_limit.empty();
  remembers_ = current_lag_s > 0.0 || tach_lag_s > 0.0 || friction_memory_s > 0.0 || !friction_after_reversal.empty();
  // The mean of a sine over an eighth of its period is within 2.5 % of its middle value.
  constexpr double kPeriodShare = 0.125;
  parts_per_s_ = 1.0 / max_step_s;
  parts_per_travel_ = 1.0 / (kPeriodShare * finest_period);
  step_ = rich                        ? cheapest_step<RichContact>()
          : !sliding_friction.empty() ? cheapest_step<BentContact>()
          : stribeck                  ? cheapest_step<PlainContact<true>>()
                                      : cheapest_step<PlainContact<false>>();
}

double Drive::memory_s() const {
  // After five time constants less than 1 % of the earlier state remains; bristle and second mass settle within 0.1 s.
  constexpr double kTimeConstants = 5.0, kContact_s = 0.1;
  double memory = delay_s;
  for (const double lag_s : {current_lag_s, friction_memory_s, tach_lag_s})
    memory = std::max(memory, kTimeConstants * lag_s);
  if (dwell_gain > 0.0) memory = std::max(memory, kTimeConstants * dwell_time_s);
  constexpr double kReversals_s = 2.0;  // after this time without a reversal, friction no longer rises
  if (!friction_after_reversal.empty()) memory = std::max(memory, kReversals_s);
  if (bristles || second_mass) memory = std::max(memory, kContact_s);
  return memory;
}

DriveState Drive::at(double x, double w) const {
  DriveState state;
  state.x = state.load_x = state.turned_x = x;
  state.w = state.load_w = state.tach = state.seen_w = w;
  state.friction_speed = std::abs(w);
  return state;
}

double Drive::behind_screw(double t_s) const {
  double outer = 0.0;
  for (const auto& part : effort_behind_screw) outer += part(t_s);
  return outer;
}

double Drive::with_effort_behind_screw(double effort, double w, double t_s) const {
  const double outer = behind_screw(t_s);
  if (w != 0.0) return effort + outer;
  return effort > 0.0 ? std::clamp(effort + outer, 0.0, effort) : std::clamp(effort + outer, effort, 0.0);
}

inline double Drive::command_effort(double u_V, double w) const {
  if (straight_command_) return effort_per_volt * u_V;
  for (const auto& stage : command) u_V = stage(u_V);
  double effort = effort_per_volt * u_V;
  for (const auto& limit : effort_limit) effort = limit(effort, w);
  return effort;
}

double Drive::deliver(DriveMotion& motion, double u_V, double w, double duration_s) const {
  const double wanted = command_effort(u_V, w);
  if (current_lag_s <= 0.0) return motion.effort = wanted;
  return lag_mean(motion.effort, wanted, current_lag_s, duration_s);
}

void Drive::filter_tach(DriveMotion& motion, double w_before, double duration_s) const {
  if (tach_lag_s <= 0.0) {
    motion.tach = motion.w;
    return;
  }
  // The speed is linear between its values before and after: the exact response to a ramp.
  const double slope = (motion.w - w_before) / duration_s;
  motion.tach =
      motion.w - tach_lag_s * slope + (motion.tach - w_before + tach_lag_s * slope) * decay(duration_s / tach_lag_s);
}

template <Drive::Mechanics kMechanics, typename Contact>
[[gnu::always_inline]] inline void Drive::move_masses(DriveMotion& motion, double effort, double duration_s, int parts,
                                                      Contact& contact) const {
  if constexpr (kMechanics == Mechanics::two_masses) {
    move_two_masses(*coupling_, lead, motion, effort, duration_s, parts, contact);
  } else if constexpr (kMechanics == Mechanics::bristles) {
    move_on_bristles(*bristles, mobility_, lead, motion, effort, duration_s, parts, contact);
  } else {
    SlidingMass mass{motion.x, motion.w, mobility_, lead};
    for (int part = 0; part < parts; ++part) slide(mass, effort, duration_s, contact);
    motion.x = mass.x;
    motion.w = mass.w;
  }
}

template <Drive::Mechanics kMechanics, typename Contact>
[[gnu::always_inline]] inline void Drive::push(DriveMotion& motion, double effort, double t_s,
                                               double duration_s) const {
  const double middle_x = motion.x + 0.5 * duration_s * lead * motion.w;
  const double motor = effort * product(effort_factor, middle_x);
  const double w_before = motion.w;
  Contact contact(*this, motion, t_s, middle_x, motor);
  move_masses<kMechanics>(motion, with_loads(motor, w_before, t_s, middle_x), duration_s, 1, contact);
  // A force behind the screw stops the axis, and does not drive it back.
  if (!effort_behind_screw.empty() && w_before * motion.w < 0.0 && behind_screw(t_s) * motion.w > 0.0) motion.w = 0.0;
}

template <Drive::Mechanics kMechanics, typename Contact>
void Drive::move(DriveMotion& motion, double effort, double t_s, double duration_s) const {
  const double w_before = motion.w;
  push<kMechanics, Contact>(motion, effort, t_s, duration_s);
  if (friction_memory_s > 0.0)
    lag_mean(motion.friction_speed, 0.5 * std::abs(w_before + motion.w), friction_memory_s, duration_s);
  note_reversal(motion, motion.x, motion.w);
  filter_tach(motion, w_before, duration_s);
}

void Drive::note_reversal(DriveMotion& motion, double x, double w) const {
  if (friction_after_reversal.empty() || w * motion.heading > 0.0 || w == 0.0) return;
  motion.turned_x = x;
  motion.heading = w > 0.0 ? 1.0 : -1.0;
}

[[gnu::always_inline]] inline int Drive::parts_of(double duration_s, double w) const {
  // A ripple with several periods in a sixth of the interval averages out without further parts.
  constexpr double kMostParts = 6.0;
  double wanted = duration_s * parts_per_s_;
  if (parts_per_travel_ > 0.0)
    wanted = std::max(wanted, std::min(std::abs(w) * lead * duration_s * parts_per_travel_, kMostParts));
  wanted -= 1e-9;
  const int whole = static_cast<int>(wanted);
  return whole < wanted ? whole + 1 : std::max(whole, 1);
}

template <Drive::Mechanics kMechanics, typename Contact>
void Drive::hold(DriveState& state, double u_V, double t_s, double duration_s) const {
  const int parts = parts_of(duration_s, state.w);
  const double part_s = parts == 1 ? duration_s : duration_s / parts;
  if (remembers_ || !effort_limit.empty()) {
    for (int part = 0; part < parts; ++part) {
      const double at_s = t_s + part * part_s;
      const double w = limiting_speed<kMechanics, Contact>(state, u_V, at_s, part_s);
      move<kMechanics, Contact>(state, deliver(state, u_V, w, part_s), at_s, part_s);
    }
    return;
  }
  const double effort = command_effort(u_V, state.w);
  if (bare_) {
    Contact contact(*this, state, t_s, state.x, 0.0);
    move_masses<kMechanics>(state, effort, part_s, parts, contact);
  } else {
    for (int part = 0; part < parts; ++part) push<kMechanics, Contact>(state, effort, t_s + part * part_s, part_s);
  }
  state.tach = state.w;
}

template <Drive::Mechanics kMechanics, typename Contact>
double Drive::limiting_speed(const DriveMotion& motion, double u_V, double t_s, double duration_s) const {
  // A limit that depends on speed is evaluated at the middle of the step, which a trial step gives: order 2.
  if (effort_limit.empty() || command_effort(u_V, motion.w) == command_effort(u_V, 0.0)) return motion.w;
  DriveMotion trial = motion;
  move<kMechanics, Contact>(trial, deliver(trial, u_V, motion.w, duration_s), t_s, duration_s);
  return 0.5 * (motion.w + trial.w);
}

template <Drive::Mechanics kMechanics, typename Contact>
void Drive::directly(DriveState& state, double u_V, double t_s, double duration_s) const {
  Contact contact(*this, state, t_s, state.x, 0.0);
  const int parts = kMechanics == Mechanics::one_mass ? 1 : parts_of(duration_s, state.w);
  move_masses<kMechanics>(state, effort_per_volt * u_V, duration_s / parts, parts, contact);
  state.tach = state.w;
}

template <Drive::Mechanics kMechanics, typename Contact>
void Drive::delay(DriveState& state, double u_V, double t_s, double duration_s) const {
  const std::size_t whole = whole_periods_of_delay(duration_s);
  const double rest_s = std::min(delay_s - static_cast<double>(whole) * duration_s, duration_s);
  const double older = state.past_u_V[whole], newer = whole == 0 ? u_V : state.past_u_V[whole - 1];
  bool moved = false;
  if constexpr (kMechanics == Mechanics::one_mass)
    if (bare_) {
      SlidingMass mass{state.x, state.w, mobility_, lead};
      Contact contact(*this, state, t_s, state.x, 0.0);
      moved = slide_through_change(mass, command_effort(older, state.w), command_effort(newer, state.w), rest_s,
                                   duration_s, contact);
      state.x = mass.x;
      state.w = state.tach = mass.w;
    }
  if (!moved && rest_s > 0.0) hold<kMechanics, Contact>(state, older, t_s, rest_s);
  if (!moved && rest_s < duration_s) hold<kMechanics, Contact>(state, newer, t_s + rest_s, duration_s - rest_s);
  remember_command(state, u_V, whole);
}

template <Drive::Mechanics kMechanics, typename Contact>
Drive::Step Drive::cheapest_step_of() const {
  if (delay_s > 0.0) return &Drive::delay<kMechanics, Contact>;
  return bare_ && straight_command_ ? &Drive::directly<kMechanics, Contact> : &Drive::hold<kMechanics, Contact>;
}

template <typename Contact>
Drive::Step Drive::cheapest_step() const {
  if (coupling_) return cheapest_step_of<Mechanics::two_masses, Contact>();
  if (bristles) return cheapest_step_of<Mechanics::bristles, Contact>();
  return cheapest_step_of<Mechanics::one_mass, Contact>();
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
         !load_effort.empty() || !effort_behind_screw.empty();
}

double Drive::breakaway_effort(DriveState& state, double effort, double t_s) const {
  return RichContact(*this, state, t_s, state.x, effort).breakaway(effort >= 0.0 ? 0 : 1);
}

double Drive::sliding_effort(DriveState& state, double effort, double t_s) const {
  const RichContact contact(*this, state, t_s, state.x, effort);
  const double magnitude = contact.sliding(state.w >= 0.0 ? 0 : 1, std::abs(state.w)).effort;
  return state.w >= 0.0 ? magnitude : -magnitude;
}

void Drive::observe(DriveState& state, double u_V, double x1, double t_s, double duration_s) const {
  // An alpha-beta tracker: it pulls the motor towards its measured travel like a spring and a damper, without exciting
  // the second mass. Alpha 0.15 averages the travel over about seven samples.
  constexpr double kAlpha = 0.15;
  constexpr double kBeta = kAlpha * kAlpha / (2.0 - kAlpha);
  step(state, u_V, t_s, duration_s);
  const double off = x1 - state.x;
  state.x += kAlpha * off;
  state.w += kBeta * off / (lead * duration_s);
}

double Drive::follow(DriveState& state, double u_V, double x1, double w1, double t_s, double duration_s) const {
  if (second_mass) {
    if (dwell_gain <= 0.0) {
      observe(state, u_V, x1, t_s, duration_s);
      return 0.0;
    }
    const DriveMotion before = static_cast<const DriveMotion&>(state);
    observe(state, u_V, x1, t_s, duration_s);
    follow_rest_of_two(state, before, u_V, w1, t_s, duration_s);
    return 0.0;
  }
  const double w0 = state.w;
  note_reversal(state, state.x, w1);
  const double middle_x = 0.5 * (state.x + x1);
  const double mean_w = 0.5 * (w0 + w1);
  const double motor = deliver_over(state, u_V, duration_s) * product(effort_factor, middle_x);
  const double effort = with_loads(motor, mean_w, t_s, middle_x);
  if (friction_memory_s > 0.0) lag_mean(state.friction_speed, std::abs(mean_w), friction_memory_s, duration_s);
  if (dwell_gain > 0.0 || bristles) {
    const RichContact contact(*this, state, t_s, middle_x, motor);
    const double contact_effort = effort - inertia * (w1 - w0) / duration_s;
    if (dwell_gain > 0.0) follow_rest(state, w0, w1, contact_effort, duration_s, contact);
    if (bristles) follow_bristles(*bristles, inertia, state, mean_w, contact_effort, duration_s, contact);
  }
  state.x = x1;
  state.w = w1;
  filter_tach(state, w0, duration_s);
  return effort;
}

void Drive::follow_rest_of_two(DriveState& state, const DriveMotion& before, double u_V, double w1, double t_s,
                               double duration_s) const {
  // The measured motion tells rests from slow motion, because observed masses never stand still. On average over some
  // samples, the load moves as the motor does.
  state.rest_s = before.rest_s;
  state.slide_s = before.slide_s;
  state.restuck = before.restuck;
  state.breakaway_gain = before.breakaway_gain;
  const double w0 = before.seen_w, motor = command_effort(u_V, w0) * product(effort_factor, state.x);
  const RichContact contact(*this, state, t_s, state.x, motor);
  const double contact_effort = with_loads(motor, 0.5 * (w0 + w1), t_s, state.x) - inertia * (w1 - w0) / duration_s;
  follow_rest(state, w0, w1, contact_effort, duration_s, contact);
  if (w1 == 0.0) state.w = 0.0;
  state.seen_w = w1;
}

double Drive::rest_to_hold(DriveState state, double effort, double t_s) const {
  if (dwell_gain <= 0.0) return 0.0;
  const RichContact contact(*this, state, t_s, state.x, effort);
  const int side = effort >= 0.0 ? 0 : 1;
  state.rest_s = 0.0;
  const double fresh = contact.breakaway(side);
  state.rest_s = HUGE_VAL;
  const double part = (std::abs(effort) - fresh) / (contact.breakaway(side) - fresh);
  return part <= 0.0 ? 0.0 : part >= 1.0 ? HUGE_VAL : -dwell_time_s * std::log1p(-part);
}

void Drive::follow_rest(DriveMotion& motion, double w0, double w1, double contact_effort, double duration_s,
                        const RichContact& contact) const {
  if (w0 == 0.0 && w1 == 0.0) {
    motion.rest_s += duration_s;
    motion.slide_s = motion.restuck = 0.0;
    motion.breakaway_gain = dwell_gain * -std::expm1(-motion.rest_s / dwell_time_s);
    return;
  }
  // A smoothed start may cross zero speed briefly. An undetected stop is possible only after a motion of this duration.
  constexpr double kRealMotion_s = 0.02;
  motion.rest_s = 0.0;
  if (w0 * w1 < 0.0 && motion.slide_s > kRealMotion_s) {
    motion.breakaway_gain = motion.slide_s = motion.restuck = 0.0;
  }
  motion.slide_s += duration_s;
  if (motion.breakaway_gain <= 0.0) return;
  // At creep a stop of a millisecond is not detected, although it ends the increase of static friction after the last
  // rest. So the observed friction, averaged over about 30 ms, is compared with the levels with and without this
  // increase.
  constexpr double kAveraging_s = 0.03;
  const double w = 0.5 * (w0 + w1);
  const int side = w >= 0.0 ? 0 : 1;
  const double with = contact.sliding(side, std::abs(w)).effort;
  const double gain = std::exchange(motion.breakaway_gain, 0.0);
  const double without = contact.sliding(side, std::abs(w)).effort;
  motion.breakaway_gain = gain;
  const double shown = (w >= 0.0 ? 1.0 : -1.0) * contact_effort;
  const double levels_apart = with - without;
  if (levels_apart <= 1e-3 * with) return;
  const double verdict = (0.5 * (with + without) - shown) / levels_apart;
  motion.restuck += (verdict - motion.restuck) * duration_s / kAveraging_s;
  if (motion.slide_s > 2.0 * kAveraging_s && motion.restuck > 0.25) motion.breakaway_gain = 0.0;
}

double Drive::encoder_error_at(double x) const { return sum_at(encoder_error, x); }

double Drive::travel_at_reading(double reading) const {
  // Each step multiplies the residual by the slope of the encoder error. It is below a thousandth after two steps for
  // any real encoder, and after 16 steps even if the slope is 0.5.
  constexpr int kMostSteps = 16;
  constexpr double kSettled = 1e-3;  // of the error
  double error = encoder_error_at(reading);
  for (int step = 0; step < kMostSteps; ++step) {
    const double before = error;
    error = encoder_error_at(reading - before);
    if (std::abs(error - before) <= kSettled * std::abs(error)) break;
  }
  return reading - error;
}

double Drive::tach_ripple_at(double x) const { return 1.0 + sum_at(tach_ripple, x); }

}  // namespace sim
