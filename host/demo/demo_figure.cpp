#include "host/demo/demo_figure.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/report/text_format.hpp"

namespace host {

DemoFigure within_fraction(std::string what, double found, double truth, double tolerance) {
  const double margin = tolerance * std::abs(truth);
  return {std::move(what), found, truth - margin, truth + margin,
          fmt::format("{} ± {:g} %", format_value(truth, 4), 100.0 * tolerance)};
}

DemoFigure at_most(std::string what, double found, double limit) {
  return {std::move(what), found, 0.0, limit, "at most " + format_value(limit, 4)};
}

}  // namespace host
