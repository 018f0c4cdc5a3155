#include "host/identify/encoder_step.hpp"

#include <algorithm>
#include <cmath>

#include "host/record/position_grid.hpp"

namespace host {

double encoder_step(const Record& record, const sim::DataSheet& data) {
  if (data.encoder_resolution > 0.0) {
    const double own = position_grid(record.x);
    return own > kCoarser * data.encoder_resolution ? own : data.encoder_resolution;
  }
  double smallest = HUGE_VAL;
  for (std::size_t k = 1; k < record.x.size(); ++k) {
    const double step = std::abs(record.x[k] - record.x[k - 1]);
    if (step > 0.0) smallest = std::min(smallest, step);
  }
  return std::isfinite(smallest) ? smallest : 0.0;
}

}  // namespace host
