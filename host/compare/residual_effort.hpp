// Torque or force that is missing in a model's predictions (residual), with the coordinates of the motion.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Averages over 5 ms, the resolution of the smoother, of the samples in motion. All vectors have the same length.
struct ResidualEffort {
  double period_s = 0.005;
  std::vector<std::size_t> record, slot;  ///< the record, and the number of the period in it
  std::vector<std::size_t> window;        ///< number of the window, counted over all records
  std::vector<double> missing;            ///< Nm or N
  std::vector<double> t_s;                ///< time since the start of the record
  std::vector<double> x, w, acceleration;
  std::vector<double> command_V;
  std::vector<double> since_reversal;  ///< travel since the last reversal, mm or m; negative in backward motion
  std::vector<double> rest_s;          ///< duration of the rest before this motion, s
  std::vector<double> temp_C;          ///< empty if a record has none
};

/// Acceleration of the smoothed motion minus that of the prediction, times the inertia. In contrast to the residual of
/// the inverse model, it exists for every model, because bristles, gaps and second masses move as in a prediction.
ResidualEffort residual_effort(const sim::DriveDescription& model, const RecordSet& set);

/// Speed channel minus the speed of the smoothed position, rad/s or m/s, instead of torque or force. Empty if a record
/// lacks one of the two channels.
ResidualEffort residual_of_speed_channel(const sim::DriveDescription& model, const RecordSet& set);

}  // namespace host
