// How far a process force moves a controlled axis.
#pragma once

#include "host/identify/linear_axis.hpp"
#include "host/response/axis_controller.hpp"
#include "host/response/loop_margins.hpp"

namespace host {

/// Dynamic compliance: amplitude of the position per amplitude of a sinusoidal force on the table, µm/N, at the
/// frequency where it is largest. Its reciprocal is the least dynamic stiffness.
struct Compliance {
  double um_per_N = 0.0;
  double at_Hz = 0.0;
};

/// Over the frequencies of `drive`. A force acts like a command that the controller does not know, eqs. (2) and (4) of
/// the paper, so the response is P / (1 + L), with P the position per volt. `axis` converts volts into force.
Compliance largest_compliance(const FinePlant& drive, const AxisController& controller, const RigidAxis& axis,
                              sim::DriveKind kind);

}  // namespace host
