// The number type of this image's control core.
#pragma once

#ifdef AXIS_SCALAR_FIXED
#include "firmware/core/arithmetic/fixed_point.hpp"
#endif

namespace firmware::boards {

#ifdef AXIS_SCALAR_FIXED
using BoardScalar = FixedPoint;
#else
using BoardScalar = float;
#endif

}  // namespace firmware::boards
