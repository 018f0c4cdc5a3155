// The terms of ISO 230-4, of turns of a circle.
#pragma once

#include <optional>
#include <vector>

#include "host/axes/circle_diagnosis.hpp"

namespace host {

std::vector<CircleFigures> circle_figures(const std::vector<CirclePass>& passes);

/// Of the feed at which both directions differ most; nothing without both at one feed.
std::optional<BidirectionalFigures> bidirectional_figures(const std::vector<CirclePass>& passes);

}  // namespace host
