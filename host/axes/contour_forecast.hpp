// Contour errors of lines and circles if two axes follow differently: the linear part, from their frequency responses.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "host/parameters/board_parameters.hpp"
#include "host/response/axis_controller.hpp"
#include "host/response/plant_fit.hpp"

namespace host {

/// A drive with its controller.
struct ServoAxis {
  PlantFit plant;
  AxisController controller;
};

/// Frequency response from reference to travel, sampled.
std::complex<double> following(const ServoAxis& axis, double f_Hz);

/// Errors at one feed due to the difference of two axes, without friction and noise.
struct FeedContour {
  double feed_mm_s = 0.0;
  double line_45_um = 0.0;  ///< largest distance from a line at 45 degrees, including acceleration and deceleration
  double ellipse_um = 0.0;  ///< difference between the half axes of the ellipse that results from a circle
};

inline constexpr double kForecastRadius_mm = 35.0;  // the paper's circle, p. 1508

/// `limits`, in mm: the motion along lines keeps them.
FeedContour contour_forecast(const ServoAxis& x, const ServoAxis& y, double feed_mm_s, const ReferenceLimits& limits);

/// For a line at 45 degrees: the property whose difference between the drives causes most of the error; empty if the
/// error is below 0.1 um or no property causes half of it.
std::string main_difference(const ServoAxis& x, const ServoAxis& y, double feed_mm_s, const ReferenceLimits& limits);

}  // namespace host
