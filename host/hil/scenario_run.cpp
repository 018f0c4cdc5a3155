#include "host/hil/scenario_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "host/exit_codes.hpp"
#include "host/external_plant/external_plant.hpp"
#include "host/hil/commissioning.hpp"
#include "host/hil/expectation_check.hpp"
#include "host/hil/recorder.hpp"
#include "host/known_by_current.hpp"
#include "host/visible_text.hpp"

namespace host {

namespace {

sim::DriveDescription believed_of(const ScenarioAxis& axis, std::uint64_t seed) {
  switch (axis.knowledge) {
    case Knowledge::truth:
      return axis.drive;
    case Knowledge::identified:
      return commission(axis.drive, seed);
    case Knowledge::model:
      break;
  }
  return axis.believed;
}

MachineAxis machine_axis(const ScenarioAxis& axis, const sim::DriveDescription& believed) {
  auto parameters = contouring_parameters(believed,
                                          {.friction = axis.friction_feedforward,
                                           .cancellation = axis.disturbance_cancellation,
                                           .effects = axis.compensation},
                                          axis.limits, axis.tuning);
  parameters.zero_phase_feedforward_on = axis.zero_phase;
  parameters.encoder_fault_input = axis.encoder_fault_input;
  return {axis.drive, parameters, axis.wiring};
}

/// Starts the programs that replace drives; axes with the same program share one process.
void start_programs(const Scenario& scenario, std::array<MachineAxis, hal::kAxisCount>& axes) {
  constexpr std::chrono::seconds kPatience{10};
  std::map<std::string, std::vector<std::size_t>> served;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (!scenario.axes[i].program.empty()) served[scenario.axes[i].program].push_back(i);
  if (!served.empty() && !scenario.programs_allowed)
    throw Failure(ExitCode::refused, fmt::format("{}: it runs the program '{}' without consent: read it, then allow it",
                                                 scenario.path, visible_text(served.begin()->first)));
  for (const auto& [command, places] : served) {
    const double period_s = axes[places.front()].drive.data.sample_period_s;
    const auto plant = std::make_shared<ExternalPlant>(command, places.size(), period_s, kPatience);
    for (std::size_t k = 0; k < places.size(); ++k) axes[places[k]].motion = ExternalPlant::axis(plant, k);
  }
}

class ScenarioDriver {
 public:
  ScenarioDriver(const Scenario& scenario, const std::array<MachineAxis, hal::kAxisCount>& axes)
      : scenario_(scenario),
        machine_(axes, scenario.seed),
        recorder_(machine_),
        period_s_(machine_.sample_period_s()),
        table_(scenario.table) {
    if (scenario.ballbar) ballbar_.emplace(*scenario.ballbar, scenario.table.centre_mm, scenario.seed);
    machine_.enable();
  }

  void run() {
    const auto samples = static_cast<std::uint64_t>(std::lround(scenario_.duration_s / period_s_));
    for (std::uint64_t k = 0; k < samples; ++k) {
      inject_at(k);
      move_at(k);
      step();
      observe(k);
    }
  }

  ScenarioRun result() const {
    ScenarioRun run;
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      run.records[i] = recorder_.record(i);
      run.tracking_um[i] = recorder_.tracking_error_um(i);
      if (i == 0 && ballbar_) run.records[i].extra.push_back({"radius_mm", radius_mm_, {}});
      run.high_water_um[i] = 1e3 * static_cast<double>(machine_.axes()[i].monitors().high_water());
    }
    run.table_um = table_um_;
    run.disturbance_V = disturbance_V_;
    run.contour_um = contour_um_;
    run.path_points = path_points_;
    run.stops = stops_;
    run.simulated_s = scenario_.duration_s;
    return run;
  }

 private:
  bool is_now(double at_s, std::uint64_t k) const {
    return static_cast<std::uint64_t>(std::lround(at_s / period_s_)) == k;
  }

  void inject_at(std::uint64_t k) {
    for (const ScenarioFault& fault : scenario_.faults) {
      if (is_now(fault.at_s, k)) {
        fault.injection->apply(machine_, fault.axis, fault.value);
        injected_at_ = k;
      }
      if (fault.until_s && is_now(*fault.until_s, k)) fault.injection->heal(machine_, fault.axis);
    }
  }

  void move_at(std::uint64_t k) {
    for (const ScenarioMove& move : scenario_.moves)
      if (is_now(move.at_s, k)) start(move, k);
  }

  void start(const ScenarioMove& move, std::uint64_t k) {
    auto& axis = machine_.axes()[move.axis];
    bool accepted = true;
    switch (move.kind) {
      case MoveKind::jog:
        accepted = axis.jog(static_cast<float>(move.speed_mm_s));
        break;
      case MoveKind::move_to: {
        const double count_mm = scenario_.axes[move.axis].drive.data.encoder_resolution;
        const auto planned = axis.plan_move_to(firmware::CountPosition::at(std::llround(move.target_mm / count_mm)));
        accepted = planned.refusal == firmware::Refusal::none && axis.start(planned.plan);
        break;
      }
      case MoveKind::stop:
        axis.stop();
        break;
      case MoveKind::circle:
      case MoveKind::square:
        begin_path(move);
        break;
      case MoveKind::enable:
        accepted = axis.enable();
        break;
      case MoveKind::disable:
        accepted = axis.disable();
        break;
      case MoveKind::clear:
        accepted = axis.clear_fault();
        break;
    }
    if (accepted) return;
    throw Failure(
        ExitCode::refused,
        fmt::format("{}: the move at {:g} s is refused: axis {} is {} and {}; give it time, or clear its fault "
                    "and enable it first",
                    scenario_.path, static_cast<double>(k) * period_s_, kAxisNames[move.axis],
                    firmware::state_name(axis.state()), axis.is_at_rest() ? "at rest" : "moving"));
  }

  void begin_path(const ScenarioMove& move) {
    path_ = &*move.path;
    path_points_.clear();
    path_increments_ =
        follow_path(*path_, move.path_limits, period_s_,
                    {scenario_.axes[0].drive.data.encoder_resolution, scenario_.axes[1].drive.data.encoder_resolution});
    path_place_ = 0;
    for (std::size_t i = 0; i < hal::kAxisCount; ++i)
      path_origin_mm_[i] = firmware::counts_from<double>(0, machine_.axes()[i].telemetry().reference) *
                           scenario_.axes[i].drive.data.encoder_resolution;
  }

  bool is_on_path() const { return path_place_ < path_increments_.size(); }

  void step() {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) table_mm_[i] = machine_.plant(i).table_travel();
    if (is_on_path())
      machine_.step_with(path_increments_[path_place_++]);
    else
      machine_.step();
  }

  void observe(std::uint64_t k) {
    recorder_.take();
    if (ballbar_) radius_mm_.push_back(ballbar_->read(table_.moved_to(table_mm_, period_s_)));
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      const auto& axis = machine_.axes()[i];
      const double wanted_mm =
          firmware::counts_from<double>(0, axis.table_reference()) * scenario_.axes[i].drive.data.encoder_resolution;
      table_um_[i].push_back(1e3 * (wanted_mm - table_mm_[i]));
      disturbance_V_[i].push_back(static_cast<double>(axis.telemetry().estimate.disturbance));
      if (axis.fault() != last_fault_[i]) {
        last_fault_[i] = axis.fault();
        if (axis.fault() != firmware::AxisFault::none) begin_stop(i, k);
      }
      watch_stop(i, k);
    }
    if (path_ == nullptr && contour_um_.empty()) return;
    contour_um_.resize(k, 0.0);
    contour_um_.push_back(is_on_path() ? contour_error_um() : 0.0);
  }

  double contour_error_um() {
    std::array<double, hal::kAxisCount> mm{};
    for (std::size_t i = 0; i < hal::kAxisCount; ++i)
      mm[i] = recorder_.record(i).x.back() + scenario_.axes[i].drive.data.encoder_resolution / 2.0 - path_origin_mm_[i];
    path_points_.push_back({mm[0], mm[1]});
    return 1e3 * path_->distance_to(path_points_.back());
  }

  void begin_stop(std::size_t axis, std::uint64_t k) {
    StopEvent stop;
    stop.axis = axis;
    stop.fault = last_fault_[axis];
    stop.at_s = static_cast<double>(k) * period_s_;
    if (injected_at_) stop.reaction_s = static_cast<double>(k - *injected_at_) * period_s_;
    stopping_[axis] = stops_.size();
    stop_begin_mm_[axis] = machine_.plant(axis).truth().x;
    stops_.push_back(stop);
  }

  void watch_stop(std::size_t axis, std::uint64_t k) {
    if (!stopping_[axis]) return;
    StopEvent& stop = stops_[*stopping_[axis]];
    const auto& truth = machine_.plant(axis).truth();
    stop.distance_mm = std::max(stop.distance_mm, std::abs(truth.x - stop_begin_mm_[axis]));
    constexpr double kStanding_rad_s = 0.01;
    if (machine_.wires(axis).drive_enable().is_on() || std::abs(truth.w) > kStanding_rad_s) return;
    stop.standing_s = static_cast<double>(k) * period_s_ - stop.at_s;
    stopping_[axis].reset();
  }

  const Scenario& scenario_;
  Machine machine_;
  Recorder recorder_;
  double period_s_;
  sim::CrossedTable table_;
  std::optional<sim::Ballbar> ballbar_;
  std::vector<double> radius_mm_;  ///< by the ballbar
  const Path* path_ = nullptr;
  std::vector<std::array<firmware::Increment, hal::kAxisCount>> path_increments_;
  std::size_t path_place_ = 0;
  std::array<double, hal::kAxisCount> path_origin_mm_{};
  std::array<double, hal::kAxisCount> table_mm_{};  ///< at the beginning of the control period
  std::array<std::vector<double>, hal::kAxisCount> table_um_;
  std::array<std::vector<double>, hal::kAxisCount> disturbance_V_;
  std::vector<double> contour_um_;
  std::vector<PlanePoint> path_points_;
  std::optional<std::uint64_t> injected_at_;
  std::array<firmware::AxisFault, hal::kAxisCount> last_fault_{};
  std::array<std::optional<std::size_t>, hal::kAxisCount> stopping_;
  std::array<double, hal::kAxisCount> stop_begin_mm_{};
  std::vector<StopEvent> stops_;
};

}  // namespace

std::uint64_t commissioning_seed(const Scenario& scenario, std::size_t axis) { return 100 * scenario.seed + 10 * axis; }

bool ScenarioRun::holds() const {
  return std::ranges::all_of(expectations, [](const CheckedExpectation& one) { return one.holds || one.aim; });
}

bool ScenarioRun::misses_aim() const {
  return std::ranges::any_of(expectations, [](const CheckedExpectation& one) { return one.aim && !one.holds; });
}

ScenarioRun run_scenario(const Scenario& scenario) {
  for (const ScenarioAxis& axis : scenario.axes) require_volts(axis.drive.data, axis.drive.name, "a scenario");
  std::array<sim::DriveDescription, hal::kAxisCount> believed;
  std::array<MachineAxis, hal::kAxisCount> axes;
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    believed[i] = believed_of(scenario.axes[i], commissioning_seed(scenario, i));
    axes[i] = machine_axis(scenario.axes[i], believed[i]);
  }
  start_programs(scenario, axes);
  ScenarioDriver driver(scenario, axes);
  const auto start = std::chrono::steady_clock::now();
  driver.run();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ScenarioRun run = driver.result();
  run.believed = std::move(believed);
  run.wall_s = took.count();
  for (const Expectation& expected : scenario.expectations)
    run.expectations.push_back(check_expectation(expected, run));
  return run;
}

}  // namespace host
