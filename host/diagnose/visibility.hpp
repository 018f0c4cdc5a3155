// Which effects the records can show: whether an effect of usual size leaves a residual that a refit of the base cannot
// absorb. If not, the absence of a finding says nothing about it.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// The trace of one effect of usual size.
struct Visibility {
  std::string kind;
  double floors = 0.0;  ///< RMS over floor that the effect adds to a complete base, after a re-fit of the base
};

/// An effect of this many noise floors raises a complete model's error from 1 to 1.25.
inline constexpr double kVisible = 0.75;

/// Every effect of the catalogue that can be added to `base`, at the sizes that fits start from (for ripples: a usual
/// amplitude once a turn), by its most visible size. To first order in the base's parameters. On some 100 windows of
/// each set.
std::vector<Visibility> visibility_of_effects(const sim::DriveDescription& base, const RecordSet& training,
                                              const RecordSet& validation);

}  // namespace host
