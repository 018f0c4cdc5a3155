// A free curve for an effect without a formula: piecewise linear, with as many knots as the validation rows support.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/effort/effort_screen.hpp"

namespace host {

struct FreeCurveFit {
  std::string over;
  std::size_t knots = 0;
  double period = 0.0;  ///< mm or m; 0 if it does not repeat
  ScreenedModel model;  ///< best model of the screen, with the curve added
};

/// Fits the residual of the best model as a curve over the coordinate `over` (sim::kCurveCoordinates), or over the best
/// coordinate in validation if it is empty. Empty if no curve lowers the validation error.
std::optional<FreeCurveFit> fit_free_curve(const EffortScreen& screen, std::string_view over = {});

}  // namespace host
