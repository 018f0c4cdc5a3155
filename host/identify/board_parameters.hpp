// What a board needs to know of an axis: the design and the friction curve as named parameters (`axis-params/1`).
#pragma once

#include <string>
#include <vector>

#include "host/identify/axis_design.hpp"

namespace host {

struct BoardParameter {
  std::string name;  ///< dotted, without the axis: "kalman.k11"
  double value;
  std::string unit;  ///< "" where it has none
  std::string doc;   ///< one line
};

/// Parameters of one axis: drive, sampled model (7), Kalman gain (43), feedback (50), friction feed-forward (19).
/// Without a tachometer the second column of the Kalman gain is zero; without friction effects the levels are zero.
std::vector<BoardParameter> board_parameters(const sim::DriveDescription& model, const AxisDesign& design);

/// The same as a TOML document with one table a group, named after the axis (the model's name, "x" when it has none).
/// Values carry nine digits: as many as single precision on the board can tell apart.
std::string board_parameters_toml(const sim::DriveDescription& model, const AxisDesign& design);

}  // namespace host
