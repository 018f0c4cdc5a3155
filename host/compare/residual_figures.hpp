// The residual of a model over the coordinates in which effects show. Forward and backward motion are separate, because
// the mean of both hides variations of the friction.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/compare/residual_effort.hpp"
#include "host/report/report.hpp"

namespace host {

/// The residual of one model.
struct ResidualView {
  std::string name;      ///< for titles and legends, if there are several
  SeriesRole role;       ///< role of the series if several models share a plot
  ResidualEffort force;  ///< residuals_on()
  ResidualEffort speed;  ///< residual_of_speed_channel()
};

/// Residuals of the models on a set, in the order of the models: of the inverse models if all models have one, else of
/// the predictions. They can be subtracted from one another sample by sample.
std::vector<ResidualEffort> residuals_on(const std::vector<const sim::DriveDescription*>& models, const RecordSet& set);

/// Coordinate over which a residual is drawn.
struct ResidualCoordinate {
  Axis axis;
  std::vector<double> ResidualEffort::*along;
  double factor = 1.0;       ///< from the drive's unit to that of the axis
  double period = 0.0;       ///< period of a known ripple, in the unit of the axis; 0 if there is none
  bool folded = false;       ///< folded by that period
  bool logarithmic = false;  ///< logarithmic axis of the magnitude

  /// Values of the coordinate at all samples, in the unit of the axis.
  std::vector<double> of(const ResidualEffort& samples) const;
};

/// The coordinate with that name in EffectInfo::along. `period`: of the ripple along the travel, mm or m; 0 if there is
/// none. "phase" is the position folded by it. "frequency" has no value at a sample; for "temperature" see
/// ResidualEffort.
ResidualCoordinate coordinate_of(std::string_view name, sim::DriveKind kind, double period = 0.0);

/// The longest period of the model's ripples along the travel, else the pitch of its screw, else 0; mm or m.
double ripple_period(const sim::DriveDescription& model);

/// The means of `values` over a coordinate as two curves, forward and backward. Each bin has the band that holds 80 %
/// of its samples. Over the speed, runs at constant speeds are one bin each.
std::vector<ScatterSeries> direction_curves(const ResidualEffort& samples, const std::vector<double>& values,
                                            const ResidualCoordinate& over);

enum class Layout {
  overlaid,     ///< one plot, a colour per model, backward dashed, no bands; a single model: as below
  side_by_side  ///< one plot per model, with the same vertical range
};

/// Adds one of the residuals over a coordinate, or `instead` of the residual another coordinate; nothing if a view has
/// no samples, and then returns false.
bool add_residual_plot(Report& report, const ResidualCoordinate& over, const std::string& title, const Axis& value,
                       std::span<const ResidualView> views, ResidualEffort ResidualView::*what, Layout layout,
                       const ResidualCoordinate* instead = nullptr);

/// Adds the plot of a focus: one quantity over another, by direction. States why, if it cannot be drawn. `period`: as
/// in coordinate_of().
void add_chosen_plot(Report& report, std::span<const ResidualView> views,
                     const std::pair<std::string, std::string>& names, sim::DriveKind kind, double period);

/// Adds the missing torque or force over speed, position, acceleration and time, and the error of the speed channel if
/// there is one. `period`: as in coordinate_of(). `model`: gives the units.
void add_residual_plots(Report& report, std::span<const ResidualView> views, const sim::DriveDescription& model,
                        double period, Layout layout);

/// Adds maps of the missing torque or force over two coordinates, one per view, with the same colour scale. The period
/// of `across` is the width of its cells.
void add_residual_maps(Report& report, std::span<const ResidualView> views, const ResidualCoordinate& across,
                       const ResidualCoordinate& up, sim::DriveKind kind);

}  // namespace host
