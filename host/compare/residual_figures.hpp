// The residual of a model over the coordinates in which effects show. Forward and backward motion stay apart: the mean
// of both hides a friction that varies.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/compare/residual_effort.hpp"
#include "host/report/report.hpp"

namespace host {

/// The residual of one model.
struct ResidualView {
  std::string name;      ///< in titles and legends where there are several
  SeriesRole role;       ///< where several models share a plot
  ResidualEffort force;  ///< residuals_on()
  ResidualEffort speed;  ///< residual_of_speed_channel()
};

/// Residuals of the models on a set, in their order: of the inverse models where all have one, else of the predictions.
/// They can be subtracted from one another, sample by sample.
std::vector<ResidualEffort> residuals_on(const std::vector<const sim::DriveDescription*>& models, const RecordSet& set);

/// Coordinate over which a residual is drawn.
struct ResidualCoordinate {
  Axis axis;
  std::vector<double> ResidualEffort::*along;
  double factor = 1.0;       ///< from the drive's unit to that of the axis
  double period = 0.0;       ///< known ripple along this coordinate, in the unit of the axis; 0: none
  bool folded = false;       ///< by that period
  bool logarithmic = false;  ///< drawn over the magnitude

  /// Its values at all samples, in the unit of the axis.
  std::vector<double> of(const ResidualEffort& samples) const;
};

/// The coordinate of that name in EffectInfo::along. `period`: of the ripple along the travel, mm or m; 0: none. For
/// "frequency", which is none of a sample, and "temperature" see ResidualEffort.
ResidualCoordinate coordinate_of(std::string_view name, sim::DriveKind kind, double period = 0.0);

/// The longest period of the model's ripples along the travel, else the pitch of its screw; 0: none. mm or m.
double ripple_period(const sim::DriveDescription& model);

/// The means of `values` over a coordinate in two curves, forward and backward, each bin with the band that holds 80 %
/// of its samples.
std::vector<ScatterSeries> direction_curves(const ResidualEffort& samples, const std::vector<double>& values,
                                            const ResidualCoordinate& over);

enum class Layout {
  overlaid,     ///< in one plot, each model in its colour, backward dashed and without bands; one model alone: as below
  side_by_side  ///< a plot each, with the same vertical range
};

/// One of the residuals over one coordinate; nothing where a view has no samples.
void add_residual_plot(Report& report, const ResidualCoordinate& over, const std::string& title, const Axis& value,
                       std::span<const ResidualView> views, ResidualEffort ResidualView::*what, Layout layout);

/// The missing torque or force over speed, position, acceleration and time, and the error of the speed channel where
/// there is one. `period`: as in coordinate_of(). `model`: whose units are shown.
void add_residual_plots(Report& report, std::span<const ResidualView> views, const sim::DriveDescription& model,
                        double period, Layout layout);

/// The missing torque or force over two coordinates, one map a view, all with the same colours. The period of `across`
/// is that of its cells.
void add_residual_maps(Report& report, std::span<const ResidualView> views, const ResidualCoordinate& across,
                       const ResidualCoordinate& up, sim::DriveKind kind);

}  // namespace host
