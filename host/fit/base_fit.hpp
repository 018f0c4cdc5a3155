// Fit of the base before any effect is added.
#pragma once

#include "host/compare/comparison.hpp"

namespace host {

/// Fits the base from several starts, because a refit stuck in a local minimum causes false discoveries.
sim::DriveDescription fit_base(const sim::DriveDescription& given, const RecordSet& training);

}  // namespace host
