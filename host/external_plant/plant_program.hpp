// Another program, asked line by line.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <string_view>

namespace host {

/// Runs in a process group of its own, so that a Ctrl-C meant for this program leaves it running. Its errors go where
/// this program's go. Its input ends when the object dies; if it does not end by itself within half a second then, it
/// is killed.
class PlantProgram {
 public:
  /// `command`: for /bin/sh. Throws Failure(no_such_device) where nothing can be started.
  explicit PlantProgram(std::string command);
  PlantProgram(const PlantProgram&) = delete;
  PlantProgram& operator=(const PlantProgram&) = delete;
  ~PlantProgram();

  /// Sends a line, which ends in a line feed, and returns the answer without its own. Throws Failure with what the
  /// program last said: no_such_device (it has ended), time_out (no answer within `patience`), protocol (a line without
  /// end).
  std::string ask(std::string_view line, std::chrono::milliseconds patience);

  /// "the plant 'COMMAND' WHAT; it last said '…'".
  std::string complaint(const std::string& what) const;

 private:
  void send(std::string_view text, std::chrono::steady_clock::time_point deadline);
  void fetch(std::chrono::steady_clock::time_point deadline);
  [[noreturn]] void fail_ended();

  std::string command_, buffer_, last_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;  ///< its input (a socket: a program that has gone raises no signal) and its output
};

}  // namespace host
