#include "host/identify/inverse_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/exit_codes.hpp"
#include "host/identify/linear_axis.hpp"
#include "host/identify/zero_phase_filter.hpp"
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
  for (const auto& further : drive.sliding_friction) friction += further(static_cast<int>(side), magnitude).effort;
  for (const auto& further : drive.further_level) friction += further(t_s, travel);
  return friction + drive.transmitted_share * std::abs(motor_effort);
}

}  // namespace

bool has_inverse(const sim::Drive& drive) {
  return drive.current_lag_s <= 0.0 && !drive.bristles && !drive.has_second_mass() && drive.friction_memory_s <= 0.0 &&
         drive.dwell_gain <= 0.0 && drive.effort_limit.empty() && drive.encoder_error.empty() &&
         drive.friction_after_reversal.empty();
}

std::vector<double> inverse_effort(const sim::Drive& drive, const Motion& motion) {
  std::vector<double> effort(motion.speed.size());
  for (std::size_t k = 0; k < effort.size(); ++k) {
    const double speed = motion.speed[k];
    double sum = drive.inertia * motion.acceleration[k];
    if (speed != 0.0) {
      const double friction = friction_magnitude(drive, motion.t_s[k], motion.travel[k], speed, motion.effort[k]);
      sum += speed > 0.0 ? friction : -friction;
    }
    sum -= drive.with_loads(0.0, speed, motion.t_s[k], motion.travel[k]);
    effort[k] = sum;
  }
  return effort;
}

namespace {

/// Torque or force of a model after the regression's filter. Effects that repeat along the travel may be faster than
/// the filter, so they pass through it like the measured torque or force. Speed and acceleration are already filtered.
class SeenEffort {
 public:
  explicit SeenEffort(const sim::DriveDescription& model) : drive_(model) {
    sim::DriveDescription smooth = model;
    if (std::erase_if(smooth.effects, [](const sim::EffectEntry& entry) { return entry.has("period"); }) > 0)
      smooth_.emplace(smooth);
  }

  const sim::Drive& drive() const { return drive_; }

  std::vector<double> operator()(const Motion& motion) const {
    std::vector<double> effort = inverse_effort(drive_, motion);
    if (!smooth_) return motion.seen(effort);
    const std::vector<double> smooth = inverse_effort(*smooth_, motion);
    for (std::size_t k = 0; k < effort.size(); ++k) effort[k] -= smooth[k];
    effort = ZeroPhaseLowPass::butterworth(motion.cutoff_Hz, motion.sample_rate_Hz)(effort);
    for (std::size_t k = 0; k < effort.size(); ++k) effort[k] += smooth[k];
    return motion.seen(effort);
  }

 private:
  sim::Drive drive_;
  std::optional<sim::Drive> smooth_;  ///< drive without effects that repeat along the travel; empty if it has none
};

}  // namespace

namespace {

/// Whether the axis moves by more than sensors may show at rest: 10 counts, or speeds of one sign above the noise.
bool has_moved(const Record& record, const sim::DataSheet& data) {
  constexpr double kCounts = 10.0, kDeviations = 5.0;
  if (record.has_position()) {
    const auto [least, most] = std::ranges::minmax(record.x);
    return most - least > kCounts * data.encoder_resolution;
  }
  double travel = 0.0, farthest = 0.0;
  for (const double w : record.w) farthest = std::max(farthest, std::abs(travel += w));
  return farthest >
         kDeviations * std::sqrt(data.tach_noise_variance.value_or(0.0) * static_cast<double>(record.size()));
}

}  // namespace

double relative_error(const sim::DriveDescription& model, const Record& record, const MotionOptions& options) {
  return relative_error(model, std::vector<Record>{record}, options);
}

double relative_error(const sim::DriveDescription& model, const std::vector<Record>& records,
                      const MotionOptions& options) {
  rigid_axis(model);  // throws if there is no inertia
  const SeenEffort modelled_effort(model);
  MotionOptions settled = options;
  if (!settled.cutoff_Hz) settled.cutoff_Hz = choose_cutoff(records, model.data);
  settled.command_path = &modelled_effort.drive();
  double residual = 0.0, total = 0.0;
  for (const Record& record : records) {
    const Motion motion = prepare_motion(record, model.data, settled);
    const std::vector<double> measured = motion.seen(motion.effort);
    const std::vector<double> modelled = modelled_effort(motion);
    for (std::size_t k = 0; k < measured.size(); ++k) {
      residual += (measured[k] - modelled[k]) * (measured[k] - modelled[k]);
      total += measured[k] * measured[k];
    }
  }
  if (!(total > 0.0) && !options.deadband &&
      std::ranges::any_of(records, [&](const Record& one) { return has_moved(one, model.data); })) {
    MotionOptions all = options;
    all.deadband = 0.0;  // the motion is too slow or short for a dead band; uses every sample
    return relative_error(model, records, all);
  }
  if (!(total > 0.0)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format(
            "{}: the axis never moves faster than the dead band, so there is nothing to compare; record more motion",
            records.empty() ? std::string("record") : records.front().path));
  }
  return std::sqrt(residual / total);
}

}  // namespace host
