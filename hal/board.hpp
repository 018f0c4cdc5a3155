// A whole board, as the application sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hal/axis_count.hpp"
#include "hal/axis_hal.hpp"
#include "hal/clock.hpp"
#include "hal/emergency_stop.hpp"
#include "hal/flash.hpp"
#include "hal/limit_inputs.hpp"
#include "hal/supply.hpp"
#include "hal/usb_hid.hpp"

namespace hal {

/// Contract: while an object of type ControlShutOut exists, the control interrupt does not run; the objects nest, and
/// exist for microseconds, except during a save. `set_control_rate` takes effect within a period. `begin_stall` tells
/// the watchdog that the processor may stop for as long as a sector erase; `end_stall` restores the short time-out.
/// `restart` restarts the program, and may return before it does. `axis(index)` exists for every index below `kAxes`.
/// A board that knows the modes of its pins also has `are_pins_kept()`: whether they are still those that were set.
/// A board whose program can be updated also has `image_flash()`: a Flash of three sectors, the place where programs
/// run and two slots that keep images.
template <typename T>
concept Board = requires(T& board, std::size_t index, std::uint32_t rate_Hz) {
  typename T::AxisType;
  typename T::ControlShutOut;
  requires AxisHal<typename T::AxisType>;
  requires T::kAxes >= 1 && T::kAxes <= kMostAxes;
  { board.axis(index) } -> std::same_as<typename T::AxisType&>;
  requires LimitInputs<std::remove_reference_t<decltype(board.axis(index).limits())>>;
  requires EmergencyStop<std::remove_reference_t<decltype(board.emergency_stop())>>;
  requires Supply<std::remove_reference_t<decltype(board.supply())>>;
  requires Clock<std::remove_reference_t<decltype(board.clock())>>;
  requires UsbHid<std::remove_reference_t<decltype(board.usb())>>;
  requires Flash<std::remove_reference_t<decltype(board.parameter_flash())>>;
  { board.set_control_rate(rate_Hz) } -> std::same_as<void>;
  { board.begin_stall() } -> std::same_as<void>;
  { board.end_stall() } -> std::same_as<void>;
  { board.restart() } -> std::same_as<void>;
};

}  // namespace hal
