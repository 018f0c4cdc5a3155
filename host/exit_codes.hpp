// Exit codes of all commands of axistool.
#pragma once

#include <stdexcept>
#include <string>

namespace host {

enum class ExitCode : int {
  done = 0,
  answer_is_no = 1,  ///< differences found, a check failed
  usage = 2,
  no_such_device = 3,
  permission = 4,
  protocol = 5,
  device_fault = 6,
  time_out = 7,
  refused = 8,  ///< for safety, or because of insufficient excitation
  bad_input = 9,
};

/// A failure that the user can correct: the message says what, where and how.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

}  // namespace host
