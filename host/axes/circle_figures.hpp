// Terms of ISO 230-4 for turns of a circle.
#pragma once

#include <optional>
#include <vector>

#include "host/axes/circle_diagnosis.hpp"

namespace host {

std::vector<CircleFigures> circle_figures(const std::vector<CirclePass>& passes);

/// Figures at the feed with the largest difference of the directions; empty if no feed has both directions.
std::optional<BidirectionalFigures> bidirectional_figures(const std::vector<CirclePass>& passes);

}  // namespace host
