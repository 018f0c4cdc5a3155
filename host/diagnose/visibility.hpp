// What records could have shown: whether an effect of usual size would have left a trace that a re-fit of the base
// cannot take up. Where it would not, that nothing was found tells nothing about it.
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

/// A trace of so many floors turns a complete model's error of 1 into 1.25.
inline constexpr double kVisible = 0.75;

/// Every effect of the catalogue that can be added to `base`, at the sizes that fits start from (for ripples: a usual
/// amplitude once a turn), by its most visible size. To first order in the base's parameters. On some 100 windows of
/// each set.
std::vector<Visibility> visibility_of_effects(const sim::DriveDescription& base, const RecordSet& training,
                                              const RecordSet& validation);

}  // namespace host
