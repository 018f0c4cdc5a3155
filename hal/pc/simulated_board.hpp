// A board with simulated drives plugged in: the board's side of all connectors.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "hal/board.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "hal/pc/simulated_flash.hpp"
#include "hal/pc/simulated_panel.hpp"
#include "hal/pc/simulated_usb.hpp"

namespace hal::pc {

/// Only advance() lets time pass; it calls nothing of the board's program.
template <std::size_t axes>
class SimulatedBoardOf {
 public:
  static constexpr std::size_t kAxes = axes;
  using AxisType = SimulatedAxis;
  using Drives = std::array<sim::DriveDescription, axes>;
  using Wiring = std::array<AxisWiring, axes>;
  struct ControlShutOut {
    // Program and control period alternate in one thread.
    ControlShutOut() {}  // NOLINT(modernize-use-equals-default): a guard that does nothing would be an unused variable
  };

  /// Queues as many reports as TinyUSB's port. Has four sectors like the F405, but only as large as a parameter set can
  /// need. The noise of axis n has the seed `seed` + n.
  SimulatedBoardOf(const Drives& drives, std::uint64_t seed, const Wiring& wiring = {})
      : plants_(make_plants(drives, seed, std::make_index_sequence<axes>())),
        axes_(make_axes(wiring, std::make_index_sequence<axes>())) {}
  SimulatedBoardOf(const SimulatedBoardOf&) = delete;
  SimulatedBoardOf& operator=(const SimulatedBoardOf&) = delete;

  SimulatedAxis& axis(std::size_t index) { return axes_[index]; }
  SimulatedEmergencyStop& emergency_stop() { return stop_; }
  SimulatedRelay& power_relay() { return power_relay_; }
  SimulatedSupply& supply() { return supply_; }
  SimulatedProbe& probe() { return probe_; }
  SimulatedClock& clock() { return clock_; }
  SimulatedUsb& usb() { return usb_; }
  SimulatedFlash& parameter_flash() { return flash_; }
  /// The place where programs run and two slots, as large as the F405's.
  SimulatedFlash& image_flash() { return image_flash_; }

  void set_control_rate(std::uint32_t rate_Hz) { control_period_us_ = 1'000'000 / rate_Hz; }
  void begin_stall() {}
  void end_stall() {}
  void restart() { wants_restart_ = true; }

  // Functions for the simulated environment.
  std::uint32_t control_period_us() const { return control_period_us_; }
  bool wants_restart() const { return wants_restart_; }
  sim::Plant& plant(std::size_t index) { return plants_[index]; }

  /// The walls that the probe can touch.
  void put_surfaces(std::vector<SimulatedSurface> surfaces) { surfaces_ = std::move(surfaces); }
  /// The probe's contact closes or opens now.
  void touch(bool closed) {
    if (probe_.turn(closed))
      for (std::size_t i = 0; i < axes; ++i) axes_[i].encoder().latch(plants_[i].encoder_counts());
  }

  /// Advances the environment by one control period.
  void advance() {
    for (sim::Plant& plant : plants_)
      if (!power_relay_.is_closed()) plant.set_enabled(false);
    const double period_s = 1e-6 * control_period_us_;
    if (surfaces_.empty()) {
      for (sim::Plant& plant : plants_) plant.advance(period_s);
    } else {
      const int parts = static_cast<int>((control_period_us_ + 249) / 250);
      for (int part = 0; part < parts; ++part) advance_probe(period_s / parts);
    }
    clock_.advance_us(control_period_us_);
  }

 private:
  /// The probe's edge occurs where the motion meets the surface; the motion is taken as a straight line within this
  /// short time.
  void advance_probe(double duration_s) {
    std::array<double, axes> from{}, scale_from{};
    for (std::size_t i = 0; i < axes; ++i) {
      from[i] = plants_[i].table_travel();
      scale_from[i] = plants_[i].encoder_travel();
      plants_[i].advance(duration_s);
    }
    bool touches = false;
    double first = 1.0, last = 0.0;  // times of the edges, as shares of `duration_s`
    for (const SimulatedSurface& one : surfaces_) {
      const double to = plants_[one.axis].table_travel();
      touches = touches || one.touches(to);
      if (one.touches(to) == one.touches(from[one.axis])) continue;
      const double share = (one.travel - from[one.axis]) / (to - from[one.axis]);
      first = std::min(first, share);
      last = std::max(last, share);
    }
    if (!probe_.turn(touches)) return;
    const double share = touches ? first : last;
    for (std::size_t i = 0; i < axes; ++i) {
      const double way = plants_[i].encoder_travel() - scale_from[i];
      axes_[i].encoder().latch(plants_[i].counts_at(scale_from[i] + share * way));
    }
  }

  template <std::size_t... index>
  static std::array<sim::Plant, axes> make_plants(const Drives& drives, std::uint64_t seed,
                                                  std::index_sequence<index...>) {
    return {sim::Plant(drives[index], seed + index)...};
  }
  template <std::size_t... index>
  std::array<SimulatedAxis, axes> make_axes(const Wiring& wiring, std::index_sequence<index...>) {
    return {SimulatedAxis(plants_[index], wiring[index])...};
  }

  std::array<sim::Plant, axes> plants_;
  std::array<SimulatedAxis, axes> axes_;
  SimulatedEmergencyStop stop_;
  SimulatedRelay power_relay_;
  SimulatedSupply supply_;
  SimulatedProbe probe_;
  std::vector<SimulatedSurface> surfaces_;
  SimulatedClock clock_;
  SimulatedUsb usb_{16};
  SimulatedFlash flash_{4, 16384, 4};  // two full tables of pitch errors fit
  SimulatedFlash image_flash_{3, 112 * 1024, 4};
  std::uint32_t control_period_us_ = 1000;
  bool wants_restart_ = false;
};

using SimulatedBoard = SimulatedBoardOf<kAxisCount>;
static_assert(Board<SimulatedBoard>);

}  // namespace hal::pc
