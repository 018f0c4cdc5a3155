#include "host/identify/inverse_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/identify/linear_axis.hpp"
#include "sim/drive.hpp"
#include "sim/friction.hpp"

namespace host {

namespace {

double friction_magnitude(const sim::Drive& drive, double t_s, double travel, double speed, double motor_effort) {
  const std::size_t side = speed > 0.0 ? 0 : 1;
  const sim::FrictionSide& law = drive.friction[side];
  const double magnitude = std::abs(speed);
  double level = sim::stribeck_curve(law, law.breakaway, magnitude).effort;
  for (const auto& factor : drive.level_factor) level *= factor(t_s, travel);
  double viscous = law.viscous * magnitude;
  for (const auto& factor : drive.viscous_factor) viscous *= factor(t_s);
  double friction = level + viscous;
  for (const auto& further : drive.sliding_friction) friction += further(magnitude).effort;
  return friction + drive.transmitted_share * std::abs(motor_effort);
}

/// The record as the motor saw it: commands through the converter's effects, delayed by what the drive delays. A model
/// that tells when a command acts means one that is held for a sample: what moves the axis about the instant of a
/// sample has then been sent half a sample earlier still. Without such an effect command and motion are taken as
/// simultaneous, as published inverse models have them.
Record as_the_motor_saw(const Record& record, const sim::Drive& drive) {
  Record seen = record;
  for (double& u : seen.u_V) {
    for (const auto& stage : drive.command) u = stage(u);
  }
  const double delay = drive.delay_s + drive.current_lag_s;  // a lag far below the motion's period acts as a delay
  if (delay > 0.0 && !seen.u_V.empty()) {
    constexpr double kHold = 0.5;
    const double samples = delay / record.sample_period_s + kHold;
    const auto whole = static_cast<std::size_t>(samples);
    const double part = samples - static_cast<double>(whole);
    const std::vector<double> sent = seen.u_V;
    for (std::size_t k = 0; k < sent.size(); ++k) {
      const double later = sent[k >= whole ? k - whole : 0];
      const double earlier = sent[k >= whole + 1 ? k - whole - 1 : 0];
      seen.u_V[k] = (1.0 - part) * later + part * earlier;
    }
  }
  if (record.has_position()) {
    std::vector<double>& drive_signal = seen.u_V.empty() ? seen.i_A : seen.u_V;
    for (std::size_t k = 0; k < drive_signal.size(); ++k) {
      for (const auto& factor : drive.effort_factor) drive_signal[k] *= factor(record.x[k]);
    }
  }
  return seen;
}

}  // namespace

std::vector<double> inverse_effort(const sim::DriveDescription& model, const Motion& motion) {
  const sim::Drive drive(model);
  std::vector<double> effort(motion.speed.size());
  for (std::size_t k = 0; k < effort.size(); ++k) {
    const double speed = motion.speed[k];
    double sum = drive.inertia * motion.acceleration[k];
    if (speed != 0.0) {
      const double friction = friction_magnitude(drive, motion.t_s[k], motion.travel[k], speed, motion.effort[k]);
      sum += speed > 0.0 ? friction : -friction;
    }
    for (const auto& load : drive.load_effort) sum -= load(motion.t_s[k], motion.travel[k]);
    effort[k] = sum;
  }
  return effort;
}

double relative_error(const sim::DriveDescription& model, const Record& record, const MotionOptions& options) {
  return relative_error(model, std::vector<Record>{record}, options);
}

double relative_error(const sim::DriveDescription& model, const std::vector<Record>& records,
                      const MotionOptions& options) {
  rigid_axis(model);  // says what is wrong where there is no inertia
  const sim::Drive drive(model);
  MotionOptions settled = options;
  if (!settled.cutoff_Hz) settled.cutoff_Hz = choose_cutoff(records, model.data);
  double residual = 0.0, total = 0.0;
  for (const Record& record : records) {
    const Motion motion = prepare_motion(as_the_motor_saw(record, drive), model.data, settled);
    const std::vector<double> measured = motion.seen(motion.effort);
    const std::vector<double> modelled = motion.seen(inverse_effort(model, motion));
    for (std::size_t k = 0; k < measured.size(); ++k) {
      residual += (measured[k] - modelled[k]) * (measured[k] - modelled[k]);
      total += measured[k] * measured[k];
    }
  }
  if (!(total > 0.0)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: the axis never slides faster than the dead band, so there is "
                                                   "nothing to compare; record it in motion",
                                                   records.empty() ? std::string("record") : records.front().path));
  }
  return std::sqrt(residual / total);
}

}  // namespace host
