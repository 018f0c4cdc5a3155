// Turns of a circle at a steady feed, found in records of two axes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "host/axes/circle_rests.hpp"
#include "host/record/record.hpp"

namespace host {

/// Sensor at the table, in addition to the motors' encoders.
enum class OuterSensor { none, scales, ballbar };

/// One range at a steady feed in one direction, with consecutive rows.
struct CirclePass {
  std::string source;  ///< the record's name
  bool is_ccw = true;
  double feed_mm_s = 0.0;
  double radius_mm = 0.0;
  double period_s = 0.0;
  double lag_s = 0.0;     ///< lag of the encoders behind the references along the circle; 0 without references
  double count_um = 0.0;  ///< encoder step
  OuterSensor outer = OuterSensor::none;
  bool has_reference = false;
  std::vector<double> t_s, angle_rad;  ///< from +X, counter-clockwise, by the encoders
  std::vector<double> encoder_um;      ///< radial deviation of the encoders
  std::vector<double> outer_um;        ///< radial deviation of the outer sensor; empty without one
  std::array<AxisRests, 2> rests;      ///< of x and y

  double turn_rad_s() const { return feed_mm_s / radius_mm; }
  double direction() const { return is_ccw ? 1.0 : -1.0; }
};

/// Accepts records with both axes (x_mm, y_mm, optionally x_ref_mm, y_ref_mm: the output of `run --capture`), or pairs
/// of records of axis x and axis y (`# drive: x`, `# drive: y`: the output of `hil -o`), paired in their order. Outer
/// sensors: columns x2_mm and y2_mm (or x2_mm in both records of a pair), or a ballbar's radius_mm or radius_um (its
/// length or its deviation). Throws Failure(bad_input) naming the record and the missing channel; refused if no turn at
/// a steady feed is found; usage if there are too many passes.
std::vector<CirclePass> circle_passes(const std::vector<Record>& records);

}  // namespace host
