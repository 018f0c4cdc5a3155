#include "sim/plant.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {
constexpr double kLongestStep_s = 0.25e-3;
}

Plant::Plant(const DriveDescription& description, std::uint64_t seed)
    : data_(description.data), drive_(description), unpowered_(drive_), state_(drive_.at(0.0, 0.0)), noise_(seed) {
  unpowered_.effort_per_volt = 0.0;
  if (data_.tach_noise_variance) tach_deviation_ = std::sqrt(*data_.tach_noise_variance);
}

void Plant::set_command(double u_V) {
  const double limited = std::clamp(u_V, -data_.dac_limit_V, data_.dac_limit_V);
  const double step = data_.dac_resolution_V;
  command_V_ =
      step > 0.0 ? std::clamp(step * std::round(limited / step), -data_.dac_limit_V, data_.dac_limit_V) : limited;
}

void Plant::advance(double duration_s) {
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / kLongestStep_s - 1e-9)));
  const double step_s = duration_s / steps;
  const Drive& drive = enabled_ ? drive_ : unpowered_;
  for (int step = 0; step < steps; ++step) drive.step(state_, command_V_, time_s_ + step * step_s, step_s);
  time_s_ += duration_s;
}

std::int64_t Plant::encoder_counts() const {
  const double reading = drive_.encoder(state_);
  // Without a resolution the reading passes through a grid far below any real scale.
  const double resolution = data_.encoder_resolution > 0.0 ? data_.encoder_resolution : 1e-9;
  return static_cast<std::int64_t>(std::floor(reading / resolution));
}

std::optional<double> Plant::read_tachometer() {
  if (!data_.tach_noise_variance) return std::nullopt;
  return drive_.tachometer(state_) + tach_deviation_ * normal_(noise_);
}

}  // namespace sim
