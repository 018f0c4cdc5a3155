// One supervised axis on eq. (7) without friction, stepped by a test.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/supervision/supervised_axis.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace firmware_test {

/// An axis with the paper's drive, eq. (7), and without friction.
class DrivenAxis {
 public:
  explicit DrivenAxis(const firmware::AxisParameters<float>& parameters) {
    io.encoder().reading = {0, true};
    io.tachometer().reading = {0, true};
    EXPECT_EQ(axis.configure(parameters), firmware::Refusal::none);
    for (int k = 0; k < firmware::kSelfTestSamples + 1; ++k) axis.step();
    EXPECT_TRUE(axis.set_position(0));
    EXPECT_TRUE(axis.enable());
    step();
  }
  void step(firmware::AxisFault outer = firmware::AxisFault::none) {
    axis.step(outer);
    run_on(1);
  }
  /// Advances only the drive, with the last command.
  void run_on(int periods) {
    for (int k = 0; k < periods; ++k) {
      const PaperAxis& drive = kPaperX;
      const double offset_V = io.drive_enable().on ? amplifier_offset_V : 0.0;
      const double u_V = io.dac().code * kDacResolution_V + offset_V + stuck_V;
      x_mm_ += drive.Ad12 * w_rad_s_ + drive.Bd1 * u_V;
      w_rad_s_ = drive.Ad22 * w_rad_s_ + drive.Bd2 * u_V;
    }
    const double counts = std::floor(x_mm_ / kEncoderResolution_mm);
    io.encoder().reading.counts = static_cast<std::uint32_t>(static_cast<std::int64_t>(counts));
    io.tachometer().reading.code = static_cast<std::int32_t>(std::lround(64.0 * w_rad_s_));
  }
  double at_mm() const { return x_mm_; }
  double stuck_V = 0.0;             ///< reaches the drive with and without the enable
  double amplifier_offset_V = 0.0;  ///< added to the command while enabled: offset of amplifier or converter

  firmware::boards::ValueAxis io;
  firmware::SupervisedAxis<float, firmware::boards::ValueAxis> axis{io};

 private:
  double x_mm_ = 0.0, w_rad_s_ = 0.0;
};

}  // namespace firmware_test
