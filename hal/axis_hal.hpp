// Hardware that the control law of one axis needs.
#pragma once

#include <type_traits>

#include "hal/dac.hpp"
#include "hal/drive_enable.hpp"
#include "hal/encoder.hpp"
#include "hal/tachometer.hpp"

namespace hal {

/// Contract: the four accessors return the same objects at every call. In one control period the law reads the encoder
/// and the tachometer once each, writes the converter once, and sets the enable line only when its state changes. A
/// drive without tachometer still has the accessor; its readings are invalid and, by the parameters, not used.
template <typename T>
concept AxisHal = requires(T& axis) {
  requires Encoder<std::remove_reference_t<decltype(axis.encoder())>>;
  requires Tachometer<std::remove_reference_t<decltype(axis.tachometer())>>;
  requires Dac<std::remove_reference_t<decltype(axis.dac())>>;
  requires DriveEnable<std::remove_reference_t<decltype(axis.drive_enable())>>;
};

/// An axis that may have a second encoder, on the table. Contract: as for Encoder; the reading is invalid if no second
/// encoder is wired. The control law does not read it.
template <typename T>
concept TableEncoderHal = requires(T& axis) {
  requires Encoder<std::remove_reference_t<decltype(axis.table_encoder())>>;
};

}  // namespace hal
