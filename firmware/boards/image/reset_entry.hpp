// The end of the last run, as an entry of the fault log.
#pragma once

#include <optional>

#include "firmware/app/protocol/fault_log_messages.hpp"
#include "firmware/boards/image/survival_record.hpp"

namespace firmware::boards {

/// Limits wear of the flash by a program that fails repeatedly at its start.
inline constexpr std::uint32_t kMostLoggedResets = 16;  ///< since power-on

/// Entry for a run that ended by a processor fault, a watchdog or its supply.
inline std::optional<LoggedFault> entry_of(const LastRun& last_run) {
  const bool is_bad = last_run.cause == ResetCause::fault || last_run.cause == ResetCause::watchdog ||
                      last_run.cause == ResetCause::brown_out;
  if (!is_bad || last_run.resets > kMostLoggedResets) return std::nullopt;
  LoggedFault entry;
  entry.reset = static_cast<std::uint8_t>(last_run.cause);
  const bool is_fault = last_run.cause == ResetCause::fault;
  if (is_fault) {
    entry.counts_low = last_run.fault.pc;
    entry.counts_high = static_cast<std::int32_t>(last_run.fault.cfsr);
    entry.second_fault = static_cast<std::uint8_t>(last_run.fault.kind);
  }
  const LastState& last = is_fault ? last_run.fault.last : last_run.last;
  for (std::size_t axis = 0; axis < last.axis.size(); ++axis)
    if (last.axis[axis].enabled != 0) entry.activity = static_cast<std::uint8_t>(entry.activity | 1u << axis);
  return entry;
}

}  // namespace firmware::boards
