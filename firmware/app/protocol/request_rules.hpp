// Who may send which request, and when: one line for each request. A request without a line is refused.
#pragma once

#include <algorithm>

#include "firmware/app/protocol/excitation_messages.hpp"
#include "firmware/app/protocol/fault_log_messages.hpp"
#include "firmware/app/protocol/path_messages.hpp"
#include "firmware/app/protocol/pitch_messages.hpp"
#include "firmware/app/protocol/trigger_messages.hpp"
#include "firmware/app/protocol/update_messages.hpp"

namespace firmware {

enum class Asker : std::uint8_t {
  anyone,          ///< reading, stopping, disabling
  commander,       ///< anyone while every axis is at rest; while one moves, the client that moves it
  loader,          ///< a commander that has loaded this excitation, or needs no entries
  path_client,     ///< a commander that opened the path
  capture_client,  ///< the client whose streamed capture runs; anyone while none runs, or if its client is silent
  trigger_client,  ///< the same for the capture in the board's memory
};

struct RequestRule {
  MessageType type;
  Asker asker;
  bool in_motion;      ///< allowed while an axis moves
  bool commands;       ///< once accepted, its client owns the axes
  std::uint8_t least;  ///< bytes of payload
  std::uint8_t most;
};

namespace request_rules {

template <typename Payload>
inline constexpr auto kSize = static_cast<std::uint8_t>(sizeof(Payload));

using enum Asker;

// clang-format off
/// A stop is accepted with any payload.
inline constexpr std::array kRules = std::to_array<RequestRule>({
    // type                         asker           motion commands  payload
    {MessageType::identify,           anyone,         true,  false, 0, 0},
    {MessageType::status,             anyone,         true,  false, 0, kSize<StatusRequest>},
    {MessageType::timing,             anyone,         true,  false, kSize<TimingRequest>, kSize<TimingRequest>},
    {MessageType::read_values,        anyone,         true,  false, kSize<ReadRequest>, kSize<ReadRequest>},
    {MessageType::begin_staging,      anyone,         true,  false, kSize<BeginRequest>, kSize<BeginRequest>},
    {MessageType::stage,              anyone,         true,  false, kSize<ValuesPayload>, kSize<ValuesPayload>},
    {MessageType::commit,             commander,      true,  false, kSize<CommitRequest>, kSize<CommitRequest>},
    {MessageType::save,               commander,      false, false, 0, 0},
    {MessageType::read_stored,        anyone,         true,  false, kSize<ReadRequest>, kSize<ReadRequest>},
    {MessageType::begin_table,        commander,      false, false, kSize<BeginTableRequest>, kSize<BeginTableRequest>},
    {MessageType::table_points,       commander,      false, false, kSize<TablePointsRequest>,
                                                                    kSize<TablePointsRequest>},
    {MessageType::finish_table,       commander,      false, false, kSize<FinishTableRequest>,
                                                                    kSize<FinishTableRequest>},
    {MessageType::read_table,         anyone,         true,  false, kSize<ReadTableRequest>, kSize<ReadTableRequest>},
    {MessageType::enable,             commander,      true,  true,  kSize<AxesRequest>, kSize<AxesRequest>},
    {MessageType::disable,            anyone,         true,  false, kSize<AxesRequest>, kSize<AxesRequest>},
    {MessageType::stop,               anyone,         true,  false, 0, kPayloadSize},
    {MessageType::jog,                commander,      true,  true,  kSize<JogRequest>, kSize<JogRequest>},
    {MessageType::move,               commander,      true,  true,  kSize<MoveRequest>, kSize<MoveRequest>},
    {MessageType::clear_faults,       commander,      true,  false, 0, 0},
    {MessageType::heartbeat,          anyone,         true,  false, 0, 0},
    {MessageType::take_over,          anyone,         true,  true,  0, 0},
    {MessageType::home,               commander,      true,  true,  kSize<HomeRequest>, kSize<HomeRequest>},
    {MessageType::start_capture,      capture_client, true,  false, kSize<CaptureRequest>, kSize<CaptureRequest>},
    {MessageType::stop_capture,       capture_client, true,  false, 0, 0},
    {MessageType::read_fault_capture, anyone,         true,  false, kSize<FaultRowRequest>, kSize<FaultRowRequest>},
    {MessageType::read_fault_log,     anyone,         true,  false, kSize<FaultLogRequest>, kSize<FaultLogRequest>},
    {MessageType::restart,            commander,      false, false, 0, 0},
    {MessageType::load_excitation,    commander,      true,  false, kSize<ExcitationEntriesRequest>,
                                                                    kSize<ExcitationEntriesRequest>},
    {MessageType::start_excitation,   loader,         true,  true,  kSize<ExcitationRequest>, kSize<ExcitationRequest>},
    {MessageType::stop_excitation,    anyone,         true,  false, 0, kPayloadSize},
    {MessageType::excitation_state,   anyone,         true,  false, 0, 0},
    {MessageType::arm_trigger,        trigger_client, true,  false, kSize<TriggerRequest>, kSize<TriggerRequest>},
    {MessageType::trigger_state,      anyone,         true,  false, 0, 0},
    {MessageType::read_triggered,     anyone,         true,  false, kSize<ReadTriggeredRequest>,
                                                                    kSize<ReadTriggeredRequest>},
    {MessageType::open_path,          commander,      true,  true,  kSize<OpenPathRequest>, kSize<OpenPathRequest>},
    {MessageType::path_nodes,         path_client,    true,  false, 0, kPayloadSize},
    {MessageType::start_path,         path_client,    true,  true,  0, 0},
    {MessageType::path_rate,          path_client,    true,  false, kSize<PathRateRequest>, kSize<PathRateRequest>},
    {MessageType::stop_path,          anyone,         true,  false, 0, kPayloadSize},
    {MessageType::path_state,         anyone,         true,  false, 0, 0},
    {MessageType::probe_state,        anyone,         true,  false, 0, 0},
    {MessageType::begin_update,       commander,      false, false, kSize<BeginUpdateRequest>,
                                                                    kSize<BeginUpdateRequest>},
    {MessageType::update_block,       commander,      false, false, kSize<UpdateBlockRequest>,
                                                                    kSize<UpdateBlockRequest>},
    {MessageType::finish_update,      commander,      false, false, 0, 0},
    {MessageType::confirm_update,     commander,      false, false, 0, 0},
    {MessageType::read_slot,          anyone,         true,  false, kSize<ReadSlotRequest>, kSize<ReadSlotRequest>},
});
// clang-format on

}  // namespace request_rules

/// Null for a type that is no request.
constexpr const RequestRule* rule_of(MessageType type) {
  const auto* const found = std::ranges::find(request_rules::kRules, type, &RequestRule::type);
  return found != request_rules::kRules.end() ? found : nullptr;
}

/// Whether the request is refused between an accepted restart and the reset. Reading, stopping and disabling are not.
constexpr bool acts(const RequestRule& rule) { return rule.asker != Asker::anyone; }

}  // namespace firmware
