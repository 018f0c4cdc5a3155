#include "host/evidence/clipped_command.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "host/dense_solutions.hpp"
#include "host/evidence/channel_shift.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

constexpr double kAtLevel = 0.999;           ///< of the largest command
constexpr double kLeastClipped = 0.002;      ///< of all rows
constexpr double kBelowLimit = 0.98;         ///< closer to its limit, the converter itself clips the command
constexpr double kLeastExcess = 0.15;        ///< of the level; more than a deviation from Coulomb friction can cause
constexpr double kLeastExcessByModel = 0.5;  ///< a first model may be wrong by a third
constexpr double kMostPlateaus = 0.8;        ///< least part of the plateaus that must show the excess
constexpr std::size_t kFewestPlateaus = 3;

Eigen::Vector4d regressors(const Motion& motion, std::size_t k) {
  const double w = motion.speed[k];
  return {motion.acceleration[k], w, w > 0.0 ? 1.0 : 0.0, w < 0.0 ? 1.0 : 0.0};
}

/// Inertia and friction from the rows `use`; empty if these rows do not determine them.
std::optional<Eigen::Vector4d> rigid_fit(const Motion& motion, const std::vector<std::size_t>& use) {
  constexpr std::size_t kFewestRows = 200;
  constexpr double kDetermined = 0.05;  // relative standard error of the inertia
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d cross = Eigen::Vector4d::Zero();
  double total = 0.0;
  for (const std::size_t k : use) {
    const Eigen::Vector4d phi = regressors(motion, k);
    normal += phi * phi.transpose();
    cross += phi * motion.effort[k];
    total += motion.effort[k] * motion.effort[k];
  }
  if (use.size() < kFewestRows) return std::nullopt;
  const Eigen::Matrix4d inverse = pseudo_inverse(normal);
  const Eigen::Vector4d found = inverse * cross;
  // White noise below the cut-off has this many independent samples.
  const double independent = static_cast<double>(use.size()) * 2.0 * motion.cutoff_Hz / motion.sample_rate_Hz;
  const double variance = std::max(0.0, total - found.dot(cross)) / std::max(1.0, independent - 4.0);
  const double scale = static_cast<double>(use.size()) / std::max(1.0, independent);
  if (!(found(0) > 0.0) || std::sqrt(variance * scale * inverse(0, 0)) > kDetermined * found(0)) return std::nullopt;
  return found;
}

}  // namespace

std::optional<ClippedCommand> clipped_command(const Record& record, const sim::DriveDescription& model) {
  if (record.u_V.empty()) return std::nullopt;
  double level_V = 0.0;
  for (const double u_V : record.u_V) level_V = std::max(level_V, std::abs(u_V));
  const bool limited = model.data.dac_limit_V > 0.0 && level_V > kBelowLimit * model.data.dac_limit_V;
  std::size_t at_level = 0;
  for (const double u_V : record.u_V)
    if (std::abs(u_V) >= kAtLevel * level_V) ++at_level;
  const double share = static_cast<double>(at_level) / static_cast<double>(record.size());
  if (!(level_V > 0.0) || limited || share < kLeastClipped) return std::nullopt;

  MotionOptions options;
  options.decimation = 1;
  const std::optional<Motion> prepared = motion_if_long_enough(record, model.data, options);
  if (!prepared) return std::nullopt;
  const Motion& motion = *prepared;
  const auto reach = static_cast<std::size_t>(std::ceil(0.5 * motion.sample_rate_Hz / motion.cutoff_Hz));
  // Rows around which the command is below the level, or at it, as far as the filter reaches.
  std::vector<std::size_t> below, at;
  std::vector<std::size_t> run(record.size());
  const auto is_at = [&](std::size_t row) { return std::abs(record.u_V[row]) >= kAtLevel * level_V; };
  for (std::size_t row = 0; row < record.size(); ++row)
    run[row] =
        row > 0 && is_at(row) == is_at(row - 1) && record.u_V[row] * record.u_V[row - 1] >= 0.0 ? run[row - 1] + 1 : 1;
  double top_below = 0.0;
  for (std::size_t k = reach; k + reach < motion.speed.size(); ++k) {
    if (!motion.counts[k]) continue;
    const std::size_t row = k + kMotionMargin;
    if (run[row + reach] > 2 * reach && is_at(row)) at.push_back(k);
    bool clear = true;
    for (std::size_t near = row - reach; clear && near <= row + reach; ++near) clear = !is_at(near);
    if (!clear) continue;
    below.push_back(k);
    top_below = std::max(top_below, std::abs(motion.speed[k]));
  }
  const std::optional<Eigen::Vector4d> seen = rigid_fit(motion, below);
  const sim::Drive drive(model);
  if (!seen && !(drive.inertia > 0.0)) return std::nullopt;
  const Eigen::Vector4d rigid = seen ? *seen
                                     : Eigen::Vector4d(drive.inertia, drive.friction[0].viscous,
                                                       drive.friction[0].coulomb, -drive.friction[1].coulomb);
  const double least_excess = seen ? kLeastExcess : kLeastExcessByModel;

  struct Plateau {
    std::size_t last = 0, rows = 0;
    double excess = 0.0;
  };
  std::vector<Plateau> plateaus;
  for (const std::size_t k : at) {
    if (seen && std::abs(motion.speed[k]) > top_below) continue;  // friction is known only up to that speed
    if (plateaus.empty() || k > plateaus.back().last + 1) plateaus.push_back({});
    const double sign = motion.effort[k] > 0.0 ? 1.0 : -1.0;
    Plateau& plateau = plateaus.back();
    plateau.last = k;
    ++plateau.rows;
    plateau.excess += sign * (regressors(motion, k).dot(rigid) - motion.effort[k]);
  }
  if (plateaus.size() < kFewestPlateaus) return std::nullopt;
  const double effort = model.data.effort_per_volt() * level_V;
  double mean = 0.0;
  std::size_t rows = 0, showing = 0;
  for (const Plateau& plateau : plateaus) {
    mean += plateau.excess;
    rows += plateau.rows;
    if (plateau.excess > 0.5 * least_excess * effort * static_cast<double>(plateau.rows)) ++showing;
  }
  const double excess = mean / static_cast<double>(rows) / effort;
  if (excess < least_excess || static_cast<double>(showing) < kMostPlateaus * static_cast<double>(plateaus.size()))
    return std::nullopt;
  return ClippedCommand{level_V, share, excess, motion.t_s[at.front()]};
}

}  // namespace host
