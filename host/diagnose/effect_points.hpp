// The figures of an effect that show single samples or starts instead of means over a coordinate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/report/content.hpp"

namespace host {

/// Points of a figure: the residual of the model without an effect, and the effect's part of it.
struct EffectPoints {
  std::string caption;  ///< what is drawn
  Axis x, y;
  bool logarithmic_x = false;
  std::vector<double> at, residual, part;
  std::vector<double> lower, upper;  ///< range of each residual; empty if it is unknown
  std::vector<bool> forward;         ///< direction of the motion at each point
  TimePlot context = {};             ///< what was measured there, if the points are consecutive samples

  /// Whether the points are consecutive samples.
  bool is_record() const { return !context.panels.empty(); }

  /// Share of the squared residual that the part explains, at most 1; below 0 if it makes the residual larger.
  double explained_share() const;
};

/// View::moment. The residual of the predicted speed in one window of up to 0.2 s, in which the prediction does not
/// restart; without a speed channel, speeds are slopes of the position over 4 rows. Among the windows in which the
/// effect explains 90 % of the squared residual, it is the one in which the effect explains most, not counting a
/// straight line, because a difference that only grows shows little of its cause. If there is no such window, it is the
/// one with the largest share. Empty if the effect explains nothing.
std::optional<EffectPoints> moment_of(const sim::DriveDescription& without, const sim::DriveDescription& with,
                                      const RecordSet& set);

/// View::starts. The torque or force at which each start from rest broke away, minus the static friction of the model
/// without the effect, over the duration of the rest. It lies between the largest torque or force until 10 ms before
/// the first encoder step, and the largest until then; starts in which the two are far apart are left out, and so is
/// the first rest of a record, because its beginning is unknown. Empty if there are fewer than 4 starts.
std::optional<EffectPoints> starts_of(const sim::DriveDescription& without, const sim::DriveDescription& with,
                                      const RecordSet& set);

/// Adds the residual as points, forward and backward, and the effect's part as lines.
void append_points(const EffectPoints& points, ScatterPlot& plot);

}  // namespace host
