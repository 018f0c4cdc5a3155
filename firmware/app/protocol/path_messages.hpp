// Payloads of the requests for a path. Little-endian, in the layout of the report: README.md.
#pragma once

#include "firmware/app/protocol/messages.hpp"
#include "firmware/core/path/path_node.hpp"
#include "firmware/core/path/probe_watch.hpp"

namespace firmware {

/// Format of a node's first word: 0 duration alone, 1 duration and headroom. Host and board each state their format, so
/// that neither misreads the other's nodes.
inline constexpr std::uint8_t kPathNodeFormat = 1;

struct OpenPathRequest {
  std::uint8_t mask = 0;      ///< axes, bit 0 is x
  std::uint8_t relative = 0;  ///< 1: axes need not be homed
  PathUnits units{};
  std::uint8_t node_format = kPathNodeFormat;  ///< other formats are refused: Status::wrong_version
  ProbeStop probe = ProbeStop::none;
  std::uint8_t reserved = 0;
};
static_assert(sizeof(OpenPathRequest) == 8);

/// The present references, from which the first node is counted.
struct OpenPathPayload {
  struct Position {
    std::uint32_t counts_low = 0;
    std::int32_t counts_high = 0;
    std::uint32_t fraction = 0;  ///< 2^-32 counts
  };
  std::array<Position, hal::kMostAxes> axis{};
  std::uint16_t room = 0;  ///< nodes that the board holds
  std::uint8_t node_format = kPathNodeFormat;
  std::uint8_t reserved = 0;
};
static_assert(sizeof(OpenPathPayload) == kPayloadSize);

/// One or more nodes: a word with duration and headroom (PathNode::set_time), then travel, velocity and acceleration of
/// each axis of the mask.
inline constexpr std::uint32_t kLastNode = 1u << 31;  ///< in the word with the duration: the last node
constexpr std::size_t path_node_size(std::size_t axes) { return 4 + 12 * axes; }
static_assert(path_node_size(hal::kMostAxes) <= kPayloadSize);

struct PathRateRequest {
  std::uint16_t permille = 1000;  ///< of the planned speed, up to 1000
  std::uint8_t held = 0;          ///< 1: feed hold
  std::uint8_t reserved = 0;
};

inline constexpr std::uint8_t kHeldForProcess = 2;  ///< by the axis's limit feedback.hold_effort

struct PathStatePayload {
  std::uint8_t phase = 0;  ///< PathPhase
  std::uint8_t end = 0;    ///< PathEnd
  std::uint8_t mask = 0;
  std::uint8_t held = 0;      ///< 0 no, 1 by request, 2 kHeldForProcess
  std::uint32_t elapsed = 0;  ///< samples of the path
  std::uint32_t ahead = 0;    ///< samples of the path still to come
  std::uint32_t passed_nodes = 0;
  std::uint16_t room = 0;      ///< nodes that fit
  std::uint16_t permille = 0;  ///< present rate of the clock
};
static_assert(sizeof(PathStatePayload) == 20);

inline constexpr unsigned kProbeWired = 1;    ///< probe.input is set, and the board has the input
inline constexpr unsigned kProbeTouches = 2;  ///< now
inline constexpr unsigned kProbeMet =
    4;  ///< the last motion found the edge that it looked for, or an unexpected contact
inline constexpr unsigned kProbeLatched = 8;  ///< the position of that edge is exact

struct ProbeStatePayload {
  struct Position {
    std::uint32_t counts_low = 0;
    std::int32_t counts_high = 0;
  };
  std::uint8_t flags = 0;  ///< kProbe…
  std::array<std::uint8_t, 3> reserved{};
  std::array<Position, hal::kMostAxes> axis{};  ///< position of the edge
};
static_assert(sizeof(ProbeStatePayload) == 36);

}  // namespace firmware
