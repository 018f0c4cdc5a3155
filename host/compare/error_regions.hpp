// Regions in which a model fails: shares of the squared prediction error by motion, position, speed, and time.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Share of the squared error and share of the samples of one region. Shares sum to 1 over the regions of a partition.
struct ErrorRegion {
  std::string partition;  ///< regime, direction, speed, position, place, order, time, rest, frequency, event
  std::string region;     ///< "reversal", "120..140 mm"
  std::string words;      ///< to follow "the model fails": "in the first 50 um after a reversal"
  double share = 0.0;     ///< 0..1
  double portion = 0.0;   ///< share of the samples (frequency: of the spectrum; order: 0), 0..1
  double rms = 0.0;       ///< RMS error over noise floor; about 1 if perfect. Order: RMS torque or force
  /// Share of the sum of error magnitudes, 0..1. For a single large event it is smaller than the share of the squares.
  double prevalence = 0.0;
};

/// Errors of `model` on every used window of `set` over the noise floor of the window, for all measured channels. Two
/// partitions have their own measure: "order" uses the squared residual of the inverse model, because prediction errors
/// blur periodic effects over a window; "frequency" uses the spectrum of the windows' errors. A partition that the
/// records cannot show (no motion, no position) is left out.
std::vector<ErrorRegion> error_regions(const sim::DriveDescription& model, const RecordSet& set);

/// The region with the most error in the fewest samples; null if all errors are at the noise floor. Uses the magnitude
/// of the error, because with the square one late breakaway would outweigh recurring errors. The share of the square,
/// which is the one in the text, must also exceed that of the samples.
const ErrorRegion* worst_region(const std::vector<ErrorRegion>& regions);

/// "the model fails in the first 50 µm after a reversal (41 % of the squared error in 3 % of the samples)".
std::string where_it_fails(const std::vector<ErrorRegion>& regions);

/// The array "where".
nlohmann::json error_regions_json(const std::vector<ErrorRegion>& regions);

}  // namespace host
