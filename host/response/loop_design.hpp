// A controller designed on the measured response: as much bandwidth as the margin allows, with a notch where it helps.
#pragma once

#include <optional>
#include <vector>

#include "host/identify/axis_design.hpp"
#include "host/parameters/control_filters.hpp"
#include "host/response/axis_response.hpp"

namespace host {

/// What the loop shall reach on the measured response.
struct LoopAim {
  std::optional<double> modulus;       ///< modulus margin to keep; without it the bandwidth of `options` stands
  std::optional<double> crossover_Hz;  ///< of the open loop, at most
  bool seek_notch = false;             ///< at the resonance for which it gains most
  ControlFilterChoice filters;         ///< that are given
};

struct LoopDesign {
  AxisDesign design;
  ControlFilterChoice filters;
  AxisResponse before;  ///< the measured response with the design's options alone
  AxisResponse after;
};

/// Raises the natural frequency of the closed loop's poles (DesignOptions::bandwidth_Hz) as far as the aim allows;
/// `options` stand for all else. Throws Failure(refused)
/// where no bandwidth keeps the margin, naming the best that there is, and what design_axis() throws.
LoopDesign design_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                       const AxisResponse& measured);

}  // namespace host
