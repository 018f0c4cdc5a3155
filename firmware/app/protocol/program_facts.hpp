// Facts about the program that the protocol reports but cannot determine itself.
#pragma once

#include <cstdint>

namespace firmware {

/// Facts that only the board's start-up knows.
struct BootFacts {
  std::uint8_t reset_cause = 0;  ///< boards/image/survival_record.hpp
  std::uint16_t resets = 0;      ///< since power-on
  bool simulated = false;
  bool lacks_brown_out_reset = false;  ///< no drive can be enabled until its level is set
};

/// The program's use of stack and processor time. Cycles: of the control interrupt; 0 if they are not counted.
struct ProgramUse {
  std::uint32_t stack_used = 0, stack_size = 0;
  std::uint32_t cycles_average = 0, cycles_worst = 0, processor_Hz = 0;
};

}  // namespace firmware
