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

/// A drive on which controllers are tried.
struct LoopTask {
  const sim::DriveDescription& model;
  const DesignOptions& options;  ///< all but the bandwidth
  const FinePlant& drive;
};

struct HighestLoop {
  double bandwidth_Hz = 0.0;  ///< 0 where none keeps the aim
  double best_modulus = 0.0;  ///< the largest of all bandwidths that were tried; of several drives, the least
  std::optional<std::size_t> stopped_by{};  ///< which drive does not keep the aim at the next bandwidth
};

/// The highest bandwidth at which all drives keep the aim with these filters.
HighestLoop highest_bandwidth(const std::vector<LoopTask>& drives, const LoopAim& aim,
                              const ControlFilterChoice& filters);

/// Every set of filters that is worth a try on a drive.
std::vector<ControlFilterChoice> filter_choices(const LoopAim& aim, const PlantFit& fit, double sample_period_s);

/// Raises the natural frequency of the closed loop's poles (DesignOptions::bandwidth_Hz) as far as the aim allows;
/// `options` stand for all else. Throws Failure(refused)
/// where no bandwidth keeps the margin, naming the best that there is, and what design_axis() throws.
LoopDesign design_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                       const AxisResponse& measured);

}  // namespace host
