// Tests whether a model's residual depends on a coordinate of the motion, on time or on frequency, by curves fitted to
// half of the data and validated on the other half. Significance alone is not sufficient: with 25,000 samples every
// model of a real machine fails a whiteness test. The criterion is the share of the residual that a dependence explains
// in the other half.
#pragma once

#include <string>
#include <vector>

#include "host/compare/residual_effort.hpp"

namespace host {

/// The part of the residual that depends on one coordinate.
struct ResidualDependence {
  /// speed, position, travel_since_reversal, acceleration, current, rest, temperature, time, frequency
  std::string coordinate;
  std::string where;  ///< range of it, after the word "most": "at speeds between 3 and 6 rad/s", "at 48.0 Hz"
  /// Part of the squared residual of all data that curves explain in blocks to which they were not fitted, 0..1. Tested
  /// as a torque or force, and as friction that changes sign with the direction; the larger value counts. Frequency:
  /// the smaller value of both sets, at the same line. Time: the larger value, because a single event occurs in only
  /// one of the sets.
  double share = 0.0;
  /// The same with finer bins, used only to name a coordinate: speeds after rests of one duration, the first
  /// micrometres after a reversal, time over whole records.
  double in_detail = 0.0;
};

/// A correlation function with its 99 % bound for a white residual.
struct Correlation {
  std::vector<double> lag_s, value;
  double bound = 0.0;
};

struct ResidualTests {
  std::vector<ResidualDependence> dependences;  ///< largest share first
  Correlation with_itself;                      ///< autocorrelation of the residual on validation data
  Correlation with_command;                     ///< correlation of the residual with earlier and later commands
  double constant = 0.0;                        ///< share explained by a constant, or by a constant times the direction
  double rms = 0.0;                             ///< RMS torque or force residual on validation data, Nm or N
  /// Part of the squared residual of all data in the quarter of the samples closest to a reversal. An effect that
  /// decays within micrometres gives no curve over the travel at 5 ms, but it shows in these samples.
  double near_reversals = 0.0;
  std::string where_near_reversals;  ///< after the word "most"
};

/// The lists are empty if the axis hardly moves in one of the sets.
ResidualTests test_residuals(const sim::DriveDescription& model, const RecordSet& training,
                             const RecordSet& validation);

/// The same for the speed channel minus the speed of the position; empty if one of the two channels is missing.
ResidualTests test_speed_channel(const sim::DriveDescription& model, const RecordSet& training,
                                 const RecordSet& validation);

}  // namespace host
