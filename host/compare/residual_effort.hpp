// Torque or force missing in a model's predictions (residual), with the coordinates of the motion.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Averages over 5 ms, which is what the smoother resolves, of the samples that move. All vectors of one length.
struct ResidualEffort {
  double period_s = 0.005;
  std::vector<std::size_t> record, slot;  ///< the record, and the average's place in it in periods
  std::vector<std::size_t> window;        ///< counted through all records
  std::vector<double> missing;            ///< Nm or N
  std::vector<double> t_s;                ///< since the start of the record
  std::vector<double> x, w, acceleration;
  std::vector<double> command_V;
  std::vector<double> since_reversal;  ///< travel since the last reversal, mm or m; negative in backward motion
  std::vector<double> rest_s;          ///< how long the axis had stood before this motion
  std::vector<double> temp_C;          ///< empty unless every record has it
};

/// What the smoothed motion accelerates beyond the predicted one, times the inertia. Unlike the inverse model's, it is
/// there for any model: bristles, gaps and second masses move as they do in a prediction.
ResidualEffort residual_effort(const sim::DriveDescription& model, const RecordSet& set);

/// What the speed channel reads beyond the smoothed motion that the position shows, rad/s or m/s, in the place of the
/// effort; empty where a record lacks one of the two.
ResidualEffort residual_of_speed_channel(const sim::DriveDescription& model, const RecordSet& set);

}  // namespace host
