// What stops an axis from inside its control law. Numbers are permanent.
#pragma once

#include <cstdint>

namespace firmware {

enum class AxisFault : std::uint8_t {
  none = 0,
  encoder_invalid = 1,     ///< the encoder reported an invalid reading
  tachometer_invalid = 2,  ///< the tachometer reported an invalid reading although one is fitted
  control_signal_not_a_number = 3,
  dac_write_failed = 4,
  parameters_missing = 5  ///< enable was asked for before parameters were accepted
};

}  // namespace firmware
