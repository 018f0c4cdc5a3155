// Colours with one meaning in every figure, which colour-blind readers can distinguish.
#pragma once

#include "host/report/content.hpp"

namespace host {

/// CSS colour of a role. The palette is that of Okabe and Ito, "Color Universal Design", 2008, with greys.
const char* series_colour(SeriesRole role);

}  // namespace host
