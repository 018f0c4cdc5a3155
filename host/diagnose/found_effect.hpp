// A found effect in the data of its machine: the residual of the model without it, the part that it explains, and its
// size.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/compare/residual_figures.hpp"
#include "host/diagnose/effect_points.hpp"
#include "host/fit/prepared_sets.hpp"
#include "host/report/report.hpp"
#include "sim/effect.hpp"

namespace host {

struct FoundEffect {
  std::string kind;
  sim::DriveKind drive = sim::DriveKind::rotary;
  bool of_speed_channel = false;           ///< its residual is a speed, otherwise a torque or force
  ResidualCoordinate over;                 ///< the one in EffectInfo::along that explains most of its trace
  ResidualEffort without;                  ///< residual of the model without the effect, all other parameters unchanged
  std::vector<double> trace;               ///< the effect's contribution: residual without it minus residual with it
  std::optional<std::size_t> only_record;  ///< for curves over time: other records' samples are NaN
  /// What effect_plot() draws: the view that the effect's entry in the catalogue states, or the moment, if its trace
  /// depends on none of its coordinates or the records have too few starts.
  sim::View view = sim::View::curve;
  std::optional<EffectPoints> points;  ///< of a view that is not of means over the coordinate
  /// Size of the effect, >= 0. For torques and forces: largest mean of the trace over the coordinate, or the largest
  /// part of a start. For an encoder error: its largest value. For effects of the command, the motor or the
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

/// Share of the squared residual in effect_plot() that the effect explains, at most 1.
double explained_share(const FoundEffect& effect);

/// The figure that shows the effect, as its entry in the catalogue states (sim::View): the residual without the effect
/// as points, forward and backward, and the effect's own part as lines.
ScatterPlot effect_plot(const FoundEffect& effect);

/// Sets the vertical range to that of the means and the lines, with a margin. The spread of the samples in a bin, and
/// bins of few samples, could flatten all curves.
void show_means(ScatterPlot& plot);

}  // namespace host
