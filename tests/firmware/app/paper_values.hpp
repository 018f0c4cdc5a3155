// The paper's x axis as a set of parameter values, and setting values by name.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

#include "firmware/app/parameters/parameter_values.hpp"
#include "tests/firmware/fitted_axis.hpp"

namespace firmware_test {

/// "x.kalman.k11", "control.rate". Throws for an unknown name.
inline std::size_t place_named(std::string_view name) {
  if (const auto of_board = find_place("", name)) return *of_board;
  const std::size_t dot = std::min(name.find('.'), name.size() - 1);
  if (const auto of_axis = find_place(name.substr(0, dot), name.substr(dot + 1))) return *of_axis;
  throw std::invalid_argument("no parameter " + std::string(name));
}

inline void set(firmware::ParameterValues& values, std::string_view name, double value) {
  values.set(place_named(name), static_cast<float>(value));
}

inline firmware::ParameterValues paper_values(std::size_t axes = hal::kAxisCount) {
  firmware::ParameterValues values(axes);
  fit_axis(values, "x", kPaperX);
  return values;
}

}  // namespace firmware_test
