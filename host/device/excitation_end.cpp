#include "host/device/excitation_end.hpp"

#include <fmt/format.h>

#include <cmath>

#include "firmware/core/excitation/excitation_run.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

/// Compares encoder and tachometer in the capture: least-squares factor between travel and angle per sample.
std::string disagreement(const ExcitationOutcome& outcome, double lead) {
  const Record record = capture_record(outcome.capture, outcome.settings, "");
  const std::string general = "encoder and tachometer show different motion";
  if (!record.has_position() || !record.has_speed() || record.size() < 3 || !(lead > 0.0)) return general;
  double travel_2 = 0.0, angle_2 = 0.0, both = 0.0;
  for (std::size_t k = 1; k < record.size(); ++k) {
    const double travel = record.x[k] - record.x[k - 1];
    const double by_speed = lead * 0.5 * (record.w[k] + record.w[k - 1]) * record.sample_period_s;
    travel_2 += travel * travel;
    angle_2 += by_speed * by_speed;
    both += travel * by_speed;
  }
  constexpr double kAlike = 0.8, kDead = 1e-3;
  if (travel_2 <= kDead * kDead * angle_2)
    return "the tachometer shows motion but the encoder does not: the encoder is dead, or not on this axis";
  if (angle_2 <= kDead * kDead * travel_2)
    return "the encoder shows motion but the tachometer does not: the tachometer is dead, or not on this axis";
  const double alike = both / std::sqrt(travel_2 * angle_2), factor = both / angle_2;
  if (alike < -kAlike) return "encoder and tachometer run against each other: one of them is reversed";
  if (alike > kAlike)
    return fmt::format(
        "the encoder shows {:.3g} times the tachometer's motion: drive.encoder_resolution, drive.lead or "
        "tachometer.gain is not this drive's (--drive DRIVE.toml gives them)",
        factor);
  return general + ", with another time course: one of them is not on this axis";
}

}  // namespace

void require_completed(BoardClient& board, std::uint8_t axis, const ExcitationOutcome& outcome,
                       const std::string& kept) {
  using firmware::ExcitationEnd;
  const std::string where = kept.empty() ? "" : fmt::format(" ({})", kept);
  switch (static_cast<ExcitationEnd>(outcome.state.end)) {
    case ExcitationEnd::completed:
      if (outcome.capture.lost == 0) return;
      throw Failure(ExitCode::protocol,
                    fmt::format("{} rows were lost; `axistool doctor` checks the connection to the board{}",
                                outcome.capture.lost, where));
    case ExcitationEnd::fault:
    case ExcitationEnd::refused:
      require_no_fault(board.status(), axis);
      throw Failure(ExitCode::refused,
                    fmt::format("the axis {}: `axistool doctor` says why{}", end_name(outcome.state), where));
    case ExcitationEnd::blind:
      throw Failure(ExitCode::refused,
                    disagreement(outcome, static_cast<double>(board.read_values().axis(axis).get<"drive.lead">())) +
                        "; correct that first" + where);
    case ExcitationEnd::no_motion:
      throw Failure(ExitCode::refused,
                    "nothing moved at the largest command: free the axis, check motor, amplifier, brake and encoder, "
                    "or raise the volts of the box" +
                        where);
    case ExcitationEnd::travel:
    case ExcitationEnd::speed:
      throw Failure(ExitCode::refused, fmt::format("the axis {} and was stopped: give fewer volts, or a wider box{}",
                                                   end_name(outcome.state), where));
    default:
      throw Failure(ExitCode::refused, fmt::format("interrupted{}", where));
  }
}

}  // namespace host
