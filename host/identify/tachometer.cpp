#include "host/identify/tachometer.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/encoder_step.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

bool has_both_sensors(const std::vector<Record>& records) {
  return std::ranges::all_of(records, [](const Record& r) { return r.has_position() && r.has_speed(); });
}

}  // namespace

std::optional<TachometerCalibration> calibrate_tachometer(const std::vector<Record>& records,
                                                          const sim::DataSheet& data) {
  constexpr double kWindow_s = 0.1;
  constexpr double kLeastSteps = 100.0;
  if (records.empty() || !has_both_sensors(records)) return std::nullopt;
  double travelled = 0.0, step = 0.0;
  std::size_t windows = 0;
  for (const Record& record : records) {
    const auto [low, high] = std::ranges::minmax(record.x);
    travelled = std::max(travelled, high - low);
    step = std::max(step, encoder_step(record, data));
    windows += static_cast<std::size_t>(static_cast<double>(record.size()) * record.sample_period_s / kWindow_s);
  }
  if (!(travelled > 0.0) || travelled < kLeastSteps * step) return std::nullopt;

  BlockedRegression<2> regression(rows_per_block(windows, kWindow_s));
  double product = 0.0, square = 0.0;
  for (const Record& record : records) {
    const auto length = static_cast<std::size_t>(std::max(1.0, std::round(kWindow_s / record.sample_period_s)));
    for (std::size_t start = 0; start + length < record.size(); start += length) {
      double integral = 0.5 * (record.w[start] + record.w[start + length]);
      for (std::size_t k = start + 1; k < start + length; ++k) integral += record.w[k];
      const double angle = (record.x[start + length] - record.x[start]) / data.lead;
      regression.add({angle, record.sample_period_s * static_cast<double>(length)}, integral * record.sample_period_s);
      product += angle * integral * record.sample_period_s;
      square += angle * angle;
    }
    regression.end_block();
  }
  const Regression found = regression.solve();
  if (!std::isfinite(found.condition_number)) return std::nullopt;
  const auto estimate = [&](Eigen::Index k) {
    const double half = found.t_quantile * std::sqrt(found.covariance(k, k));
    return Estimate{found.parameters(k), {found.parameters(k) - half, found.parameters(k) + half}};
  };
  return TachometerCalibration{estimate(0), estimate(1), product / square};
}

void apply_calibration(const TachometerCalibration& calibration, std::vector<Record>& records) {
  for (Record& record : records) {
    for (double& w : record.w) w = (w - calibration.offset.value) / calibration.gain.value;
  }
}

std::optional<double> standstill_variance(const std::vector<Record>& records, const sim::DataSheet& data) {
  constexpr double kStretch_s = 0.2;
  constexpr std::size_t kFewest = 3;
  if (records.empty() || !has_both_sensors(records)) return std::nullopt;
  double squares = 0.0, degrees = 0.0;
  std::size_t stretches = 0;
  for (const Record& record : records) {
    const auto length = static_cast<std::size_t>(std::max(2.0, std::round(kStretch_s / record.sample_period_s)));
    const double step = encoder_step(record, data);
    for (std::size_t start = 0; start + length <= record.size(); start += length) {
      const auto [low, high] = std::minmax_element(record.x.begin() + static_cast<std::ptrdiff_t>(start),
                                                   record.x.begin() + static_cast<std::ptrdiff_t>(start + length));
      if (*high - *low > 1.5 * step) continue;
      double sum = 0.0, sum_of_squares = 0.0;
      for (std::size_t k = start; k < start + length; ++k) {
        sum += record.w[k];
        sum_of_squares += record.w[k] * record.w[k];
      }
      const double n = static_cast<double>(length);
      squares += sum_of_squares - sum * sum / n;
      degrees += n - 1.0;
      ++stretches;
    }
  }
  if (stretches < kFewest) return std::nullopt;
  return squares / degrees;
}

std::optional<double> moving_variance(const Record& record, std::size_t begin, std::size_t count,
                                      const sim::DriveDescription& model) {
  if (count < 3 || !record.has_speed() || record.u_V.empty()) return std::nullopt;
  const sim::Drive drive(model);
  sim::DriveState state = drive.at(0.0, 0.0);
  const double period_s = record.sample_period_s;
  double before = 0.0, squares = 0.0;
  for (std::size_t k = begin; k + 1 < begin + count; ++k) {
    const double caused =
        drive.tach_gain * drive.deliver_over(state, record.u_V[k], period_s) / drive.inertia * period_s;
    const double unexplained = record.w[k + 1] - record.w[k] - caused;
    if (k > begin) squares += std::pow(unexplained - before, 2);
    before = unexplained;
  }
  return squares / 6.0 / static_cast<double>(count - 2);
}

}  // namespace host
