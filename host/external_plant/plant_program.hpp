// Runs another program that answers line by line.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <string_view>

namespace host {

/// Runs in its own process group, so that Ctrl-C for this program does not stop it. It shares this program's standard
/// error. The destructor closes its input and kills it if it does not end within 0.5 s.
class PlantProgram {
 public:
  /// `command`: for /bin/sh. Throws Failure(no_such_device) if it cannot be started.
  explicit PlantProgram(std::string command);
  PlantProgram(const PlantProgram&) = delete;
  PlantProgram& operator=(const PlantProgram&) = delete;
  ~PlantProgram();

  /// Sends a line, which ends in a line feed, and returns the answer without its own. Throws Failure with the program's
  /// last output: no_such_device (it has ended), time_out (no answer within `patience`), protocol (a line without end).
  std::string ask(std::string_view line, std::chrono::milliseconds patience);

  /// "the plant 'COMMAND' WHAT; it last said '…'".
  std::string complaint(const std::string& what) const;

 private:
  void send(std::string_view text, std::chrono::steady_clock::time_point deadline);
  void fetch(std::chrono::steady_clock::time_point deadline);
  [[noreturn]] void fail_ended();

  std::string command_, buffer_, last_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;  ///< its input (a socket: writing to an ended program raises no signal) and its output
};

}  // namespace host
