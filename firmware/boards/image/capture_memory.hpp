// The RAM that the program does not need, for triggered captures. Start-up does not initialise it, so it survives a
// reset.
#pragma once

#include <span>

#include "firmware/app/triggered_capture.hpp"

extern "C" {
extern std::uint16_t _capture_rows[], _capture_end[];  // sections.ld
}

namespace firmware::boards {

inline TriggeredState& capture_state() {
  [[gnu::section(".capture")]] static TriggeredState state;
  return state;
}
inline std::span<std::uint16_t> capture_rows() { return {_capture_rows, _capture_end}; }

}  // namespace firmware::boards
