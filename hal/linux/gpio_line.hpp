// Output lines of a Linux computer's GPIO chip, by libgpiod 1.6 or 2.x.
#pragma once

#include <memory>
#include <string>

namespace hal::linux_gpio {

enum class Drive { push_pull, open_drain };

/// One requested line; released when it is destroyed. Throws std::system_error with the operation and the chip's path.
class OutputLine {
 public:
  OutputLine(const std::string& chip_path, unsigned offset, Drive drive, bool value);
  ~OutputLine();
  OutputLine(const OutputLine&) = delete;
  OutputLine& operator=(const OutputLine&) = delete;

  void set(bool value);

 private:
  struct Request;
  std::unique_ptr<Request> request_;
};

}  // namespace hal::linux_gpio
