// Which effects the records can show: whether an effect of usual size leaves a residual that a refit of the base cannot
// absorb. If not, the effect may be present although it was not found.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// The residual that one effect of usual size leaves.
struct Visibility {
  std::string kind;
  double floors = 0.0;  ///< RMS over floor that the effect adds to a complete base, after a re-fit of the base
};

/// An effect that adds this to the error over noise floor raises the error of a complete model from 1 to 1.25.
inline constexpr double kVisible = 0.75;

/// Every effect of the catalogue that can be added to `base`, with the most visible of the sizes from which fits start
/// (for ripples: a usual amplitude once per turn). Linearised in the parameters of the base. Uses some 100 windows of
/// each set.
std::vector<Visibility> visibility_of_effects(const sim::DriveDescription& base, const RecordSet& training,
                                              const RecordSet& validation);

}  // namespace host
