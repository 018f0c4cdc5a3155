// A design as the parameters of one axis (`axis-params/1`).
#pragma once

#include <string>
#include <vector>

#include "host/identify/axis_design.hpp"

namespace host {

/// Limits of references in mm (rotary) or m (linear) per s, s^2, s^3. Defaults, in mm: the paper, p. 1508, with a
/// velocity above its feed of 170 mm/s.
struct ReferenceLimits {
  double velocity = 250.0;
  double acceleration = 2000.0;
  double jerk = 50000.0;

  static ReferenceLimits usual_for(sim::DriveKind kind);
};

struct BoardParameter {
  std::string name;  ///< name in firmware/app/parameters/parameter_table.hpp, without the axis: "kalman.k11"
  double value;      ///< 0 or 1 for a switch
};

/// Drive, sampled model (7), Kalman gain (43), feedback (50), friction feed-forward (19), limits, monitors that depend
/// on the kind of drive; all compensations on.
/// Without a tachometer the second column of the Kalman gain is zero; without friction effects the levels are zero. The
/// tachometer's gain and offset are not included.
std::vector<BoardParameter> board_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                             const ReferenceLimits& limits);

/// The same as a TOML document with one table for each group, named after the axis (the model's name, or "x" if it has
/// none). Values have nine digits, which single precision on the board needs.
std::string board_parameters_toml(const sim::DriveDescription& model, const AxisDesign& design,
                                  const ReferenceLimits& limits);
/// With the usual limits.
std::string board_parameters_toml(const sim::DriveDescription& model, const AxisDesign& design);

}  // namespace host
