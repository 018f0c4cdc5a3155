// Prediction errors of a model, as every command prints them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Errors of one measured channel over the windows of a record set.
struct ChannelFigures {
  std::string name;          ///< column in the drive's own units: x_mm, w_rad_s, x_m, v_m_s
  std::string unit;          ///< unit of rms and floor
  double rms = 0.0;          ///< RMS of prediction minus measurement
  double fit_percent = 0.0;  ///< 100 (1 - |error| / |measured - mean|); 100 is perfect, 0 as good as the mean
  /// rms over the RMS of the signal that the model must explain. That is the measured speed for a speed channel, and
  /// the travel since the restart of the window for a position channel. Empty if the signal is zero.
  std::optional<double> share = {};
  double floor = 0.0;  ///< RMS noise floor: error of a perfect model, due to sensors and restart

  double over_floor() const { return floor > 0.0 ? rms / floor : 0.0; }
};

/// Errors of one model on one record or record set, over its own noise floors.
struct ErrorFigures {
  double window_s = kWindow_s;
  std::vector<ChannelFigures> channels;  ///< speed, then position, if measured
  double combined = 0.0;                 ///< SetError::combined: about 1 for a perfect model

  /// The channel with the largest ratio of error to noise floor; null if nothing was measured.
  const ChannelFigures* worst() const;
};

/// A record and the windows in use.
struct FigureRecord {
  const Record* record;
  std::optional<std::vector<Window>> windows = {};  ///< of equal length; if empty, as many as fit into the record
};

/// Prepares the records for the figures of `model`, which smooths the motion and gives the noise floors. Missing sensor
/// properties of the data sheet come from each record itself. Keeps references to the records. Throws as prepare()
/// does.
RecordSet figure_set(const sim::DriveDescription& model, const std::vector<FigureRecord>& records, double window_s);

/// Figures of a set from `error`, the result of its error_of(); if `record` is given, of that record only.
ErrorFigures figures_of(const SetError& error, const RecordSet& set, std::optional<std::size_t> record = {});

/// figures_of() for the model on the figure_set() of the records.
ErrorFigures error_figures(const sim::DriveDescription& model, const std::vector<FigureRecord>& records,
                           double window_s = kWindow_s);

/// { "measure": "motion", "window_s", "channels": { NAME: { "unit", "rms", "share", "floor", "over_floor" } },
/// "combined" }
nlohmann::json to_json(const ErrorFigures& figures);

}  // namespace host
