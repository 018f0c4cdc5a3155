#include "sim/plant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {

namespace {
constexpr double kLongestStep_s = 0.25e-3;
}

Plant::Plant(const DriveDescription& description, std::uint64_t seed)
    : data_(description.data), drive_(description), unpowered_(drive_), state_(drive_.at(0.0, 0.0)), noise_(seed) {
  unpowered_.effort_per_volt = 0.0;
  if (data_.tach_noise_variance) tach_deviation_ = std::sqrt(*data_.tach_noise_variance);
}

void Plant::hand_over(std::shared_ptr<ForeignMotion> motion) {
  foreign_ = std::move(motion);
  state_.x = state_.load_x = foreign_->reading().x;
  tell_foreign();
}

void Plant::tell_foreign() {
  if (foreign_) foreign_->command(enabled_ ? std::optional(command_V_) : std::nullopt);
}

void Plant::follow_foreign(double duration_s) {
  const double before = state_.x;
  foreign_->advance(duration_s);
  time_s_ += duration_s;
  state_.x = state_.load_x = foreign_->reading().x;
  state_.w = state_.load_w = (state_.x - before) / (data_.lead * duration_s);
}

void Plant::set_enabled(bool enabled) {
  enabled_ = enabled;
  tell_foreign();
}

void Plant::set_command(double u_V) {
  const double limited = std::clamp(u_V, -data_.dac_limit_V, data_.dac_limit_V);
  const double step = data_.dac_resolution_V;
  command_V_ =
      step > 0.0 ? std::clamp(step * std::round(limited / step), -data_.dac_limit_V, data_.dac_limit_V) : limited;
  tell_foreign();
}

void Plant::advance(double duration_s) {
  if (foreign_) {
    follow_foreign(duration_s);
    return;
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / kLongestStep_s - 1e-9)));
  const double step_s = duration_s / steps;
  const Drive& drive = enabled_ ? drive_ : unpowered_;
  for (int step = 0; step < steps; ++step) drive.step(state_, command_V_, time_s_ + step * step_s, step_s);
  time_s_ += duration_s;
}

std::int64_t Plant::counts_at(double encoder_travel) const {
  // Without a resolution the reading is rounded to a step far below that of any real scale.
  const double resolution = data_.encoder_resolution > 0.0 ? data_.encoder_resolution : 1e-9;
  if (foreign_) return std::llround(encoder_travel / resolution);
  return static_cast<std::int64_t>(std::floor(encoder_travel / resolution));
}

std::optional<double> Plant::read_load_encoder() const {
  if (!data_.has_load_encoder() || foreign_) return std::nullopt;
  const double table = drive_.table(state_, time_s_), step = data_.load_encoder_resolution;
  return step * std::floor((table + data_.load_encoder_error(table)) / step);
}

std::optional<double> Plant::read_tachometer() {
  if (!data_.tach_noise_variance) return std::nullopt;
  if (foreign_) return foreign_->reading().w;
  return drive_.tachometer(state_) + tach_deviation_ * normal_(noise_);
}

}  // namespace sim
