// Requests, replies and their payloads. Little-endian; each struct has the layout of the report from byte 8 on:
// README.md.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "firmware/app/protocol/whole_counts.hpp"
#include "hal/axis_count.hpp"

namespace firmware {

inline constexpr std::size_t kPayloadSize = 52;

/// Numbers are permanent. A reply has the request's number with the highest bit set.
enum class MessageType : std::uint8_t {
  identify = 0x01,
  status = 0x02,
  timing = 0x03,
  read_values = 0x10,
  begin_staging = 0x11,
  stage = 0x12,
  commit = 0x13,
  save = 0x14,
  read_stored = 0x15,
  begin_table = 0x16,
  table_points = 0x17,
  finish_table = 0x18,
  read_table = 0x19,
  enable = 0x20,
  disable = 0x21,
  stop = 0x22,
  jog = 0x23,
  move = 0x24,
  clear_faults = 0x25,
  heartbeat = 0x26,
  take_over = 0x27,
  home = 0x28,
  start_capture = 0x30,
  stop_capture = 0x31,
  read_fault_capture = 0x32,
  read_fault_log = 0x33,
  restart = 0x3E,
  load_excitation = 0x40,
  start_excitation = 0x41,
  stop_excitation = 0x42,
  excitation_state = 0x43,
  arm_trigger = 0x48,
  trigger_state = 0x49,
  read_triggered = 0x4A,
  open_path = 0x50,
  path_nodes = 0x51,
  start_path = 0x52,
  path_rate = 0x53,
  stop_path = 0x54,
  path_state = 0x55,
  probe_state = 0x56,
  begin_update = 0x60,
  update_block = 0x61,
  finish_update = 0x62,
  confirm_update = 0x63,
  read_slot = 0x64,
  samples = 0x70,   ///< from the board, unrequested, while a capture runs
  rejected = 0x7F,  ///< from the board: a report that could not be decoded
};

inline constexpr std::uint8_t kReplyBit = 0x80;

constexpr MessageType reply_to(MessageType request) {
  return static_cast<MessageType>(static_cast<std::uint8_t>(request) | kReplyBit);
}

/// Numbers are permanent.
enum class Status : std::uint8_t {
  ok = 0,
  unknown_request = 1,
  malformed = 2,          ///< the payload has a wrong length, or names a missing axis
  damaged = 3,            ///< checksum or length of the report
  wrong_version = 4,      ///< of the protocol
  bad_value = 5,          ///< RefusedValuePayload gives parameter and reason
  unknown_parameter = 6,  ///< RefusedValuePayload gives the parameter
  drive_enabled = 7,      ///< refused while a drive is enabled; RefusedValuePayload may say which parameter
  set_differs = 8,        ///< the staged set, table or image differs from the one to be committed
  wrong_state = 9,        ///< the axis is not in a state that allows this
  not_fitted = 10,
  flash_failed = 11,
  not_verified = 12,  ///< the saved set read back differently; the old one remains valid
  unreachable = 13,   ///< a move that cannot be planned
  device_fault = 14,  ///< a fault is latched: read the status
  no_such_row = 15,
  others_motion = 16,  ///< another client moves the axes: wait, stop them, or take over
  restarting = 17,
  outside_travel = 18,  ///< a move or a jog beyond a limit of travel, which RefusedValuePayload gives
  not_standing = 19,    ///< an axis that is to be enabled moves, or its amplifier still reports ready
  not_homed = 20,       ///< a move to a position by an axis that is not homed
  homing_mode = 21,     ///< homing.mode searches, but the request states home; or the reverse
  others_capture = 22,  ///< another client's capture runs: wait for its end, or stop it
  no_room = 23,         ///< for another node of a path: send it later
  brown_out_off = 24,   ///< no motion until the chip's brown-out reset is set
  bad_image = 25,       ///< RefusedImagePayload says why
  on_trial = 26,        ///< no motion and no update until the running image is confirmed
  no_probe = 27,        ///< a probing path, but probe.input is 0 or the board has no such input
  probe_already = 28,   ///< the contact, or loss of contact, that the path looks for exists already
};

struct IdentityPayload {
  std::uint32_t schema_hash = 0;
  std::uint16_t parameter_count = 0;
  std::uint8_t axis_count = 0;
  std::uint8_t fixed_point = 0;
  std::array<char, 16> board{};
  std::array<char, 16> version{};
  std::array<char, 12> git_hash{};  ///< its first characters; may lack the zero at the end
};
static_assert(sizeof(IdentityPayload) == kPayloadSize);

struct AxisStatus {
  std::uint32_t counts_low = 0;
  std::int32_t counts_high = 0;
  float velocity = 0;  ///< estimated, rad/s (m/s)
  std::uint8_t state = 0;
  std::uint8_t fault = 0;
  std::uint8_t flags = 0;         ///< kAxis…
  std::uint8_t second_fault = 0;  ///< a further fault while the first one brought the axis to a stop

  constexpr std::int64_t counts() const { return whole_counts(counts_low, counts_high); }
};
inline constexpr std::uint8_t kAxisFitted = 1, kAxisSaturated = 2, kAxisVelocityLimited = 4, kAxisAtRest = 8,
                              kAxisHomed = 16, kAxisHoming = 32,
                              kAxisPitch = 64,  ///< the screw's pitch error is subtracted from the reference
    kAxisScale = 128;                           ///< it has a second encoder, on the table

/// State of the whole board, from the point of view of the requesting client.
struct BoardStatus {
  std::uint32_t control_periods = 0;
  std::uint32_t store_sequence = 0;
  std::uint32_t store_erases = 0;
  std::uint16_t not_migrated = 0;
  std::uint8_t store_state = 0;
  std::uint8_t reset_cause = 0;
  std::uint8_t flags = 0;  ///< kBoard…
  std::uint8_t axis_count = 0;
  std::uint16_t resets = 0;
};

struct StatusRequest {
  std::uint8_t first_axis = 0;
};

/// The board, and as many axes as fit from `first_axis` on; the payload ends with the last axis.
inline constexpr std::size_t kAxesPerStatus = 2;
struct StatusPayload {
  BoardStatus board{};
  std::array<AxisStatus, kAxesPerStatus> axis{};
};
static_assert(sizeof(StatusPayload) == kPayloadSize);
inline constexpr std::uint8_t kBoardUnsaved = 1, kBoardStopPressed = 2, kBoardCapturing = 4, kBoardSimulated = 8,
                              kBoardYours = 16,  ///< the requesting client owns the enabled axes
    kBoardOthers = 32,                           ///< another client owns them
    kBoardLeftAlone = 64,                        ///< axes at rest were disabled after host.standing_timeout
    kBoardBrownOutOff = 128;

/// Since start-up, or since the last request to reset.
struct TimingPayload {
  std::uint32_t periods = 0;
  std::uint32_t shortest_us = 0;  ///< from one control period to the next
  std::uint32_t longest_us = 0;
  std::uint32_t busiest_us = 0;  ///< longest work of a control period
  std::uint32_t reports = 0;
  std::uint32_t rejected_reports = 0;
  std::uint32_t stack_used = 0;
  std::uint32_t stack_size = 0;
  std::uint32_t cycles_average = 0;  ///< processor clocks of the control interrupt; 0: not measured
  std::uint32_t cycles_worst = 0;
  std::uint32_t processor_Hz = 0;
  std::uint32_t friction_taken_back = 0;  ///< mask of the axes whose friction feed-forward is off by its watch, now
};

struct TimingRequest {
  std::uint8_t begin_anew = 0;
};

inline constexpr std::size_t kValuesPerReport = 8;

/// Values by key. In replies to read_values and read_stored: from place `first` on; a count below kValuesPerReport ends
/// the set.
struct ValuesPayload {
  std::uint16_t first = 0;
  std::uint8_t count = 0;
  std::uint8_t reserved = 0;
  std::array<std::uint16_t, kValuesPerReport> key{};
  std::array<std::uint32_t, kValuesPerReport> bits{};
};
static_assert(sizeof(ValuesPayload) == kPayloadSize);

enum class ValueSet : std::uint8_t { active = 0, staged = 1, initial = 2 };

struct ReadRequest {
  std::uint16_t first = 0;
  ValueSet set = ValueSet::active;  ///< read_values only
  std::uint8_t reserved = 0;
};

struct BeginRequest {
  ValueSet from = ValueSet::active;
};

/// CRC-32 over the values of all places in the table's order, four bytes each.
struct CommitRequest {
  std::uint32_t crc = 0;
};

struct RefusedValuePayload {
  std::uint16_t key = 0;
  std::uint8_t kind = 0;  ///< ValueRefusal
  std::uint8_t reserved = 0;
  std::uint32_t bits = 0;
};

/// Sent with the status of a refused `enable`, which enables none of the axes.
struct RefusedAxisPayload {
  std::uint8_t axis = 0;
  std::array<std::uint8_t, 3> reserved{};
};

struct AxesRequest {
  std::uint8_t mask = 0;  ///< bit 0: the first axis
};

struct JogRequest {
  std::uint8_t axis = 0;
  std::array<std::uint8_t, 3> reserved{};
  float velocity = 0;  ///< mm/s (m/s)
};

struct HomeRequest {
  std::uint8_t axis = 0;
  std::uint8_t here = 0;  ///< 1: the operator states that the axis is at homing.position
};

struct MoveRequest {
  std::uint8_t axis = 0;
  std::uint8_t relative = 0;  ///< 1: by this many counts from the present reference
  std::array<std::uint8_t, 2> reserved{};
  std::uint32_t counts_low = 0;
  std::int32_t counts_high = 0;

  static constexpr MoveRequest to(std::uint8_t axis, std::int64_t counts) {
    return {.axis = axis,
            .counts_low = static_cast<std::uint32_t>(counts),
            .counts_high = static_cast<std::int32_t>(counts >> 32)};
  }
  static constexpr MoveRequest by(std::uint8_t axis, std::int64_t counts) {
    MoveRequest request = to(axis, counts);
    request.relative = 1;
    return request;
  }
  constexpr std::int64_t counts() const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(static_cast<std::uint32_t>(counts_high)) << 32 |
                                     counts_low);
  }
};

/// Channels of one axis in a captured row; a word of 32 bits each. "Scalar": the bits of a float, or the raw number of
/// a fixed-point board (fixed_units.hpp).
enum class Channel : std::uint8_t {
  dac_code = 0,
  counts = 1,               ///< low word of the encoder's counts
  tachometer_velocity = 2,  ///< scalar, rad/s (m/s)
  reference = 3,            ///< 1/256 counts, low word
  reference_velocity = 4,   ///< scalar, rad/s (m/s)
  position_error = 5,       ///< scalar, mm (m): xref - x_hat
  velocity_estimate = 6,    ///< scalar, rad/s (m/s)
  disturbance = 7,          ///< scalar, V
  friction = 8,             ///< scalar, V
  control = 9,              ///< scalar, V: before limits and rounding
  flags = 10,               ///< state, then fault << 8, then saturated << 16
  table_counts = 11,        ///< low word of the counts of a second encoder, on the table; only of axes with kAxisScale
};
inline constexpr std::size_t kChannels = 11;  ///< of every axis
inline constexpr std::size_t kWordsPerReport = 12;

struct CaptureRequest {
  std::array<std::uint16_t, hal::kMostAxes> channels{};  ///< of each axis: bit n is channel n; kWordsPerReport in all
  std::uint16_t every = 1;                               ///< control periods from one row to the next, at least 1
  std::uint16_t reserved = 0;

  /// Words of a row.
  constexpr std::size_t words() const {
    std::size_t count = 0;
    for (const unsigned mask : channels)
      for (unsigned left = mask; left != 0; left &= left - 1) ++count;
    return count;
  }
};

struct CaptureReply {
  std::uint32_t rows = 0;     ///< taken since the capture was started
  std::uint32_t dropped = 0;  ///< of these, lost because the host did not fetch them in time
};

/// Rows of a capture, sent unrequested. Dropped rows are numbered too, so that gaps in the numbers show lost rows.
struct SamplesPayload {
  std::uint32_t first_row = 0;
  std::array<std::uint32_t, kWordsPerReport> word{};
};
static_assert(sizeof(SamplesPayload) == kPayloadSize);

struct FaultRowRequest {
  std::uint8_t axis = 0;
  std::uint8_t reserved = 0;
  std::uint16_t row = 0;  ///< 0 the oldest
};

/// One row that an axis kept from before its fault; scalars and words as in Channel.
struct FaultRowPayload {
  std::uint16_t rows = 0;   ///< available
  std::uint16_t every = 0;  ///< control periods from one row to the next
  std::uint32_t dac_code = 0;
  std::uint32_t counts = 0;
  std::uint32_t tachometer_velocity = 0;
  std::uint32_t reference_velocity = 0;
  std::uint32_t position_error = 0;
  std::uint32_t velocity_estimate = 0;
  std::uint32_t disturbance = 0;
  std::uint32_t index_way = 0;  ///< counts from the home switch to the next index pulse, by the last search for both
};

}  // namespace firmware
