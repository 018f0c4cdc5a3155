// Reads the setting of the brown-out reset from the option bytes; it holds the chip in reset while its supply is too
// low. RM0090, 3.6 and 3.9.6.
#pragma once

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// The reset's threshold in hundredths of a volt: 270 (level 3), 240, 210, or 0 if it is off, as on a new chip. Below
/// 2.7 V the chip may not run at 168 MHz, nor program words of flash.
inline std::uint32_t brown_out_threshold(const FlashInterface& flash) {
  switch (flash.OPTCR & FlashInterface::kBrownOutField) {
    case FlashInterface::kBrownOutLevel3:
      return 270;
    case FlashInterface::kBrownOutLevel2:
      return 240;
    case FlashInterface::kBrownOutLevel1:
      return 210;
    default:
      return 0;
  }
}

}  // namespace hal::stm32f4
