// The picture of a PolarPlot: SVG within the page, so that it needs no script and prints sharply.
#pragma once

#include <string>

#include "host/report/content.hpp"

namespace host::html {

/// A figure. The nominal circle has a fixed size; deviations are drawn outwards and inwards from it, magnified until
/// the largest takes four rings at most, and the rings say how far apart they are.
std::string polar_plot(const PolarPlot& plot);

}  // namespace host::html
