// A found effect in its machine's data: the residual of the model without it, the part that it explains, and its size.
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
  ResidualCoordinate over;                 ///< of those in EffectInfo::along, the one that carries most of its trace
  ResidualEffort without;                  ///< residual of the model without the effect, all other parameters unchanged
  std::vector<double> trace;               ///< the effect's contribution: residual without it minus residual with it
  std::optional<std::size_t> only_record;  ///< over time: records have no common time, so the others' samples are NaN
  /// Used if no coordinate carries the trace, as after each step of the command: the part of the record with the
  /// strongest trace.
  std::optional<std::array<double, 2>> cutout_s;
  /// Largest mean of the trace over the coordinate, in a cutout its largest value, >= 0. For an encoder's error its
  /// largest value; for effects of the command, the motor or the mechanics their first parameter (a gap, a delay, a
  /// resonance).
  double size = 0.0;
  std::string unit;                           ///< of the size: Nm or N, rad/s or m/s, µm, ms, Hz ...
  std::optional<std::array<double, 2>> ci95;  ///< 95 % interval of the size; empty if the fit gives none
  std::optional<double> share_of_friction;    ///< size over the Coulomb level, of torques on the shaft
};

/// The effects of these kinds in a fitted model, on all records of the sets. A kind that leaves no trace (the axis
/// never slides) is absent.
std::vector<FoundEffect> found_effects(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                       const PreparedSets& sets);

/// "Cogging: 0.9 Nm [0.86, 0.94], 31 % of the friction".
std::string size_in_words(const FoundEffect& effect);

/// Adds the residual over a coordinate, forward and backward as points, and a part of it as lines.
void append_curves(const ResidualCoordinate& over, const ResidualEffort& residual, const std::vector<double>& part,
                   ScatterPlot& plot);

/// The residual without the effect over its coordinate, forward and backward, and the effect's own curve over it.
ScatterPlot effect_plot(const FoundEffect& effect);

}  // namespace host
