#include "host/identify/smooth_acceleration.hpp"

#include "host/identify/zero_phase_filter.hpp"

namespace host {

std::vector<double> smooth_acceleration(const Record& record, const sim::DataSheet& data, double cutoff_Hz,
                                        bool by_speed, const std::vector<double>& speed) {
  std::vector<double> acceleration = central_difference(speed, record.sample_period_s);
  if (by_speed || !record.has_position()) return acceleration;
  const auto low_pass = ZeroPhaseLowPass::butterworth(cutoff_Hz, 1.0 / record.sample_period_s);
  const std::vector<double> x = low_pass(record.x);
  const double scale = data.lead * record.sample_period_s * record.sample_period_s;
  for (std::size_t k = 1; k + 1 < x.size(); ++k) acceleration[k] = (x[k + 1] - 2.0 * x[k] + x[k - 1]) / scale;
  return acceleration;
}

}  // namespace host
