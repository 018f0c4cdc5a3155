#include "host/evidence/measured_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/identify/encoder_step.hpp"

namespace host {

namespace {

/// Smallest step that counts as an encoder step, mm or m; computed positions have none.
constexpr double kFinestStep = 1e-9;

/// Variance of white noise from second differences (factor 1 + 4 + 1 = 6), which motion hardly affects.
double noise_variance(const std::vector<double>& values) {
  double squares = 0.0;
  for (std::size_t k = 2; k < values.size(); ++k)
    squares += std::pow(values[k] - 2.0 * values[k - 1] + values[k - 2], 2);
  return values.size() < 3 ? 0.0 : squares / 6.0 / static_cast<double>(values.size() - 2);
}

}  // namespace

sim::DriveDescription with_measured_sensors(const sim::DriveDescription& model, const Measurements& measured) {
  return with_measured_sensors(model, measured.training_records());
}

sim::DriveDescription with_measured_sensors(const sim::DriveDescription& model,
                                            const std::vector<const Record*>& records) {
  sim::DriveDescription complete = model;
  double finest = HUGE_VAL;
  for (const Record* record : records)
    if (const double step = encoder_step(*record, model.data); step > 0.0) finest = std::min(finest, step);
  if (std::isfinite(finest))
    complete.data.encoder_resolution = std::max(finest, kFinestStep);
  else if (!(complete.data.encoder_resolution > 0.0))
    complete.data.encoder_resolution = kFinestStep;
  if (!complete.data.tach_noise_variance) {
    double variance = 0.0;
    for (const Record* record : records)
      if (record->has_speed()) variance = std::max(variance, noise_variance(record->w));
    if (variance > 0.0) complete.data.tach_noise_variance = variance;
  }
  return complete;
}

}  // namespace host
