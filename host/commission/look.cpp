// First checks: access to the board, faults, and the sign of the feedback.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/atomic_file.hpp"
#include "host/commission/steps.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/backup_file.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

double deviation(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// Noise of the sensors at rest, with the drive disabled.
nlohmann::json look_at_rest(CommissionSession& session) {
  CaptureSettings settings;
  settings.axis = session.options().axis;
  settings.kind = session.options().sheet.data.kind;
  settings.channels = usual_channels(session.options().sheet.data.tach_noise_variance.has_value());
  settings.channels.resize(session.options().sheet.data.tach_noise_variance ? 3 : 2);
  const Record record = capture_record(run_capture(session.board(), settings), settings, session.options().axis_name);
  write_record(record, session.folder().path("standstill.csv"));
  const auto [lowest, highest] = std::ranges::minmax(record.x);
  nlohmann::json seen{
      {"encoder_counts", std::round((highest - lowest) / session.options().sheet.data.encoder_resolution)}};
  if (record.has_speed()) seen["tachometer_deviation"] = deviation(record.w);
  return seen;
}

struct Pulse {
  double positive_V = 0.0, negative_V = 0.0;  ///< at breakaway; 0: it did not move
  double with_encoder = 0.0;                  ///< sum of command times motion
  double with_tachometer = 0.0;
};

Pulse pulse_of(const Record& record, double resolution) {
  Pulse pulse;
  double farthest = record.x.front(), last_sign = 0.0;  // motion against the command since its sign changed
  for (std::size_t k = 0; k + 1 < record.size(); ++k) {
    const double u = record.u_V[k], sign = u > 0.0 ? 1.0 : u < 0.0 ? -1.0 : 0.0;
    if (sign != last_sign || sign * (record.x[k] - farthest) < 0.0) farthest = record.x[k];
    last_sign = sign;
    pulse.with_encoder += u * (record.x[k + 1] - record.x[k]);
    if (record.has_speed()) pulse.with_tachometer += u * record.w[k + 1];
    double& broke = sign > 0.0 ? pulse.positive_V : pulse.negative_V;
    constexpr double kMoved = 5.0;  // counts: more than the encoder's noise
    if (sign != 0.0 && broke == 0.0 && sign * (record.x[k + 1] - farthest) > kMoved * resolution) broke = std::abs(u);
  }
  return pulse;
}

void require_right_feedback(const Pulse& pulse, const Record& record) {
  if (pulse.with_encoder < 0.0)
    throw Failure(ExitCode::refused,
                  "the encoder counts backward when the motor is driven forward, so a closed loop would run away: swap "
                  "the encoder's two channels or two leads of the motor, and start again");
  if (record.has_speed() && pulse.with_tachometer < 0.0)
    throw Failure(ExitCode::refused,
                  "the tachometer's sign is opposite to the encoder's: swap its leads, and start again");
}

}  // namespace

CommissionStepResult look(CommissionSession& session) {
  BoardClient& board = session.board();
  require_no_fault(board.status(), session.options().axis);
  const firmware::ParameterValues before = board.read_values();
  write_file_atomically(session.folder().path("before-params.toml"), format_backup(before));
  session.folder().put("was_fitted", static_cast<bool>(before.axis(session.options().axis).get<"drive.fitted">()));
  session.disable();
  session.give_scales();
  nlohmann::json seen;
  seen["standstill"] = look_at_rest(session);
  session.ask("Look: the voltage rises slowly until the axis breaks away, once in each direction.");
  constexpr double kTime_s = 8.0;
  const Record record = session.record({"pulse.csv", "ramp", {{}, {{"time", kTime_s / 4.0}}}, "", kTime_s});
  const Pulse pulse = pulse_of(record, session.options().sheet.data.encoder_resolution);
  seen["pulse"] = {{"breakaway_V", {{"positive", pulse.positive_V}, {"negative", pulse.negative_V}}}};
  session.folder().write_json("look.json", seen);
  require_right_feedback(pulse, record);
  const double breakaway = std::max(pulse.positive_V, pulse.negative_V);
  constexpr double kRoom = 0.7;  // of the voltage; the rest beyond friction must give visible acceleration
  if (breakaway > kRoom * session.options().box.volts)
    throw Failure(ExitCode::refused, fmt::format("the axis breaks away at {:.2g} V, and the box allows {:.2g} V: too "
                                                 "little acceleration remains to identify the inertia; allow {:.2g} V",
                                                 breakaway, session.options().box.volts, 2.0 * breakaway));
  return {{"before-params.toml", "standstill.csv", "pulse.csv", "look.json"},
          fmt::format("The feedback has the right sign. The axis breaks away at {:.2g} V forward and {:.2g} V "
                      "backward; at rest the encoder moves by {:g} counts.",
                      pulse.positive_V, pulse.negative_V, seen["standstill"]["encoder_counts"].get<double>())};
}

}  // namespace host
