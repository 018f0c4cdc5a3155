// Data that survive a reset: why the last run ended, and the last state of the axes. In RAM that start-up does not
// initialise.
#pragma once

#include <array>
#include <cstdint>

#include "hal/axis_count.hpp"

namespace firmware::boards {

enum class ResetCause : std::uint32_t {
  unknown = 0,
  power_on = 1,
  reset_pin = 2,
  software = 3,
  watchdog = 4,
  fault = 5,
  brown_out = 6,
};

/// Processor exceptions that end a run, by their exception number (ARMv7-M ARM, table B1-4).
enum class FaultKind : std::uint32_t {
  none = 0,
  nmi = 2,
  hard_fault = 3,
  mem_manage = 4,
  bus_fault = 5,
  usage_fault = 6
};

/// State of one axis after the last finished control period.
struct LastAxisState {
  std::int64_t encoder_counts = 0;
  std::int32_t dac_code = 0;
  std::uint32_t enabled = 0;
  std::uint32_t fault = 0;  ///< AxisFault
  std::uint32_t reserved = 0;
};

struct LastState {
  std::uint32_t control_periods = 0;
  std::uint32_t supervisor_rounds = 0;
  std::array<LastAxisState, hal::kAxisCount> axis{};
};

struct FaultRecord {
  FaultKind kind = FaultKind::none;
  std::uint32_t unexpected_interrupt = 0;  ///< exception number of an interrupt that has no handler
  std::array<std::uint32_t, 13> r{};       ///< r0 to r12
  std::uint32_t sp = 0, lr = 0, pc = 0, xpsr = 0;
  std::uint32_t frame_valid = 0;     ///< 0: r0-r3, r12, lr, pc, xpsr did not fit the stack and are 0
  std::uint32_t stack_overflow = 0;  ///< the stack had overflowed, by a push or by an interrupt's frame
  std::uint32_t exc_return = 0;
  std::uint32_t cfsr = 0, hfsr = 0, mmfar = 0, bfar = 0;
  std::uint32_t outputs_made_safe = 0;  ///< D/A at 0 V and enables off before this record was written
  LastState last{};
};

struct SurvivalRecord {
  std::uint32_t magic = 0;
  std::uint32_t resets = 0;          ///< since power-on
  std::uint32_t ended_by_fault = 0;  ///< `fault` belongs to the run before this one
  std::uint32_t fault_crc = 0;
  FaultRecord fault{};
  LastState running{};  ///< kept up to date by the control interrupt
  std::uint32_t watchdog_armed = 0;
  std::uint32_t reset_requested = 0;  ///< software requested the reset that follows
};

/// The record in RAM; written by the fault handler and the control interrupt.
SurvivalRecord& survival_record();

/// How the previous run ended, as found at start-up.
struct LastRun {
  ResetCause cause = ResetCause::unknown;
  bool survived = false;  ///< the record was there: RAM kept its contents
  std::uint32_t resets = 0;
  FaultRecord fault{};  ///< kind none unless cause is fault
  LastState last{};
};

/// Reads the record and starts a new one. `hardware_cause`: from the chip's reset flags; unknown if it has none.
LastRun take_over_survival_record(ResetCause hardware_cause);

}  // namespace firmware::boards
