#include "host/stop_notice.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/own_folder.hpp"

namespace host {

namespace {

constexpr std::string_view kPrefix = "axistool-stop-", kContinue = "continue\n";
constexpr std::size_t kLongest = 8192;

/// Empty if the user has none.
std::string folder() {
  try {
    return own_folder("XDG_RUNTIME_DIR", ".local/state/axis");
  } catch (const Failure&) {
    return "";
  }
}

/// The notice of a program that still waits; null if there is none.
class OpenNotice {
 public:
  explicit OpenNotice(const std::string& path)
      : file_(::open(path.c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC)) {
    struct stat found {};
    if (file_ < 0 || ::fstat(file_, &found) != 0 || !S_ISREG(found.st_mode) || found.st_uid != ::getuid()) return;
    if (found.st_size == 0) return;  // its owner has not locked it yet
    const bool is_left_over = ::flock(file_, LOCK_EX | LOCK_NB) == 0;
    if (is_left_over) ::unlink(path.c_str());
    is_held_ = !is_left_over;
  }
  ~OpenNotice() {
    if (file_ >= 0) ::close(file_);
  }
  OpenNotice(const OpenNotice&) = delete;
  OpenNotice& operator=(const OpenNotice&) = delete;

  bool is_held() const { return is_held_; }
  nlohmann::json document() const {
    std::array<char, kLongest> text{};
    const ssize_t size = ::pread(file_, text.data(), text.size(), 0);
    const std::string_view all(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return nlohmann::json::parse(all.substr(0, all.find('\n')), nullptr, false);
  }
  bool append(std::string_view word) const {
    return ::write(file_, word.data(), word.size()) == static_cast<ssize_t>(word.size());
  }

 private:
  int file_;
  bool is_held_ = false;
};

}  // namespace

StopNotice::StopNotice(const std::string& program, std::size_t line) {
  const std::string place = folder();
  if (place.empty()) return;
  path_ = fmt::format("{}/{}XXXXXX", place, kPrefix);
  const std::string text = nlohmann::json{{"program", program}, {"line", line}}.dump(
                               -1, ' ', false, nlohmann::json::error_handler_t::replace) +
                           "\n";
  file_ = ::mkostemp(path_.data(), O_CLOEXEC);
  if (file_ < 0) return;
  ::flock(file_, LOCK_EX);
  size_ = text.size();
  if (::write(file_, text.data(), size_) != static_cast<ssize_t>(size_)) size_ = kLongest;  // never continued
}

StopNotice::~StopNotice() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

bool StopNotice::is_continued() const {
  std::array<char, kContinue.size()> word{};
  return file_ >= 0 && ::pread(file_, word.data(), word.size(), static_cast<off_t>(size_)) == ssize_t{word.size()} &&
         std::string_view(word.data(), word.size()) == kContinue;
}

std::vector<WaitingProgram> waiting_programs() {
  std::vector<WaitingProgram> all;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPrefix)) continue;
    const OpenNotice notice(entry.path().string());
    if (!notice.is_held()) continue;
    const nlohmann::json document = notice.document();
    if (!document.is_object() || !document.contains("line")) continue;
    all.push_back({name, document.value("program", ""), document.value("line", std::size_t{0})});
  }
  std::ranges::sort(all, {}, &WaitingProgram::id);
  return all;
}

void continue_program(const std::string& id) {
  const bool is_name = id.starts_with(kPrefix) && id.find('/') == std::string::npos;
  if (is_name) {
    const OpenNotice notice(fmt::format("{}/{}", folder(), id));
    if (notice.is_held() && notice.append(kContinue)) return;
  }
  throw Failure(ExitCode::refused, "the program no longer waits at this stop");
}

}  // namespace host
