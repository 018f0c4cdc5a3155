// The picture of a PolarPlot: SVG within the page, so that it needs no script and prints sharply.
#pragma once

#include <string>

#include "host/report/content.hpp"

namespace host::html {

/// A figure. The nominal circle has a fixed size. Deviations are drawn outwards and inwards from it, magnified so that
/// the largest takes at most four rings; labels give the distance between rings.
std::string polar_plot(const PolarPlot& plot);

}  // namespace host::html
