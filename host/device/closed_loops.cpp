#include "host/device/closed_loops.hpp"

#include <exception>
#include <utility>

#include "host/device/motion.hpp"

namespace host {

namespace {

std::uint8_t open_axes(BoardClient& board, std::uint8_t mask) {
  const std::uint8_t closed = enabled_axes(board, mask);
  return static_cast<std::uint8_t>(mask & ~closed);
}

}  // namespace

ClosedLoops::ClosedLoops(BoardClient& board, std::uint8_t mask) : board_(board), opens_(open_axes(board, mask)) {
  if (opens_ == 0) return;
  try {
    enable_and_wait(board_, opens_);
  } catch (...) {  // the board may close the loops after the time-out
    open_quietly();
    throw;
  }
}

ClosedLoops::~ClosedLoops() { open_quietly(); }

void ClosedLoops::open() {
  const std::uint8_t mask = std::exchange(opens_, std::uint8_t{0});
  if (mask != 0) disable_and_wait(board_, mask);
}

void ClosedLoops::open_quietly() noexcept {
  try {
    if (opens_ != 0 && (board_.status().flags & firmware::kBoardOthers) == 0) open();
  } catch (const std::exception&) {  // the link is lost: the board's heartbeat time-out stops the axes
  }
}

}  // namespace host
