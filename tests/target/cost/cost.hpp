// Executed instructions of the control law, counted by the emulator, exact and repeatable.
#pragma once

#include <map>
#include <string>

namespace target_test {

struct InstructionCost {
  int mean = 0;
  int worst = 0;

  bool operator==(const InstructionCost&) const = default;
};

/// Results of the cost image `name`, by the name of the part. Throws with the emulator's output if it fails.
std::map<std::string, InstructionCost> count_instructions(const std::string& name);

}  // namespace target_test
