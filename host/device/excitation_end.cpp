#include "host/device/excitation_end.hpp"

#include <fmt/format.h>

#include "firmware/core/excitation/excitation_run.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"

namespace host {

void require_completed(BoardClient& board, std::uint8_t axis, const ExcitationOutcome& outcome,
                       const std::string& kept) {
  using firmware::ExcitationEnd;
  const std::string where = kept.empty() ? "" : fmt::format(" ({})", kept);
  switch (static_cast<ExcitationEnd>(outcome.state.end)) {
    case ExcitationEnd::completed:
      if (outcome.capture.lost == 0) return;
      throw Failure(ExitCode::protocol, fmt::format("{} rows were lost on the way; `axistool doctor` looks at the way "
                                                    "to the board{}",
                                                    outcome.capture.lost, where));
    case ExcitationEnd::fault:
    case ExcitationEnd::refused:
      require_no_fault(board.status(), axis);
      throw Failure(ExitCode::refused,
                    fmt::format("the axis {}: `axistool doctor` says why{}", end_name(outcome.state), where));
    case ExcitationEnd::blind:
      throw Failure(ExitCode::refused,
                    "encoder and tachometer show different motion: one of them is reversed, dead, or not on this "
                    "axis; mend that first" +
                        where);
    case ExcitationEnd::no_motion:
      throw Failure(ExitCode::refused,
                    "nothing moved under the largest command: free the axis, look at motor, amplifier, brake and "
                    "encoder, or raise the volts of the box" +
                        where);
    case ExcitationEnd::travel:
    case ExcitationEnd::speed:
      throw Failure(ExitCode::refused, fmt::format("the axis {} and was stopped: less volts, or a wider box{}",
                                                   end_name(outcome.state), where));
    default:
      throw Failure(ExitCode::refused, fmt::format("interrupted{}", where));
  }
}

}  // namespace host
