#include "host/hil/fault_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/hil/commissioning.hpp"
#include "host/hil/path.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/parameters/stopping_way.hpp"

namespace host {

namespace {

using firmware::AxisFault;
using firmware::SupervisorState;

using MachineAxes = std::array<MachineAxis, hal::kAxisCount>;

/// Torque of the brake: twice the friction of the paper's motor. It stops the axis from 250 mm/s in 9 mm.
constexpr double kBrake_Nm = 20.0;

/// A drive with a tenth of the paper's friction, on the paper's screw: without current, the axis coasts for a metre.
sim::DriveDescription light_drive(std::string_view name) {
  sim::DriveDescription drive = *paper_drive(name);
  const auto effect = [](const char* kind, std::map<std::string, double> values) {
    return sim::EffectEntry{.kind = kind, .parameters = std::move(values), .ci95 = {}, .from = {}};
  };
  drive.effects = {effect("inertia", {{"J", 0.010}}), effect("viscous", {{"B", 0.001}}),
                   effect("coulomb", {{"positive", 0.2}, {"negative", -0.2}})};
  return drive;
}

MachineAxes design_axes(bool tachometer, bool under_weight, bool light) {
  MachineAxes made;
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    made[i].drive = light ? light_drive(kAxisNames[i]) : *paper_drive(kAxisNames[i]);
    if (!tachometer) made[i].drive.data.tach_noise_variance.reset();
    made[i].parameters = contouring_parameters(made[i].drive, {.friction = true, .cancellation = under_weight});
  }
  return made;
}

MachineAxes axes_of(const FaultTrial& trial) {
  static const std::array<MachineAxes, 8> designed = [] {
    std::array<MachineAxes, 8> all;
    for (unsigned i = 0; i < all.size(); ++i) all[i] = design_axes((i & 1u) != 0, (i & 2u) != 0, (i & 4u) != 0);
    return all;
  }();
  MachineAxes axes =
      designed[(trial.tachometer ? 1u : 0u) + (trial.weight_Nm != 0.0 ? 2u : 0u) + (trial.light ? 4u : 0u)];
  for (MachineAxis& axis : axes) {
    axis.parameters.acceleration_limit = static_cast<float>(trial.acceleration_mm_s2);
    axis.parameters.encoder_fault_input = trial.encoder_fault_input;
    axis.parameters.sequence = {.ready_input = trial.start.ready_input,
                                .brake_fitted = trial.start.brake,
                                .amplifier_wait = trial.start.ready_ms,
                                .brake_release = kTrialBrake_ms,
                                .brake_application = kTrialBrake_ms};
    axis.wiring.ready_after_s = 0.5e-3 * trial.start.ready_ms;
    const double inertia_kg_m2 = axis.drive.effects.front().at("J");
    if (trial.start.brake) axis.wiring.brake.deceleration = kBrake_Nm / inertia_kg_m2;
    if (trial.weight_Nm != 0.0)
      axis.drive.effects.push_back(
          {.kind = "constant_torque", .parameters = {{"torque", trial.weight_Nm}}, .ci95 = {}, .from = {}});
  }
  return axes;
}

class TrialRun {
 public:
  explicit TrialRun(const FaultTrial& trial) : trial_(trial), axes_(axes_of(trial)), machine_(axes_, trial.seed) {}

  TrialOutcome run() {
    prepare();
    for (int k = 0; k < trial_.sample; ++k) step();
    if (trial_.motion == TrialMotion::stopping) {
      machine_.axes()[trial_.first.axis].disable();
      for (int k = 0; k < trial_.since_disable; ++k) step();
    }
    apply(trial_.first);
    injected_at_ = machine_.samples();
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) injected_at_mm_[i] = machine_.plant(i).truth().x;
    // A light axis without current coasts for 8 s from 250 mm/s.
    const int longest = (trial_.light ? 14000 : 4000) + 3 * stretch();
    for (int k = 0; k < longest && !is_over(); ++k) {
      if (k == trial_.delay && trial_.second.injection != nullptr) {
        apply(trial_.second);
        second_counts_ = !fault_seen_;
      }
      if (!fault_seen_) keep_moving(k);
      step();
    }
    return outcome();
  }

 private:
  MachineGroup& axes() { return machine_.axes(); }

  struct Stop {
    double begin_mm = 0.0, speed_mm_s = 0.0, acceleration_mm_s2 = 0.0, drop_speed_mm_s = 0.0, way_mm = 0.0;
    double top_speed_mm_s = 0.0, low_speed_mm_s = 0.0;
    double gained_from_mm_s = 0.0, gained_to_mm_s = 0.0;  ///< speeds between which the axis gained most
    bool drives = false;
    std::uint64_t begin = 0;  ///< sample
    int driven_off = 0;       ///< samples in which the axis was driven although its enable was off
  };

  double speed_mm_s(std::size_t axis) const {
    return std::abs(machine_.plant(axis).truth().w) * axes_[axis].drive.data.lead;
  }

  /// Gain of speed that follows from the acceleration of the reference.
  static double usual_gain_mm_s(const Stop& stop) {
    return stop.acceleration_mm_s2 * stop.acceleration_mm_s2 / (2.0 * ReferenceLimits{}.jerk);
  }

  /// Stopping distance and time by formula, with the true drive and brake, along the ramp and from the speed after a
  /// second fault.
  StoppingWay by_formula(std::size_t axis) const {
    const Stop& stop = stops_[axis];
    StoppingFigures figures = stopping_figures(axes_[axis].drive, std::max(stop.top_speed_mm_s, 1.0),
                                               trial_.acceleration_mm_s2, ReferenceLimits{}.jerk);
    figures.brake = trial_.start.brake;
    figures.brake_time_s = 1e-3 * kTrialBrake_ms;
    figures.brake_effort = kBrake_Nm;
    if (stop.gained_to_mm_s - stop.gained_from_mm_s <= usual_gain_mm_s(stop))
      return broken_ramp_way(figures, stop.speed_mm_s, stop.top_speed_mm_s, stop.drop_speed_mm_s,
                             stop.acceleration_mm_s2);
    const double from_mm_s = stop.gained_from_mm_s, to_mm_s = stop.gained_to_mm_s;
    const StoppingWay before =
        broken_ramp_way(figures, stop.speed_mm_s, stop.speed_mm_s, from_mm_s, stop.acceleration_mm_s2);
    const StoppingWay without = from_mm_s > 0.0 ? drop_way(figures, from_mm_s) : StoppingWay{};
    const StoppingWay after = broken_ramp_way(figures, to_mm_s, to_mm_s, stop.drop_speed_mm_s, 0.0);
    return {before.travel - without.travel + after.travel, before.time_s - without.time_s + after.time_s};
  }

  /// Time in which the full command and the weight would accelerate the axis to its highest speed.
  double gain_s(std::size_t axis) const {
    const Stop& stop = stops_[axis];
    const sim::DriveDescription& drive = axes_[axis].drive;
    const double effort = drive.data.dac_limit_V * drive.data.effort_per_volt() + std::abs(trial_.weight_Nm);
    const double gained_mm_s = std::max(0.0, stop.top_speed_mm_s - stop.speed_mm_s - usual_gain_mm_s(stop));
    return gained_mm_s * drive.effects.front().at("J") / (effort * drive.data.lead);
  }

  void apply(const TrialInjection& what) { what.injection->apply(machine_, what.axis, what.value); }

  void prepare() {
    if (trial_.motion == TrialMotion::self_test) return;
    for (int k = 0; k <= firmware::kSelfTestSamples; ++k) machine_.step();
    if (trial_.motion == TrialMotion::ready) return;
    enable();
    if (trial_.motion == TrialMotion::starting) return;
    for (int k = 0; k < 1 + trial_.start.ready_ms + 2 * kTrialBrake_ms && !all_enabled(); ++k) machine_.step();
    switch (trial_.motion) {
      case TrialMotion::jog:
      case TrialMotion::stopping:
        jog(1.0);
        break;
      case TrialMotion::move:
        for (std::size_t i = 0; i < hal::kAxisCount; ++i)
          axes()[i].start(
              axes()[i].plan_move_to(firmware::CountPosition::at(trial_.speed_mm_s > 0 ? 40'000 : -40'000)).plan);
        break;
      case TrialMotion::circle:
        path_ = follow_path(Path::circle(35.0), {}, machine_.sample_period_s(),
                            {axes_[0].drive.data.encoder_resolution, axes_[1].drive.data.encoder_resolution});
        break;
      default:
        break;
    }
  }

  bool all_enabled() {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i)
      if (axes()[i].state() != SupervisorState::enabled) return false;
    return true;
  }
  void enable() {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) axes()[i].enable();
  }
  void disable() {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) axes()[i].disable();
  }
  void jog(double sense) {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i)
      axes()[i].jog(static_cast<float>((i == 0 ? sense : -sense) * trial_.speed_mm_s));
  }

  /// Samples of a jog before it reverses: enough to reach the speed from the opposite speed.
  int stretch() const {
    return 400 + static_cast<int>(2000.0 * std::abs(trial_.speed_mm_s) / trial_.acceleration_mm_s2);
  }

  /// Moves in both directions, which reveals faults that are hidden at rest.
  void keep_moving(int k) {
    constexpr int kPatience = 1000;
    const bool path_runs = place_ < path_.size();
    if (trial_.motion == TrialMotion::starting && !all_enabled() && k < kPatience) return;
    if (path_runs || (trial_.motion == TrialMotion::move && k < kPatience)) return;
    if (trial_.motion == TrialMotion::stopping && k < kPatience / 2) return;
    if (k >= kPatience * 3 + 2 * stretch()) return disable();  // some faults are found only when the axis is disabled
    enable();
    if (k % stretch() == 100) jog(k / stretch() % 2 == 0 ? 1.0 : -1.0);
  }

  void step() {
    std::array<double, hal::kAxisCount> speed_before{};
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      was_on_[i] = firmware::outputs_are_on(axes()[i].state());
      speed_before[i] = speed_mm_s(i);
    }
    if (place_ < path_.size())
      machine_.step_with(path_[place_++]);
    else
      machine_.step();
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      if (!injected_at_ || fault_seen_ || axes()[i].fault() == AxisFault::none) continue;
      fault_seen_ = machine_.samples();
      fault_ = axes()[i].fault();
      for (std::size_t j = 0; j < hal::kAxisCount; ++j) {
        must_latch_[j] =
            j == i || (was_on_[j] && axes()[j].state() != SupervisorState::ready);  // it may stand at that moment
        const double gained = (speed_mm_s(j) - speed_before[j]) / machine_.sample_period_s();
        stops_[j] = {.begin_mm = machine_.plant(j).truth().x,
                     .speed_mm_s = speed_mm_s(j),
                     .acceleration_mm_s2 = std::clamp(gained, 0.0, trial_.acceleration_mm_s2),
                     .top_speed_mm_s = speed_mm_s(j),
                     .low_speed_mm_s = speed_mm_s(j),
                     .drives = true,
                     .begin = machine_.samples()};
      }
    }
    if (fault_seen_) follow_stop();
  }

  /// For an amplifier that drives without its enable, only the time is specified. The axis coasts from the position at
  /// which the power is cut.
  void follow_stop() {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      const double x = machine_.plant(i).truth().x;
      whole_way_mm_ = std::max(whole_way_mm_, std::abs(x - injected_at_mm_[i]));
      Stop& stop = stops_[i];
      if (machine_.wires(i).is_driven() && !machine_.wires(i).drive_enable().is_on()) {
        stop = {.begin_mm = x,
                .speed_mm_s = speed_mm_s(i),
                .drop_speed_mm_s = speed_mm_s(i),
                .top_speed_mm_s = speed_mm_s(i),
                .low_speed_mm_s = speed_mm_s(i),
                .begin = machine_.samples(),
                .driven_off = stop.driven_off + 1};
        continue;
      }
      stop.way_mm = std::max(stop.way_mm, std::abs(x - stop.begin_mm));
      if (stop.drives) {
        stop.top_speed_mm_s = std::max(stop.top_speed_mm_s, speed_mm_s(i));
        stop.low_speed_mm_s = std::min(stop.low_speed_mm_s, speed_mm_s(i));
        if (speed_mm_s(i) - stop.low_speed_mm_s > stop.gained_to_mm_s - stop.gained_from_mm_s) {
          stop.gained_from_mm_s = stop.low_speed_mm_s;
          stop.gained_to_mm_s = speed_mm_s(i);
        }
      }
      if (stop.drives && !machine_.wires(i).is_driven()) {
        stop.drives = false;
        stop.drop_speed_mm_s = speed_mm_s(i);
      }
    }
  }

  bool is_safe() {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      constexpr double kStanding_rad_s = 0.01;
      if (machine_.wires(i).drive_enable().is_on() || machine_.wires(i).dac().commanded() != 0 ||
          std::abs(machine_.plant(i).truth().w) > kStanding_rad_s)
        return false;
    }
    return true;
  }

  bool is_over() { return fault_seen_ && is_safe(); }

  TrialOutcome outcome() {
    const auto names = [&](const TrialInjection& what) {
      return std::ranges::find(what.injection->named_by, fault_) != what.injection->named_by.end();
    };
    TrialOutcome result;
    result.fault = fault_;
    result.is_named = names(trial_.first) || (second_counts_ && names(trial_.second));
    result.is_safe = is_safe();
    result.is_latched = fault_seen_.has_value();
    for (std::size_t i = 0; i < hal::kAxisCount; ++i)
      result.is_latched = result.is_latched && (!must_latch_[i] || axes()[i].state() == SupervisorState::fault);
    if (!fault_seen_) return result;
    const double period_s = machine_.sample_period_s();
    result.reaction_s = static_cast<double>(*fault_seen_ - *injected_at_) * period_s;
    result.stop_s = static_cast<double>(machine_.samples() - *fault_seen_) * period_s;
    result.whole_way_mm = whole_way_mm_;
    double stated_s = 0.0;  ///< from the fault until the last axis stands
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      const StoppingWay stated = by_formula(i);
      stated_s = std::max(stated_s, static_cast<double>(stops_[i].begin - *fault_seen_) * period_s + stated.time_s);
      result.distance_mm = std::max(result.distance_mm, stops_[i].way_mm);
      result.beyond_mm = std::max(result.beyond_mm, stops_[i].way_mm - stated.travel);
      result.gain_s = std::max(result.gain_s, gain_s(i));
      result.driven_off_s = std::max(result.driven_off_s, stops_[i].driven_off * period_s);
      result.speed_mm_s = std::max(result.speed_mm_s, stops_[i].speed_mm_s);
    }
    result.beyond_s = std::max(0.0, result.stop_s - stated_s);
    return result;
  }

  FaultTrial trial_;
  MachineAxes axes_;
  Machine machine_;
  std::vector<std::array<firmware::Increment, hal::kAxisCount>> path_;
  std::size_t place_ = 0;
  std::optional<std::uint64_t> injected_at_, fault_seen_;
  std::array<double, hal::kAxisCount> injected_at_mm_{};
  std::array<Stop, hal::kAxisCount> stops_{};
  std::array<bool, hal::kAxisCount> was_on_{}, must_latch_{};
  AxisFault fault_ = AxisFault::none;
  bool second_counts_ = false;  ///< the second fault came before the first was found
  double whole_way_mm_ = 0.0;
};

const char* reaction_name(firmware::FaultReaction reaction) {
  switch (reaction) {
    case firmware::FaultReaction::ramp_stop:
      return "stops along a ramp";
    case firmware::FaultReaction::sensor_stop:
      return "slows down with the remaining sensor; drops the enable at once if there is none";
    case firmware::FaultReaction::drop_enable:
      return "drops the enable at once";
    case firmware::FaultReaction::none:
      break;
  }
  return "refuses to enable";
}

}  // namespace

std::string FaultTrial::text() const {
  const auto named = [](const TrialInjection& what) {
    return fmt::format("{} = {:g} on axis {}", what.injection->kind, what.value, kAxisNames[what.axis]);
  };
  std::string faults = named(first);
  if (second.injection != nullptr) faults += fmt::format(", {} samples later {}", delay, named(second));
  return fmt::format(
      "{}, {} at {:g} mm/s ({:g} mm/s^2, {}{} tachometer, {} fault output of the encoder, {} ms until {}, {} brake, "
      "{:g} Nm "
      "of weight), sample {}{}, "
      "seed {}",
      faults, kTrialMotions[static_cast<std::size_t>(motion)], speed_mm_s, acceleration_mm_s2, light ? "light, " : "",
      tachometer ? "with" : "without", encoder_fault_input ? "with" : "without", start.ready_ms,
      start.ready_input ? "late" : "ready", start.brake ? "with" : "without", weight_Nm, sample,
      motion == TrialMotion::stopping ? fmt::format(" and {}", since_disable) : "", seed);
}

TrialOutcome run_trial(const FaultTrial& trial) { return TrialRun(trial).run(); }

std::string fault_page() {
  std::string page =
      "<!-- Written by `axistool hil --fault-page`; a test compares. -->\n# Faults\n\nThe first fault of an axis is "
      "latched, with the 100 ms before it; clearing it runs the self-test again. Both axes stop together.\n\n"
      "| number | fault | cause | remedy | the axis |\n|---|---|---|---|---|\n";
  for (const auto& info : firmware::kFaults)
    if (info.fault != AxisFault::none)
      page += fmt::format("| {} | `{}` | {} | {} | {} |\n", static_cast<int>(info.fault), info.name, info.cause,
                          info.remedy, reaction_name(info.reaction));
  page += fmt::format(
      "\n# What each injected fault does\n\nSimulated on the paper's axes, jogging at 250 mm/s when it happens (or "
      "first moved after it: then the reaction counts from the injection, the motion included). Stated for every "
      "trial, one fault or two: each axis stands within the way by formula (README, \"The board\") along its ramp, and "
      "from the speed at which the amplifier stops driving, if it does, and {:g} mm, in the formula's time and {:g} "
      "s.\n\n| injection | while | fault | reaction, ms | stop, ms | distance, mm |\n"
      "|---|---|---|---|---|---|\n",
      kStatedExtra_mm, kStatedExtra_s);
  for (const InjectionInfo& info : injections()) {
    for (const TrialMotion motion : {TrialMotion::starting, TrialMotion::standing, TrialMotion::jog}) {
      if (info.kind == "motor_reversed" && motion == TrialMotion::jog) continue;  // nobody swaps cables in motion
      const bool is_start = motion == TrialMotion::starting;
      if (is_start ? info.kind != "dac_stuck" && info.needs == InjectionInfo::Needs::nothing
                   : info.needs == InjectionInfo::Needs::open_loop)
        continue;
      const TrialStart start{.ready_ms = is_start || info.needs == InjectionInfo::Needs::ready_input ? 500 : 0,
                             .ready_input = info.needs == InjectionInfo::Needs::ready_input,
                             .brake = info.needs == InjectionInfo::Needs::brake};
      const TrialOutcome outcome =
          run_trial({.first = {&info, 0, info.usual},
                     .second = {},
                     .motion = motion,
                     .sample = is_start ? 100 : 300,
                     .speed_mm_s = 250.0,
                     .encoder_fault_input = info.needs == InjectionInfo::Needs::encoder_fault_input,
                     .start = start});
      page += fmt::format("| {} | {} | `{}` | {:.0f} | {:.0f} | {:.1f} |\n", info.what,
                          kTrialMotions[static_cast<std::size_t>(motion)], firmware::fault_info(outcome.fault).name,
                          1e3 * outcome.reaction_s, 1e3 * outcome.stop_s, outcome.distance_mm);
    }
  }
  return page;
}

}  // namespace host
