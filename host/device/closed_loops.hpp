// Control loops that are closed for a piece of work, and opened again at its end.
#pragma once

#include <cstdint>

#include "host/device/board_client.hpp"

namespace host {

/// Closes the loops of a mask for the work of a scope. Those that were open before are opened again at its end, also
/// when the work throws; those that were closed stay closed.
class ClosedLoops {
 public:
  /// Throws as enable_and_wait() does, and then leaves no loop closed that was open.
  ClosedLoops(BoardClient& board, std::uint8_t mask);
  /// Opens the loops again if open() has not. Suppresses errors, because the error that ends the scope tells more.
  /// Leaves axes alone that another program has taken over.
  ~ClosedLoops();
  ClosedLoops(const ClosedLoops&) = delete;
  ClosedLoops& operator=(const ClosedLoops&) = delete;

  /// Opens the loops again. Throws Failure(time_out) if an axis does not come to rest, or if the link is lost.
  void open();

 private:
  void open_quietly() noexcept;

  BoardClient& board_;
  std::uint8_t opens_;  ///< mask of the axes to open
};

}  // namespace host
