// Commands a board's axes for somebody who must show, several times a second, that he is there. Without that the
// heart-beat ends, and the board's own monitor stops the axes.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "host/device/board_client.hpp"

namespace host {

class BoardCommand {
 public:
  /// `is_there`: whether the one who commands is there now; called every 20 ms.
  BoardCommand(std::function<BoardClient()> open, std::function<bool()> is_there);
  BoardCommand(const BoardCommand&) = delete;
  BoardCommand& operator=(const BoardCommand&) = delete;
  ~BoardCommand();

  /// Opens a connection for commands. Throws as `open` does.
  void take();

  /// Carries out a command of few exchanges. Throws as it does, and Failure(refused) before take().
  void with(const std::function<void(BoardClient&)>& command);

  /// Slows all axes down, whoever moves them, and opens their loops. Ends the connection once they are off. Throws if
  /// the board cannot be reached.
  void stop();

 private:
  void beat(const std::stop_token& stop);

  const std::function<BoardClient()> open_;
  const std::function<bool()> is_there_;
  std::mutex mutex_;  ///< for the board and the flag
  std::optional<BoardClient> board_;
  bool is_stopping_ = false;
  std::jthread thread_;  ///< last, because it uses the others
};

}  // namespace host
