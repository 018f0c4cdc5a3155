#include "host/compare/free_run.hpp"

#include <cmath>

#include "sim/drive.hpp"

namespace host {

std::optional<double> free_run_rms(const sim::DriveDescription& model, const PreparedRecord& prepared) {
  const Record& record = *prepared.record;
  if (!record.has_position() || record.size() < 2 * kGivenSamples) return {};
  const sim::Drive drive(model);
  // The speed is the slope of a straight line through the given samples, which may be equal.
  const double middle = 0.5 * static_cast<double>(kGivenSamples - 1);
  double product = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < kGivenSamples; ++k) {
    const double at = static_cast<double>(k) - middle;
    product += at * record.x[k];
    squares += at * at;
  }
  sim::DriveState state =
      drive.at(record.x[kGivenSamples - 1], product / (squares * prepared.period_s * model.data.lead));
  double sum = 0.0;
  for (std::size_t k = kGivenSamples; k < record.size(); ++k) {
    prepared.held.step(drive, state, k - 1);
    sum += std::pow(drive.encoder(state) - record.x[k], 2);
  }
  const double rms = std::sqrt(sum / static_cast<double>(record.size() - kGivenSamples));
  return std::isfinite(rms) ? std::optional(rms) : std::nullopt;
}

}  // namespace host
