// Two simulated drives on the simulated board, controlled by the firmware's axes, sample by sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "hal/axis_count.hpp"
#include "hal/pc/faulty_axis.hpp"
#include "hal/pc/simulated_panel.hpp"
#include "sim/plant.hpp"

namespace host {

using MachineGroup = firmware::AxisGroup<float, hal::pc::FaultyAxis, hal::kAxisCount>;

/// One axis of a machine: the true drive and the parameters of its controller.
struct MachineAxis {
  sim::DriveDescription drive;
  firmware::AxisParameters<float> parameters;
  hal::pc::AxisWiring wiring{};
  std::shared_ptr<sim::ForeignMotion> motion{};  ///< external plant that replaces the drive's effects, if set
};

/// Faults of the board itself.
struct BoardDefects {
  bool emergency_stop = false;  ///< the stop circuit is open, which also removes the enable lines in hardware
  bool power_lost = false;      ///< amplifiers without power; the board's supply falls below its threshold
  bool store_damaged = false;
  bool host_silent = false;  ///< no more heartbeat
  /// The interpolator adds this acceleration to its path permanently; mm/s^2.
  std::array<double, hal::kAxisCount> runaway_mm_s2{};
};

/// Deterministic: equal arguments and calls give bit-identical results. Not copyable, because the axes refer to their
/// hardware.
class Machine {
 public:
  /// `seed` fixes the noise of all sensors. Throws Failure(bad_input) naming the axis whose parameters are refused.
  Machine(const std::array<MachineAxis, hal::kAxisCount>& axes, std::uint64_t seed);
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// Runs one control period, and the machine until the next one.
  void step();
  void step_with(const std::array<firmware::Increment, hal::kAxisCount>& increments);

  /// Skips the control interrupt for this many periods; the machine continues with the last D/A codes.
  void lose_periods(int periods);

  /// Runs the self-test, then enables both axes. Throws Failure(device_fault) if an axis does not become enabled.
  void enable();

  MachineGroup& axes() { return axes_; }
  const MachineGroup& axes() const { return axes_; }
  hal::pc::FaultyAxis& wires(std::size_t axis) { return *wires_[axis]; }
  hal::pc::FaultyAxis const& wires(std::size_t axis) const { return *wires_[axis]; }
  const sim::Plant& plant(std::size_t axis) const { return *plants_[axis]; }
  double sample_period_s() const { return period_s_; }
  /// Samples since the machine was created.
  std::uint64_t samples() const { return samples_; }

  BoardDefects defects;

 private:
  firmware::BoardInputs inputs();
  std::array<firmware::Increment, hal::kAxisCount> runaway();
  void run_plants();

  double period_s_;
  std::array<std::unique_ptr<sim::Plant>, hal::kAxisCount> plants_;
  std::array<std::unique_ptr<hal::pc::FaultyAxis>, hal::kAxisCount> wires_;
  MachineGroup axes_;
  hal::pc::SimulatedClock clock_;
  std::array<double, hal::kAxisCount> runaway_mm_s_{};
  std::uint64_t samples_ = 0;
};

/// "x" and "y": names of the axes in messages, records and scenario files.
inline constexpr auto kAxisNames = [] {
  std::array<std::string_view, hal::kAxisCount> names;
  std::copy_n(firmware::kAxisNames.begin(), names.size(), names.begin());
  return names;
}();

}  // namespace host
