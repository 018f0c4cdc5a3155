// Payloads of the requests for a capture in the board's memory. Little-endian, in the layout of the report: README.md.
#pragma once

#include "firmware/app/protocol/messages.hpp"

namespace firmware {

/// Numbers are permanent.
enum class TriggerKind : std::uint8_t {
  none = 0,    ///< at once
  level = 1,   ///< the channel is beyond the level
  edge = 2,    ///< the channel passes the level
  fault = 3,   ///< the axis gets a fault
  motion = 4,  ///< the reference begins to move
};
inline constexpr std::size_t kTriggerKinds = 5;

enum class TriggerPhase : std::uint8_t {
  idle = 0,
  waiting = 1,
  recording = 2,  ///< after the trigger; the rows after it are recorded
  complete = 3,
};

/// Has no initial values, so that it may lie in memory that start-up does not initialise.
struct TriggerRequest {
  std::array<std::uint16_t, hal::kMostAxes> channels;  ///< of each axis: bit n is channel n; kWordsPerReport in all
  std::array<std::uint16_t, hal::kMostAxes> wide;      ///< channels that are kept with 32 bits instead of 16
  std::uint16_t every;                                 ///< control periods from row to row
  std::uint8_t kind;                                   ///< TriggerKind
  std::uint8_t axis;                                   ///< axis of the trigger; kAnyAxis for a fault of any axis
  std::uint8_t channel;                                ///< Channel
  std::uint8_t falling;                                ///< 1: below the level
  std::uint16_t reserved;
  std::uint32_t level;    ///< as a word of the channel
  std::uint32_t before;   ///< rows to keep from before the trigger
  std::uint32_t after;    ///< rows from the trigger on; 0 ends an armed capture
  std::uint32_t holdoff;  ///< control periods during which no trigger counts
};
inline constexpr std::uint8_t kAnyAxis = 0xFF;

struct TriggerStatePayload {
  std::uint8_t phase = 0;       ///< TriggerPhase
  std::uint8_t half_words = 0;  ///< of a row
  std::uint8_t survived = 0;    ///< 1: the capture is from before the last reset
  std::uint8_t reserved = 0;
  std::uint32_t rows = 0;         ///< available, the oldest first
  std::uint32_t trigger_row = 0;  ///< among them
  std::uint32_t capacity = 0;     ///< half words that the board holds
  std::array<std::uint16_t, hal::kMostAxes> channels{};
  std::array<std::uint16_t, hal::kMostAxes> wide{};
  std::uint16_t every = 1;
  std::uint8_t kind = 0;
  std::uint8_t axis = 0;
  std::uint32_t counts_low = 0;  ///< of that axis's encoder at the trigger; of the first axis if any may trigger
  std::int32_t counts_high = 0;
};
static_assert(sizeof(TriggerStatePayload) <= kPayloadSize);

inline constexpr std::size_t kHalfWordsPerReport = 24;
struct ReadTriggeredRequest {
  std::uint32_t first = 0;  ///< half word, counted from the oldest row's first
};
struct TriggeredPayload {
  std::uint32_t first = 0;
  std::array<std::uint16_t, kHalfWordsPerReport> half_word{};
};
static_assert(sizeof(TriggeredPayload) == kPayloadSize);

}  // namespace firmware
