// A progress line for long calculations.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>

namespace host {

/// One line that is rewritten in place. It appears only on a terminal (never in a log or a pipe), and only after the
/// work has taken longer than `patience`. All functions may be called from several threads. The destructor erases the
/// line. For programs, the environment variable AXIS_PROGRESS makes separate lines of it, on any stream and without
/// delay: "progress SHARE WHAT", SHARE from 0 to 1.
class Progress {
 public:
  /// `total`: number of steps that advance() will count, > 0.
  explicit Progress(std::string what, std::size_t total, std::FILE* stream = stderr,
                    std::chrono::milliseconds patience = std::chrono::seconds(2));
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Counts finished steps. `detail` (may be empty) names the last one.
  void advance(std::size_t steps = 1, std::string_view detail = "");

  /// Adds steps to the total.
  void add_steps(std::size_t steps);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(std::string_view detail, Clock::time_point now);

  std::mutex mutex_;
  std::string what_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::FILE* stream_;
  std::chrono::milliseconds patience_;
  bool in_lines_;
  bool shows_;
  bool has_line_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point drawn_{};
};

}  // namespace host
