#include "host/hil/fault_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/hil/commissioning.hpp"
#include "host/hil/path.hpp"
#include "host/identify/paper_drives.hpp"

namespace host {

namespace {

using firmware::AxisFault;
using firmware::SupervisorState;

const std::array<MachineAxis, kMachineAxes>& paper_axes() {
  static const std::array<MachineAxis, kMachineAxes> axes = [] {
    std::array<MachineAxis, kMachineAxes> made;
    for (std::size_t i = 0; i < kMachineAxes; ++i) {
      made[i].drive = *paper_drive(kAxisNames[i]);
      made[i].parameters = contouring_parameters(made[i].drive, {.friction = true, .cancellation = false});
    }
    return made;
  }();
  return axes;
}

class Trial {
 public:
  explicit Trial(const FaultTrial& trial) : trial_(trial), machine_(paper_axes(), trial.seed) {}

  TrialOutcome run() {
    prepare();
    for (int k = 0; k < trial_.sample; ++k) step();
    trial_.injection->apply(machine_, trial_.axis, trial_.value);
    injected_at_ = machine_.samples();
    if (trial_.motion == TrialMotion::stopping) machine_.axes()[trial_.axis].disable();
    constexpr int kLongest = 4000;
    for (int k = 0; k < kLongest && !is_over(); ++k) {
      if (!fault_seen_) keep_moving(k);
      step();
    }
    return outcome();
  }

 private:
  MachineGroup& axes() { return machine_.axes(); }

  void prepare() {
    if (trial_.motion == TrialMotion::self_test) return;
    for (int k = 0; k <= firmware::kSelfTestSamples; ++k) machine_.step();
    if (trial_.motion == TrialMotion::ready) return;
    enable();
    machine_.step();
    switch (trial_.motion) {
      case TrialMotion::jog:
      case TrialMotion::stopping:
        jog(1.0);
        break;
      case TrialMotion::move:
        for (std::size_t i = 0; i < kMachineAxes; ++i)
          axes()[i].start(
              axes()[i].plan_move_to(firmware::CountPosition::at(trial_.speed_mm_s > 0 ? 40'000 : -40'000)).plan);
        break;
      case TrialMotion::circle:
        path_ =
            follow_path(Path::circle(35.0), {}, machine_.sample_period_s(),
                        {paper_axes()[0].drive.data.encoder_resolution, paper_axes()[1].drive.data.encoder_resolution});
        break;
      default:
        break;
    }
  }

  void enable() {
    for (std::size_t i = 0; i < kMachineAxes; ++i) axes()[i].enable();
  }
  void jog(double sense) {
    for (std::size_t i = 0; i < kMachineAxes; ++i)
      axes()[i].jog(static_cast<float>((i == 0 ? sense : -sense) * trial_.speed_mm_s));
  }

  /// What a fault hides while the axes stand, shows when they move both ways.
  void keep_moving(int k) {
    constexpr int kPatience = 1000, kStretch = 400;
    const bool path_runs = place_ < path_.size();
    if (path_runs || (trial_.motion == TrialMotion::move && k < kPatience)) return;
    if (trial_.motion == TrialMotion::stopping && k < kPatience / 2) return;
    enable();
    if (k % kStretch == kStretch / 4) jog(k / kStretch % 2 == 0 ? 1.0 : -1.0);
  }

  void step() {
    if (place_ < path_.size())
      machine_.step_with(path_[place_++]);
    else
      machine_.step();
    for (std::size_t i = 0; i < kMachineAxes; ++i) {
      if (!injected_at_ || fault_seen_ || axes()[i].fault() == AxisFault::none) continue;
      fault_seen_ = machine_.samples();
      for (std::size_t j = 0; j < kMachineAxes; ++j) begin_mm_[j] = machine_.plant(j).truth().x;
    }
    if (!fault_seen_) return;
    for (std::size_t i = 0; i < kMachineAxes; ++i)
      distance_mm_ = std::max(distance_mm_, std::abs(machine_.plant(i).truth().x - begin_mm_[i]));
  }

  bool is_safe() {
    for (std::size_t i = 0; i < kMachineAxes; ++i) {
      constexpr double kStanding_rad_s = 0.01;
      if (machine_.wires(i).drive_enable().is_on() || machine_.wires(i).dac().commanded() != 0 ||
          std::abs(machine_.plant(i).truth().w) > kStanding_rad_s)
        return false;
    }
    return true;
  }

  bool is_over() { return fault_seen_ && is_safe(); }

  TrialOutcome outcome() {
    TrialOutcome result;
    const bool own = !trial_.injection->of_board;
    result.fault = axes()[own ? trial_.axis : 0].fault();
    if (!own && result.fault == AxisFault::none) result.fault = axes()[1].fault();
    result.is_named = std::ranges::find(trial_.injection->named_by, result.fault) != trial_.injection->named_by.end();
    result.is_safe = is_safe();
    if (!fault_seen_) return result;
    const double period_s = machine_.sample_period_s();
    result.reaction_s = static_cast<double>(*fault_seen_ - *injected_at_) * period_s;
    result.stop_s = static_cast<double>(machine_.samples() - *fault_seen_) * period_s;
    result.distance_mm = distance_mm_;
    return result;
  }

  FaultTrial trial_;
  Machine machine_;
  std::vector<std::array<firmware::Increment, kMachineAxes>> path_;
  std::size_t place_ = 0;
  std::optional<std::uint64_t> injected_at_, fault_seen_;
  std::array<double, kMachineAxes> begin_mm_{};
  double distance_mm_ = 0.0;
};

const char* reaction_name(firmware::FaultReaction reaction) {
  switch (reaction) {
    case firmware::FaultReaction::ramp_stop:
      return "stops along a ramp";
    case firmware::FaultReaction::drop_enable:
      return "drops the enable at once";
    case firmware::FaultReaction::none:
      break;
  }
  return "refuses to enable";
}

}  // namespace

std::string FaultTrial::text() const {
  return fmt::format("{} = {:g} on axis {}, {} at {:g} mm/s, sample {}, seed {}", injection->kind, value,
                     kAxisNames[axis], kTrialMotions[static_cast<std::size_t>(motion)], speed_mm_s, sample, seed);
}

TrialOutcome run_trial(const FaultTrial& trial) { return Trial(trial).run(); }

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
      "trial: "
      "both axes stand within {:g} s and {:g} mm of the fault.\n\n| injection | while | fault | reaction, ms | stop, "
      "ms "
      "| distance, mm |\n|---|---|---|---|---|---|\n",
      kStatedStop_s, kStatedDistance_mm);
  for (const InjectionInfo& info : injections()) {
    for (const TrialMotion motion : {TrialMotion::standing, TrialMotion::jog}) {
      if (info.kind == "motor_reversed" && motion == TrialMotion::jog) continue;  // nobody swaps leads in motion
      const TrialOutcome outcome = run_trial({.injection = &info,
                                              .axis = 0,
                                              .value = info.usual,
                                              .motion = motion,
                                              .sample = 300,
                                              .speed_mm_s = 250.0,
                                              .seed = 1});
      page += fmt::format("| {} | {} | `{}` | {:.0f} | {:.0f} | {:.1f} |\n", info.what,
                          kTrialMotions[static_cast<std::size_t>(motion)], firmware::fault_info(outcome.fault).name,
                          1e3 * outcome.reaction_s, 1e3 * outcome.stop_s, outcome.distance_mm);
    }
  }
  return page;
}

}  // namespace host
