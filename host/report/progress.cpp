#include "host/report/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "host/report/terminal.hpp"

namespace host {

namespace {

/// Interval of updates: short enough for the user, long enough to take no noticeable time.
constexpr std::chrono::milliseconds redraw_interval(100);
constexpr const char* wipe_line = "\r\x1b[K";

}  // namespace

Progress::Progress(std::string what, std::size_t total, std::FILE* stream, std::chrono::milliseconds patience)
    : what_(std::move(what)),
      total_(std::max<std::size_t>(total, 1)),
      stream_(stream),
      patience_(patience),
      in_lines_(std::getenv("AXIS_PROGRESS") != nullptr),
      shows_(in_lines_ || terminal_of(stream).is_terminal) {
  if (in_lines_) patience_ = std::chrono::milliseconds(0);
}

Progress::~Progress() {
  if (!has_line_) return;
  std::fputs(wipe_line, stream_);
  std::fflush(stream_);
}

void Progress::advance(std::size_t steps, std::string_view detail) {
  const std::lock_guard lock(mutex_);
  done_ = std::min(done_ + steps, total_);
  if (!shows_) return;
  const Clock::time_point now = Clock::now();
  if (now - begun_ < patience_ || now - drawn_ < redraw_interval) return;
  draw(detail, now);
}

void Progress::add_steps(std::size_t steps) {
  const std::lock_guard lock(mutex_);
  total_ += steps;
}

void Progress::draw(std::string_view detail, Clock::time_point now) {
  const double elapsed_s = std::chrono::duration<double>(now - begun_).count();
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  drawn_ = now;
  if (in_lines_) {
    fmt::print(stream_, "progress {:.4f} {}{}{}\n", share, what_, detail.empty() ? "" : ": ", detail);
    std::fflush(stream_);
    return;
  }
  std::string line = fmt::format("{}: {:.0f} %", what_, 100.0 * share);
  if (done_ > 0) line += fmt::format(", about {:.0f} s left", elapsed_s * (1.0 - share) / share);
  if (!detail.empty()) line += fmt::format(" ({})", detail);
  const auto columns = static_cast<std::size_t>(terminal_of(stream_).columns);
  line.resize(std::min(line.size(), columns - 1));
  std::fputs(wipe_line, stream_);
  std::fputs(line.c_str(), stream_);
  std::fflush(stream_);
  has_line_ = true;
}

}  // namespace host
