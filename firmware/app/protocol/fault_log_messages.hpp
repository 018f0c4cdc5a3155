// The fault log in messages; entries have the same layout as in flash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "firmware/app/protocol/whole_counts.hpp"

namespace firmware {

inline constexpr std::size_t kLoggedFaults = 64;  ///< the newest ones

/// A fault of an axis or, if `reset` is not 0, an unexpected end of the program. In the latter case counts() gives the
/// processor's address, `second_fault` the exception's number, and bit n of `activity` is set if axis n was enabled.
struct LoggedFault {
  std::uint32_t number = 0;      ///< consecutive number of the fault since the log began, from 1
  std::uint32_t run_s = 0;       ///< total running time of the board
  std::uint32_t counts_low = 0;  ///< of a reset: the processor's address; 0: not known
  std::int32_t counts_high = 0;  ///< of a reset: the processor's fault status, CFSR
  float velocity = 0;            ///< estimated, rad/s (m/s)
  std::int16_t dac_code = 0;
  std::uint8_t axis = 0;
  std::uint8_t fault = 0;
  std::uint8_t second_fault = 0;
  std::uint8_t activity = 0;  ///< AxisActivity
  std::uint8_t homed = 0;     ///< 1: the counts are from home
  std::uint8_t reset = 0;     ///< boards::ResetCause of the start that wrote this

  constexpr bool is_event() const { return fault != 0 || reset != 0; }  ///< otherwise it gives only the time
  constexpr std::int64_t counts() const { return whole_counts(counts_low, counts_high); }
  bool operator==(const LoggedFault&) const = default;
};
static_assert(sizeof(LoggedFault) == 28 && std::is_trivially_copyable_v<LoggedFault>);

struct FaultLogRequest {
  std::uint8_t age = 0;  ///< 0 is the newest
};

struct FaultLogPayload {
  std::uint32_t run_s = 0;  ///< total running time of the board until now
  LoggedFault entry{};
};

}  // namespace firmware
