// The paper's commissioning of one axis: steps, least squares, design, jogs, friction curve.
#pragma once

#include <cstdint>

#include "firmware/core/axis_parameters.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/control_filters.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Identifies `machine` from experiments, without using its effects: inertia and viscous friction from open-loop steps
/// at Ku = 15 (p. 1499), the friction curve from jogs at the paper's eleven speeds (section 3.2).
sim::DriveDescription commission(const sim::DriveDescription& machine, std::uint64_t seed);

/// Only the open-loop steps: the paper's series of doublets times `scaling` (Ku of the paper).
Record commissioning_steps(const sim::DriveDescription& machine, double scaling, std::uint64_t seed);

struct CompensationSwitches {
  bool friction = false;
  bool cancellation = false;
  bool effects = true;  ///< compensate further effects of the model
};

/// Settings of a design that differ from the paper.
struct LoopTuning {
  double bandwidth_Hz = DesignOptions{}.bandwidth_Hz;
  ControlFilterChoice filters;
};

/// Board parameters from a model: pole placement and Kalman filter with the paper's values, ZPETC on.
firmware::AxisParameters<float> contouring_parameters(const sim::DriveDescription& model,
                                                      const CompensationSwitches& switches,
                                                      const ReferenceLimits& limits = {},
                                                      const LoopTuning& tuning = {});

}  // namespace host
