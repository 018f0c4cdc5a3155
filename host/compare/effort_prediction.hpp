// A record for the inverse model: the torque or force (effort) that its motion needed, and the motor's.
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
  std::vector<bool> counts;  ///< by row: the axis slides, and the filter has signal on both sides
  double floor;              ///< RMS torque or force due to sensor noise, Nm or N
};

/// `base` gives the inertia by which noise of the acceleration shows as effort. Throws Failure(bad_input) for a record
/// that is too short for the filter.
EffortRecord prepare_effort(const Record& record, const sim::DriveDescription& base);

/// One value per row, Nm or N; zeros within kMotionMargin of the ends.
struct EffortPrediction {
  std::vector<double> needed;  ///< of the motion, by the drive's model
  std::vector<double> given;   ///< of the motor, including the effects of the drive's command path
};

/// For a drive that has an inverse. `out` is resized if needed, so it can be reused.
void predict_effort(const sim::Drive& drive, const EffortRecord& prepared, EffortPrediction& out);

}  // namespace host
