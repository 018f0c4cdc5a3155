// Payloads of the requests that excite an axis. Little-endian, in the layout of the report: README.md.
#pragma once

#include "firmware/app/protocol/messages.hpp"

namespace firmware {

/// Levels or lines, sent before the request that starts the excitation.
inline constexpr std::size_t kEntriesPerReport = 4;
struct ExcitationEntriesRequest {
  std::uint8_t axis = 0;
  std::uint8_t input = 0;  ///< ExcitationInput
  std::uint8_t first = 0;
  std::uint8_t count = 0;  ///< up to kEntriesPerReport
  struct Entry {
    float value = 0;           ///< in the input's unit: ExcitationRequest
    std::uint32_t first = 0;   ///< samples; 2^-32 turns a sample
    std::uint32_t second = 0;  ///< phase, 2^-32 turns
  };
  std::array<Entry, kEntriesPerReport> entry{};
};
static_assert(sizeof(ExcitationEntriesRequest) == kPayloadSize);

/// Values are in steps of the D/A converter (open loop, controller's output), counts (reference) or counts a sample
/// (jog), so that the board need not know physical units.
struct ExcitationRequest {
  std::uint8_t axis = 0;
  std::uint8_t kind = 0;   ///< ExcitationKind
  std::uint8_t input = 0;  ///< ExcitationInput
  std::uint8_t count = 0;  ///< number of loaded entries
  std::int32_t travel_counts = 0;
  std::int32_t margin_counts = 0;
  float speed = 0;           ///< counts a sample
  float drive_velocity = 0;  ///< the same speed, rad/s (m/s); 0: not known; negative: no tachometer
  float volts = 0;           ///< steps of the converter
  std::uint32_t samples = 0;
  float amplitude = 0;
  float ride = 0;  ///< counts a sample
  std::uint32_t period = 1;
  std::uint32_t step = 0, last_step = 0;  ///< 2^-32 turns a sample
  std::uint32_t fade_samples = 1;
};
static_assert(sizeof(ExcitationRequest) == kPayloadSize);

struct ExcitationStatePayload {
  std::uint8_t phase = 0;  ///< ExcitationPhase
  std::uint8_t end = 0;    ///< ExcitationEnd
  std::uint8_t axis = 0;
  std::uint8_t reserved = 0;
  std::uint32_t elapsed = 0;  ///< samples
  std::int32_t farthest = 0;  ///< counts from where it began
  float fastest = 0;          ///< counts a sample
};

}  // namespace firmware
