// Faults that stop an axis. Numbers are permanent and never reused.
#pragma once

#include <cstdint>

namespace firmware {

/// Causes and remedies: supervision/fault_table.hpp.
enum class AxisFault : std::uint8_t {
  none = 0,
  encoder_invalid = 1,
  tachometer_invalid = 2,
  control_signal_not_a_number = 3,
  dac_write_failed = 4,
  parameters_missing = 5,  ///< enable was requested before parameters were accepted
  following_error = 6,
  encoder_tachometer_disagreement = 7,
  encoder_jump = 8,
  feedback_polarity = 9,
  overspeed = 10,
  travel_limit = 11,
  limit_switch_positive = 12,
  limit_switch_negative = 13,
  saturation_too_long = 14,
  drive_fault = 15,
  emergency_stop = 16,
  state_not_a_number = 17,
  control_overrun = 18,
  host_heartbeat_lost = 19,
  parameter_store_damaged = 20,
  supply_low = 21,
  reference_out_of_limits = 22,
  other_axis_stopped = 23,
  command_without_motion = 24,
  limit_cycle = 25,
  converter_not_as_set = 26,
  homing_switch_not_found = 27,
  homing_index_not_found = 28,
  homing_travel_exceeded = 29,
  amplifier_not_ready = 30,
  index_mismatch = 31,
  moved_while_starting = 32,
  homing_index_near_switch = 33,
  drive_not_off = 34,
  settings_changed = 35,
  // 36 is reserved: motor and scale disagree, for a board with a second encoder on the table.
};

}  // namespace firmware
