#include "tests/target/cost/cost.hpp"

#include <sstream>
#include <stdexcept>

#include "tests/target/qemu.hpp"

namespace target_test {

std::map<std::string, InstructionCost> count_instructions(const std::string& name) {
  Qemu board("netduinoplus2", image(name), std::filesystem::temp_directory_path(),
             {"-serial", "null", "-icount", "shift=0,align=off,sleep=off", "-semihosting-config",
              "enable=on,target=native,chardev=out", "-chardev", "stdio,id=out"});
  const int status = board.wait();
  std::map<std::string, InstructionCost> costs;
  std::istringstream lines(board.output());
  std::string word, part;
  InstructionCost cost;
  while (lines >> word >> part >> cost.mean >> cost.worst)
    if (word == "cost") costs[part] = cost;
  if (status != 0 || costs.empty()) throw std::runtime_error(name + " failed: " + board.output());
  return costs;
}

}  // namespace target_test
