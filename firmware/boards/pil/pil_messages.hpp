// Messages between the plant's computer and the board in processor-in-the-loop runs: 32-bit little-endian words.
#pragma once

#include <array>
#include <cstdint>

#include "hal/axis_count.hpp"

namespace firmware::boards {

enum class PilCommand : std::uint32_t {
  none = 0,
  enable = 1,
  disable = 2,  ///< slows down first
  jog = 3,      ///< operand_low: the bits of a velocity in the board's scalar
  move = 4,     ///< operand: target, encoder counts
  stop = 5,
  clear_fault = 6,
};

struct PilAxisRequest {
  std::uint32_t encoder_counts = 0;
  std::int32_t tachometer_code = 0;
  std::uint32_t tachometer_valid = 0;
  std::uint32_t lines = 0;  ///< bit 0 positive end, 1 negative end, 2 home, 3 drive fault, 4 amplifier not ready
  PilCommand command = PilCommand::none;
  std::uint32_t operand_low = 0;
  std::uint32_t operand_high = 0;
};

/// One control period's readings and commands. The last request of a run has the number kPilEnd and gets no reply.
struct PilRequest {
  std::uint32_t number = 0;
  std::uint32_t now_us = 0;
  std::uint32_t board = 0;  ///< bit 0 emergency stop, 1 supply low, 2 parameter store damaged
  std::array<PilAxisRequest, hal::kAxisCount> axis{};
};
inline constexpr std::uint32_t kPilEnd = 0xFFFFFFFF;

/// All outputs, states and reports of an axis, as bits.
struct PilAxisReply {
  std::int32_t dac_code = 0;
  std::uint32_t dac_writes = 0;
  std::uint32_t outputs = 0;  ///< bit 0 enable, 1 brake released; from bit 4 on ValueAxis::Enable::edges of this period
  std::uint32_t flags =
      0;  ///< bit 0 command refused, 1 saturated, 2 enabled, 3 at rest; bits 8 to 15 AxisFault, 16 to 18 state
  std::array<std::uint32_t, 2> encoder_counts{}, anchor_counts{}, reference_counts{}, reference_fraction{};
  std::uint32_t tachometer_velocity = 0;
  std::uint32_t offset = 0, velocity = 0, disturbance = 0;
  std::uint32_t reference_velocity = 0, position_error = 0, friction_V = 0, control_V = 0;
  std::uint32_t following_high_water = 0;
  std::uint32_t captured = 0;  ///< rows that the capture holds

  bool operator==(const PilAxisReply&) const = default;
};

struct PilReply {
  std::uint32_t number = 0;
  std::array<PilAxisReply, hal::kAxisCount> axis{};

  bool operator==(const PilReply&) const = default;
};

static_assert(sizeof(PilRequest) == 68 && sizeof(PilReply) == 180, "the same layout on both computers");

/// Answer to the parameters: one Refusal an axis.
struct PilConfigured {
  std::array<std::uint32_t, hal::kAxisCount> error{};
};

}  // namespace firmware::boards
