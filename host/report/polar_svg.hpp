// The picture of a PolarPlot: SVG in the page, so that it needs no script and prints sharply.
#pragma once

#include <string>

#include "host/report/content.hpp"

namespace host::html {

/// A figure with a nominal circle of fixed size. Deviations are drawn outwards and inwards from it, magnified so that
/// the largest covers at most four rings. Labels give the distance between rings.
std::string polar_plot(const PolarPlot& plot);

}  // namespace host::html
