// Turns of a circle at a steady feed, found in records of two axes.
#pragma once

#include <string>
#include <vector>

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
  double lag_s = 0.0;     ///< by which the encoders lag the references along the circle; 0 without references
  double count_um = 0.0;  ///< the encoders' step
  OuterSensor outer = OuterSensor::none;
  bool has_reference = false;
  std::vector<double> t_s, angle_rad;  ///< from +X, counter-clockwise, by the encoders
  std::vector<double> encoder_um;      ///< radial deviation of the encoders
  std::vector<double> outer_um;        ///< of the outer sensor; empty without one

  double turn_rad_s() const { return feed_mm_s / radius_mm; }
  double direction() const { return is_ccw ? 1.0 : -1.0; }
};

/// Records of both axes in one (x_mm, y_mm, with x_ref_mm, y_ref_mm where references were logged: what `run --capture`
/// writes), or a record of axis x and one of axis y each (`# drive: x`, `# drive: y`: what `hil -o` writes), paired in
/// their order. Outer sensors: columns x2_mm and y2_mm (or x2_mm in both records of a pair), or a ballbar's radius_mm
/// (its length or what it deviates by) or radius_um. Throws Failure(bad_input) naming the record and what it lacks;
/// refused where no turn at a steady feed is found; usage for more stretches than make sense.
std::vector<CirclePass> circle_passes(const std::vector<Record>& records);

}  // namespace host
