// Designs a controller on the measured response: the highest bandwidth that keeps the margin, with a notch if it helps.
#pragma once

#include <optional>
#include <vector>

#include "host/identify/axis_design.hpp"
#include "host/parameters/control_filters.hpp"
#include "host/response/axis_response.hpp"

namespace host {

/// Requirements on the loop with the measured response.
struct LoopAim {
  std::optional<double> modulus;       ///< modulus margin to keep; if empty, the bandwidth is that of `options`
  std::optional<double> crossover_Hz;  ///< largest crossover frequency of the open loop
  bool seek_notch = false;             ///< place a notch at the resonance where it raises the bandwidth most
  ControlFilterChoice filters;         ///< filters given by the user
};

struct LoopDesign {
  AxisDesign design;
  ControlFilterChoice filters;
  AxisResponse before;  ///< the measured response with the controller of the design's options
  AxisResponse after;
};

/// A drive on which controllers are tried.
struct LoopTask {
  const sim::DriveDescription& model;
  const DesignOptions& options;  ///< all except the bandwidth
  const FinePlant& drive;
};

struct HighestLoop {
  double bandwidth_Hz = 0.0;              ///< 0 if no bandwidth meets the requirements
  double best_modulus = 0.0;              ///< largest over all bandwidths tried; of several drives, the smallest
  std::vector<std::size_t> stopped_by{};  ///< every drive that fails at the next bandwidth, in ascending order
};

/// Ratio of neighbouring bandwidths that highest_bandwidth() tries.
inline constexpr double kBandwidthStep = 1.04;

/// The upper end of the widest range of bandwidths, in ratio, in which all drives meet the requirements with these
/// filters. In a narrow range beyond a gap, a small change of the drive would fall into the gap. A narrow range below a
/// gap comes from the lowest measured frequencies, at which friction and cogging disturb the response.
HighestLoop highest_bandwidth(const std::vector<LoopTask>& drives, const LoopAim& aim,
                              const ControlFilterChoice& filters);

/// All combinations of filters to try on a drive.
std::vector<ControlFilterChoice> filter_choices(const LoopAim& aim, const PlantFit& fit, double sample_period_s);

/// Raises the natural frequency of the closed loop's poles (DesignOptions::bandwidth_Hz) as far as the requirements
/// allow; everything else is as in `options`. Throws Failure(refused), naming the best modulus margin, if no bandwidth
/// keeps the margin, and what design_axis() throws.
LoopDesign design_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                       const AxisResponse& measured);

}  // namespace host
