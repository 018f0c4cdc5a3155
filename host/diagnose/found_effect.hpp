// A found effect in the data of its machine: the residual of the model without it, the part that it explains, and its
// size.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/compare/residual_figures.hpp"
#include "host/diagnose/prepared_sets.hpp"
#include "host/report/report.hpp"

namespace host {

struct FoundEffect {
  std::string kind;
  sim::DriveKind drive = sim::DriveKind::rotary;
  bool of_speed_channel = false;           ///< its residual is a speed, otherwise a torque or force
  ResidualCoordinate over;                 ///< the one in EffectInfo::along that explains most of its trace
  ResidualEffort without;                  ///< residual of the model without the effect, all other parameters unchanged
  std::vector<double> trace;               ///< the effect's contribution: residual without it minus residual with it
  std::optional<std::size_t> only_record;  ///< for curves over time: other records' samples are NaN
  /// Set if the trace depends on no coordinate, for example if it follows each step of the command: the interval of the
  /// record with the strongest trace.
  std::optional<std::array<double, 2>> cutout_s;
  /// Size of the effect, >= 0. For torques and forces: largest mean of the trace over the coordinate, or its largest
  /// value in a cutout. For an encoder error: its largest value. For effects of the command, the motor or the
  /// mechanics: their first parameter (a gap, a delay, a resonance).
  double size = 0.0;
  std::string unit;                           ///< of the size: Nm or N, rad/s or m/s, µm, ms, Hz ...
  std::optional<std::array<double, 2>> ci95;  ///< 95 % interval of the size; empty if the fit gives none
  std::optional<double> share_of_friction;    ///< size over the Coulomb level, of torques on the shaft
};

/// The effects of these kinds in a fitted model, on all records of the sets. A kind without a trace is left out (for
/// example if the axis never slides).
std::vector<FoundEffect> found_effects(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                       const PreparedSets& sets);

/// "Cogging: 0.9 Nm [0.86, 0.94], 31 % of the friction".
std::string size_in_words(const FoundEffect& effect);

/// Adds the residual over a coordinate as points, forward and backward, and a part of it as lines.
void append_curves(const ResidualCoordinate& over, const ResidualEffort& residual, const std::vector<double>& part,
                   ScatterPlot& plot);

/// The residual without the effect over its coordinate, forward and backward, and the effect's own curve over it.
ScatterPlot effect_plot(const FoundEffect& effect);

}  // namespace host
