// Tests whether a model's residual depends on a coordinate of the motion, on time or on frequency, by curves fitted to
// half of the data and validated on the other half. Significance alone is no test: with 25,000 samples every model of a
// real machine fails a whiteness test. The criterion is the share of the residual that a dependence explains in the
// other half.
#pragma once

#include <string>
#include <vector>

#include "host/compare/residual_effort.hpp"

namespace host {

/// The part of the residual that depends on one coordinate.
struct ResidualDependence {
  /// speed, position, travel_since_reversal, acceleration, current, rest, temperature, time, frequency
  std::string coordinate;
  std::string where;  ///< where along it, to follow "most": "at speeds between 3 and 6 rad/s", "at 48.0 Hz"
  /// Tested as a torque or force, and as friction that changes sign with the direction; the larger dependence counts.
  /// Part of the squared residual of all data that curves remove from blocks to which they were not fitted, 0..1.
  /// Frequency: the smaller part of both sets, at the same line. Time: the larger part, since a single event occurs in
  /// only one of the sets.
  double share = 0.0;
  /// The same with finer bins, used only to name a coordinate: speeds after rests of one length, the first micrometres
  /// after a reversal, time over whole records.
  double in_detail = 0.0;
};

/// A correlation function, with the bound that 99 of 100 values of a white residual do not exceed.
struct Correlation {
  std::vector<double> lag_s, value;
  double bound = 0.0;
};

struct ResidualTests {
  std::vector<ResidualDependence> dependences;  ///< largest share first
  Correlation with_itself;                      ///< of the residual on validation data
  Correlation with_command;                     ///< of the residual with earlier and later commands
  double constant = 0.0;  ///< share that a constant explains, with the sign of the motion or without
  double rms = 0.0;       ///< of the residual effort on validation data, Nm or N
  /// Part of the squared residual of all data in the quarter of the samples that is closest after a reversal. An effect
  /// that fades within micrometres gives no curve over the travel at 5 ms, but it shows in these samples.
  double near_reversals = 0.0;
  std::string where_near_reversals;  ///< to follow "most"
};

/// The lists are empty where the axis hardly moves in one of the sets.
ResidualTests test_residuals(const sim::DriveDescription& model, const RecordSet& training,
                             const RecordSet& validation);

/// The same for the speed channel minus the speed of the position; empty without one of the two channels.
ResidualTests test_speed_channel(const sim::DriveDescription& model, const RecordSet& training,
                                 const RecordSet& validation);

}  // namespace host
