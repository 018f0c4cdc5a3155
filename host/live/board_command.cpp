#include "host/live/board_command.hpp"

#include <algorithm>
#include <utility>

#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr std::uint8_t kAllAxes = 0xFF;

bool are_outputs_on(const BoardState& status) {
  return std::ranges::any_of(status.axis, [](const firmware::AxisStatus& axis) {
    return firmware::outputs_are_on(static_cast<firmware::SupervisorState>(axis.state));
  });
}

std::uint8_t mask_of(BoardClient& board) { return static_cast<std::uint8_t>(kAllAxes >> (8U - board.axis_count())); }

}  // namespace

BoardCommand::BoardCommand(std::function<BoardClient()> open, std::function<bool()> is_there)
    : open_(std::move(open)),
      is_there_(std::move(is_there)),
      thread_([this](const std::stop_token& stop) { beat(stop); }) {}

BoardCommand::~BoardCommand() = default;

void BoardCommand::take() {
  BoardClient board = open_();
  board.axis_count();
  const std::lock_guard lock(mutex_);
  if (is_stopping_) throw Failure(ExitCode::refused, "the axes are not yet off: wait until they stand");
  board_.emplace(std::move(board));
}

void BoardCommand::with(const std::function<void(BoardClient&)>& command) {
  const std::lock_guard lock(mutex_);
  if (!board_ || is_stopping_) throw Failure(ExitCode::refused, "nobody has taken the command");
  command(*board_);
}

void BoardCommand::stop() {
  const std::lock_guard lock(mutex_);
  is_stopping_ = true;
  try {
    if (board_) return board_->disable(mask_of(*board_));
  } catch (const Failure&) {  // by another connection
  }
  board_.reset();
  board_.emplace(open_());
  board_->disable(mask_of(*board_));
}

void BoardCommand::beat(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(kHeartbeat);
    const std::lock_guard lock(mutex_);
    if (!board_) {
      is_stopping_ = false;
      continue;
    }
    try {
      if (is_stopping_ ? are_outputs_on(board_->status()) : is_there_()) {
        if (!is_stopping_) board_->heartbeat();
        continue;
      }
    } catch (const Failure&) {  // the board has gone, and with it the connection
    }
    board_.reset();
    is_stopping_ = false;
  }
}

}  // namespace host
