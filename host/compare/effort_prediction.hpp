// A record for the inverse model: the torque or force (effort) that its motion needed, and that of the motor.
#pragma once

#include <vector>

#include "host/identify/motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The motion of a record, filtered once for all models. Refers to the record, which must outlive it.
struct EffortRecord {
  const Record* record;
  sim::DataSheet data;
  Motion motion;
  std::vector<bool> counts;  ///< by row: it slides, and the filter has signal on both sides
  double floor;              ///< RMS error that the sensor's own noise makes, Nm or N
};

/// `base` gives the inertia by which noise of the acceleration shows as effort. Throws Failure(bad_input) for a record
/// that is too short for the filter.
EffortRecord prepare_effort(const Record& record, const sim::DriveDescription& base);

/// One value a row, Nm or N; zeros within kMotionMargin of the ends.
struct EffortPrediction {
  std::vector<double> needed;  ///< by the motion, as the drive explains it
  std::vector<double> given;   ///< by the motor, after what the drive's command path does
};

/// For a drive that has an inverse. `out` is resized when needed, so that it can be used again.
void predict_effort(const sim::Drive& drive, const EffortRecord& prepared, EffortPrediction& out);

}  // namespace host
