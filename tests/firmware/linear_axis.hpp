// A drive without friction, in double precision, behind the board's interface: eq. (7) written out.
#pragma once

#include <cmath>
#include <cstdint>

#include "firmware/core/axis_parameters.hpp"
#include "hal/axis_hal.hpp"

namespace firmware_test {

class LinearAxis {
 public:
  struct Encoder {
    LinearAxis& axis;
    bool valid = true;
    hal::EncoderReading read() {
      const double relative = std::floor(axis.position / axis.count_length + 0.5);
      return {static_cast<std::uint32_t>(axis.origin_counts + static_cast<std::int64_t>(relative)), valid};
    }
  };
  struct Tachometer {
    LinearAxis& axis;
    bool valid = true;
    hal::TachometerReading read() {
      return {static_cast<std::int32_t>(std::lround(axis.velocity / axis.tachometer_resolution)), valid};
    }
  };
  struct Dac {
    LinearAxis& axis;
    bool works = true;
    bool write(std::int32_t code) {
      if (works) axis.command_V = code * axis.dac_resolution_V;
      return works;
    }
    bool is_healthy() const { return true; }
  };
  struct Enable {
    bool on = false;
    void set(bool value) { on = value; }
    bool is_faulted() { return false; }
  };

  template <typename Scalar>
  explicit LinearAxis(const firmware::AxisParameters<Scalar>& p)
      : count_length(static_cast<double>(p.encoder_resolution)),
        dac_resolution_V(static_cast<double>(p.dac_resolution_V)),
        tachometer_resolution(static_cast<double>(p.tachometer_gain)),
        Ad12(static_cast<double>(p.drive.Ad12)),
        Ad22(static_cast<double>(p.drive.Ad22)),
        Bd1(static_cast<double>(p.drive.Bd1)),
        Bd2(static_cast<double>(p.drive.Bd2)) {}

  LinearAxis(const LinearAxis&) = delete;

  Encoder& encoder() { return encoder_; }
  Tachometer& tachometer() { return tachometer_; }
  Dac& dac() { return dac_; }
  Enable& drive_enable() { return enable_; }

  void advance() {
    const double net_V = (enable_.on ? command_V : 0.0) - disturbance_V;
    position += Ad12 * velocity + Bd1 * net_V;
    velocity = Ad22 * velocity + Bd2 * net_V;
  }

  double count_length, dac_resolution_V, tachometer_resolution;
  double Ad12, Ad22, Bd1, Bd2;
  std::int64_t origin_counts = 0;  ///< the encoder's reading at position 0
  double position = 0.0;           ///< mm
  double velocity = 0.0;           ///< rad/s
  double command_V = 0.0;
  double disturbance_V = 0.0;

 private:
  Encoder encoder_{*this};
  Tachometer tachometer_{*this};
  Dac dac_{*this};
  Enable enable_;
};

}  // namespace firmware_test
