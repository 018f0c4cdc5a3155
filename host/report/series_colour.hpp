// Colours with one meaning in every figure, distinguishable for colour-blind readers.
#pragma once

#include "host/report/content.hpp"

namespace host {

/// CSS colour of a role; the palette is that of Okabe and Ito, "Color Universal Design", 2008, with greys.
const char* series_colour(SeriesRole role);

}  // namespace host
