// What the protocol tells of the program that it cannot know by itself.
#pragma once

#include <cstdint>

namespace firmware {

/// What only the board's start-up knows.
struct BootFacts {
  std::uint8_t reset_cause = 0;  ///< boards/image/survival_record.hpp
  std::uint16_t resets = 0;      ///< since power came on
  bool simulated = false;
  bool lacks_brown_out_reset = false;  ///< no drive is enabled until its level is set
};

/// What the program takes of the processor, as it runs. Cycles: of the control interrupt; 0 where nothing counts them.
struct ProgramUse {
  std::uint32_t stack_used = 0, stack_size = 0;
  std::uint32_t cycles_average = 0, cycles_worst = 0, processor_Hz = 0;
};

}  // namespace firmware
