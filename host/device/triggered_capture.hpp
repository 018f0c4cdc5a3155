// Captures that the board takes into its own memory around an event, every sample of them.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "host/device/capture.hpp"

namespace host {

/// The event: "x.position_error > 20um", "y.fault", "any.fault", "x.motion", "x.now".
struct BoardTrigger {
  firmware::TriggerKind kind = firmware::TriggerKind::none;
  std::uint8_t axis = 0;  ///< firmware::kAnyAxis: a fault of any
  firmware::Channel channel = firmware::Channel::dac_code;
  bool falling = false;
  double level = 0.0;  ///< mm (m), rad/s (m/s), V
};

/// Whether a text means an event that the board itself looks for: it names an axis.
bool is_board_trigger(std::string_view text);

/// Throws Failure(usage) with what there is.
BoardTrigger parse_board_trigger(std::string_view text, sim::DriveKind kind);

struct TriggeredSettings {
  CaptureSettings capture;  ///< axis, kind, channels, every, duration_s (from the trigger), before_s, patience_s
  BoardTrigger trigger;
  bool wide = false;  ///< keep scalars whole: half as many rows fit
};

/// Arms the board, waits for the event and fetches the rows. Throws Failure: usage (more than the board holds; says
/// what fits), time_out, refused (`stop` said so), what BoardClient throws.
Capture run_triggered_capture(BoardClient& board, const TriggeredSettings& settings, const std::function<bool()>& stop);

/// The board's last capture of an axis, also from before a reset. `settings` becomes what it was taken with. Throws
/// Failure(refused) without one.
Capture read_triggered_capture(BoardClient& board, TriggeredSettings& settings);

}  // namespace host
