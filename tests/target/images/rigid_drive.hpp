// The drives of an image's axes: the paper's drives without friction.
#pragma once

#include <cstdint>

#include "firmware/boards/pil/value_axis.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace target_image {

/// -128 to 127, from a simple linear congruential generator: its quality does not matter here.
inline std::int32_t random_code() {
  static std::uint32_t state = 1;
  state = state * 1664525u + 1013904223u;
  return static_cast<std::int32_t>(state >> 24) - 128;
}

/// Eq. (7) without friction, in float for any scalar of the control law.
class RigidDrive {
 public:
  explicit RigidDrive(const firmware_test::PaperAxis& axis) : axis_(axis) {}

  /// One control period of the drive, and its readings, with the tachometer's noise.
  void bring_readings(firmware::boards::ValueAxis& io) {
    advance(io.dac().code);
    io.encoder().reading = {static_cast<std::uint32_t>(counts_), true};
    const std::int32_t pulse = counts_ & ~4095;  // the last one passed, in either direction
    if (pulse != last_pulse_)
      io.encoder().index = {static_cast<std::uint32_t>(counts_ > last_pulse_ ? pulse : pulse + 4096), true, false};
    last_pulse_ = pulse;
    constexpr auto kCodesPerVelocity = static_cast<float>(1.0 / firmware_test::kTachometerResolution_rad_s);
    const auto code = static_cast<std::int32_t>(velocity_rad_s_ * kCodesPerVelocity);
    io.tachometer().reading = {code + random_code() / 8, true};
  }

 private:
  void advance(std::int32_t dac_code) {
    const float u = static_cast<float>(dac_code) * static_cast<float>(firmware_test::kDacResolution_V);
    fraction_mm_ += static_cast<float>(axis_.Ad12) * velocity_rad_s_ + static_cast<float>(axis_.Bd1) * u;
    velocity_rad_s_ = static_cast<float>(axis_.Ad22) * velocity_rad_s_ + static_cast<float>(axis_.Bd2) * u;
    constexpr auto kCount_mm = static_cast<float>(firmware_test::kEncoderResolution_mm);
    const auto passed = static_cast<std::int32_t>(fraction_mm_ / kCount_mm);
    counts_ += passed;
    fraction_mm_ -= static_cast<float>(passed) * kCount_mm;
  }

  const firmware_test::PaperAxis& axis_;
  std::int32_t counts_ = 0, last_pulse_ = 0;
  float fraction_mm_ = 0.0f, velocity_rad_s_ = 0.0f;
};

}  // namespace target_image
