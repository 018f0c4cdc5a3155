// Where a model fails: shares of the squared prediction error by motion, position, speed, and time.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// A share of the samples and its share of the squared error. Shares sum to 1 over the regions of a partition.
struct ErrorRegion {
  std::string partition;  ///< regime, direction, speed, position, place, order, time, rest, frequency, event
  std::string region;     ///< "reversal", "120..140 mm"
  std::string words;      ///< to follow "the model fails": "in the first 50 um after a reversal"
  double share = 0.0;     ///< 0..1
  double portion = 0.0;   ///< of the samples (frequency: of the spectrum; order: none, 0), 0..1
  double rms = 0.0;       ///< error over floor, RMS; about 1 for a perfect model. Order: RMS effort, Nm or N
  /// Share of the error's magnitude, 0..1: a single large event has a smaller share of it than of the squares.
  double prevalence = 0.0;
};

/// Errors of `model` on every used window of `set`, in units of each window's floor, over all measured channels. Two
/// partitions have their own measure: "order" uses the squared residual of the inverse model (prediction errors blur
/// periodic effects over a window), "frequency" the spectrum of the windows' errors. A partition that the records
/// cannot show (no motion, no position) is absent.
std::vector<ErrorRegion> error_regions(const sim::DriveDescription& model, const RecordSet& set);

/// The region with the most error in the fewest samples, or nullptr if all error is at the noise floor. Uses the
/// error's magnitude, because with its square one late breakaway would hide recurring errors.
const ErrorRegion* worst_region(const std::vector<ErrorRegion>& regions);

/// "most of the error lives in the first 50 um after a reversal (41 % of it, 3 % of the time)".
std::string where_it_fails(const std::vector<ErrorRegion>& regions);

/// The array "where".
nlohmann::json error_regions_json(const std::vector<ErrorRegion>& regions);

}  // namespace host
