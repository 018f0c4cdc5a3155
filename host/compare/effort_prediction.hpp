// A record for the inverse model: the torque or force that its motion needed, and that of the motor.
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
  std::vector<bool> counts;  ///< per row: true if the axis slides and the filter has signal on both sides
  double floor;              ///< RMS torque or force due to sensor noise, Nm or N
};

/// `base` gives the inertia that converts acceleration noise to torque or force. Throws Failure(bad_input) for a record
/// that is too short for the filter.
EffortRecord prepare_effort(const Record& record, const sim::DriveDescription& base);

/// One value per row, Nm or N; zeros within kMotionMargin of the ends.
struct EffortPrediction {
  std::vector<double> needed;  ///< torque or force that the model needs for the motion
  std::vector<double> given;   ///< torque or force of the motor, after the effects of the command path
};

/// Needs a drive that has an inverse. `out` is resized if needed, so it can be reused.
void predict_effort(const sim::Drive& drive, const EffortRecord& prepared, EffortPrediction& out);

}  // namespace host
