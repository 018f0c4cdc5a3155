// A curve where no formula fits: straight between as many knots as the rows that judge pay for.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/effort/effort_screen.hpp"

namespace host {

struct FreeCurveFit {
  std::string over;
  std::size_t knots = 0;
  double period = 0.0;  ///< mm or m; 0 where it does not come back
  ScreenedModel model;  ///< the screen's best model with the curve added
};

/// Fits what the screen's best model leaves as a curve over a coordinate (sim::kCurveCoordinates), or over the one that
/// judges best where `over` is empty. Nothing where no curve lowers the error of the rows that judge.
std::optional<FreeCurveFit> fit_free_curve(const EffortScreen& screen, std::string_view over = {});

}  // namespace host
