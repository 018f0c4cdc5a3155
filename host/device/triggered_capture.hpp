// Captures of every sample around an event, in the board's own memory.
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
  std::uint8_t axis = 0;  ///< firmware::kAnyAxis: a fault of any axis
  firmware::Channel channel = firmware::Channel::dac_code;
  bool falling = false;
  double level = 0.0;  ///< mm (m), rad/s (m/s), V
};

/// Whether the text names an axis: then the board itself detects the event.
bool is_board_trigger(std::string_view text);

/// Throws Failure(usage) with the list of known events.
BoardTrigger parse_board_trigger(std::string_view text, sim::DriveKind kind);

struct TriggeredSettings {
  CaptureSettings capture;  ///< axis, kind, channels, every, duration_s (from the trigger), before_s, patience_s
  BoardTrigger trigger;
  bool wide = false;  ///< keep scalars in full precision: half as many rows fit
};

/// Arms the board, waits for the event and fetches the rows. Throws Failure: usage (more than the board holds; states
/// how much fits), time_out, refused (`stop` returned true), and those of BoardClient.
Capture run_triggered_capture(BoardClient& board, const TriggeredSettings& settings, const std::function<bool()>& stop);

/// The board's last capture of an axis, even from before a reset. Sets `settings` to those of the capture. Throws
/// Failure(refused) if there is none.
Capture read_triggered_capture(BoardClient& board, TriggeredSettings& settings);

}  // namespace host
