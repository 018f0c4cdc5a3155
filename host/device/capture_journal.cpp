#include "host/device/capture_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

constexpr double kEvery_s = 0.5;

/// The first row, which is the origin of the times, and the rows from `begin` on.
Capture tail_of(const Capture& capture, std::size_t begin) {
  const auto take = [begin](const auto& all, auto& some) {
    some.reserve(all.size() - begin + 1);
    if (begin > 0) some.push_back(all.front());
    for (std::size_t row = begin; row < all.size(); ++row) some.push_back(all[row]);
  };
  Capture tail;
  tail.row_period_s = capture.row_period_s;
  tail.trigger_s = capture.trigger_s;
  take(capture.number, tail.number);
  tail.channel.resize(capture.channel.size());
  for (std::size_t i = 0; i < capture.channel.size(); ++i) take(capture.channel[i], tail.channel[i]);
  return tail;
}

/// Removes header, column names and first row from the text of a record.
std::string_view rows_behind_first(std::string_view text) {
  for (bool in_header = true; in_header; text.remove_prefix(text.find('\n') + 1)) in_header = text.starts_with('#');
  return text.substr(text.find('\n') + 1);
}

}  // namespace

CaptureJournal::CaptureJournal(const std::string& output, const CaptureSettings& settings, std::string drive)
    : path_(output + ".unfinished"), drive_(std::move(drive)), settings_(settings) {}

CaptureJournal::~CaptureJournal() {
  if (file_ >= 0) ::close(file_);
}

void CaptureJournal::keep(const Capture& capture) {
  const std::size_t rows = capture.number.size();
  const auto period_rows = static_cast<std::size_t>(std::ceil(kEvery_s / capture.row_period_s));
  if ((settings_.trigger && !capture.trigger_s) || rows < kept_ + period_rows) return;
  const auto fail = [this](const char* what) {
    throw Failure(errno == EACCES ? ExitCode::permission : ExitCode::bad_input,
                  fmt::format("{}: cannot {}: {}", path_, what, std::strerror(errno)));
  };
  if (file_ < 0) file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (file_ < 0) fail("keep the rows there while they come");
  const std::string text = format_record(capture_record(tail_of(capture, kept_), settings_, drive_));
  for (std::string_view left = kept_ == 0 ? std::string_view(text) : rows_behind_first(text); !left.empty();) {
    const ssize_t written = ::write(file_, left.data(), left.size());
    if (written < 0 && errno != EINTR) fail("write");
    if (written > 0) left.remove_prefix(static_cast<std::size_t>(written));
  }
  ::fdatasync(file_);
  kept_ = rows;
}

void CaptureJournal::remove() {
  if (kept_ > 0) ::unlink(path_.c_str());
  kept_ = 0;
}

std::string CaptureJournal::remark() const {
  return kept_ == 0 ? std::string() : fmt::format("; {} holds the first {} rows", path_, kept_);
}

}  // namespace host
