#include "host/import/confined_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <new>

#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

using SteadyTime = std::chrono::steady_clock::time_point;

constexpr std::size_t kMostMemory = 1024 * kMebibyte, kLongestText = kMebibyte, kMostColumns = 100'000;

/// Limit of processor time, s, because a damaged file may put a library into an endless loop. Undamaged files take less
/// than a tenth of it.
unsigned time_limit_s(std::size_t bytes) { return 5U + static_cast<unsigned>(bytes / (16 * kMebibyte)); }

/// The first byte of each part of the answer.
enum class Part : char { column = 'c', header = 'h', preamble = 'p', layout = 'l', failure = 'f', end = 'e' };

/// The child's end of the pipe.
class Sender {
 public:
  explicit Sender(int pipe) : pipe_(pipe) {}

  void send(const Log& log) const {
    if (log.columns.size() > kMostColumns)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: more than {} columns, the most that a log may have; save those "
                                "of the log",
                                log.path, kMostColumns));
    part(Part::layout, {log.layout});
    for (const auto& [key, value] : log.header) part(Part::header, {key, value});
    for (const std::string& line : log.preamble) part(Part::preamble, {line});
    for (const LogColumn& column : log.columns) {
      part(Part::column, {column.name, column.kind, column.fault, column.unit, column.time});
      const std::size_t count = column.values.size();
      bytes(&count, sizeof count);
      bytes(column.values.data(), count * sizeof(double));
    }
    part(Part::end, {});
  }

  void part(Part kind, std::initializer_list<std::string_view> texts) const {
    bytes(&kind, sizeof kind);
    for (const std::string_view text : texts) {
      const std::size_t size = std::min(text.size(), kLongestText);
      bytes(&size, sizeof size);
      bytes(text.data(), size);
    }
  }

 private:
  void bytes(const void* data, std::size_t size) const {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t put = write(pipe_, at, size);
      if (put < 0 && errno != EINTR) _exit(1);
      if (put < 0) continue;
      at += put;
      size -= static_cast<std::size_t>(put);
    }
  }

  int pipe_;
};

/// The parent's end of the pipe. It trusts no received data, because a damaged file may have taken over the child.
class Receiver {
 public:
  Receiver(int pipe, SteadyTime until) : pipe_(pipe), until_(until) {}

  /// Whether the answer was complete. `failure` is set if the child rejected the file.
  bool take(Log& log, std::string& failure) {
    std::size_t numbers = 0;
    for (Part kind{}; bytes(&kind, sizeof kind);) {
      std::string key, value;
      switch (kind) {
        case Part::end:
          return true;
        case Part::failure:
          return text(failure);
        case Part::layout:
          if (!text(log.layout)) return false;
          break;
        case Part::preamble:
          if (!text(value) || log.preamble.size() >= kMostPreamble) return false;
          log.preamble.push_back(std::move(value));
          break;
        case Part::header:
          if (!text(key) || !text(value) || log.header.size() >= kMostColumns) return false;
          log.header[key] = std::move(value);
          break;
        case Part::column:
          if (log.columns.size() >= kMostColumns || !column(log.columns.emplace_back(), numbers)) return false;
          break;
        default:
          return false;
      }
    }
    return false;
  }

  bool timed_out() const { return timed_out_; }

 private:
  bool column(LogColumn& column, std::size_t& numbers) {
    std::size_t count = 0;
    for (std::string* part : {&column.name, &column.kind, &column.fault, &column.unit, &column.time})
      if (!text(*part)) return false;
    if (!bytes(&count, sizeof count) || count > kMostLogNumbers - numbers) return false;
    numbers += count;
    column.values.resize(count);
    return bytes(column.values.data(), count * sizeof(double));
  }

  bool text(std::string& text) {
    std::size_t size = 0;
    if (!bytes(&size, sizeof size) || size > kLongestText) return false;
    text.resize(size);
    return bytes(text.data(), size);
  }

  bool bytes(void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(until_ - std::chrono::steady_clock::now());
      pollfd ready{pipe_, POLLIN, 0};
      const int events = poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
      timed_out_ = events == 0;
      if (timed_out_) return false;
      const ssize_t got = read(pipe_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }

  int pipe_;
  SteadyTime until_;
  bool timed_out_ = false;
};

/// `spare`: distance of the hard limit, which would end the process without a signal that shows the reason.
void limit(__rlimit_resource resource, rlim_t most, rlim_t spare = 0) {
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_max = std::min(now.rlim_max, most + spare);
  now.rlim_cur = std::min(now.rlim_cur, most);
  setrlimit(resource, &now);
}

/// Bytes of address space that this process uses so far.
std::size_t address_space() {
  std::array<char, 64> text{};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  const ssize_t size = read(file, text.data(), text.size() - 1);
  close(file);
  return size > 0 ? std::strtoull(text.data(), nullptr, 10) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void confine(unsigned seconds) {
  for (int signal = 1; signal < NSIG; ++signal)
    std::signal(signal, SIG_DFL);  // the caller's handlers must not run in the child
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);  // does not limit the pipe
  limit(RLIMIT_CPU, seconds, 1);
  limit(RLIMIT_AS, address_space() + kMostMemory);
}

[[noreturn]] void run_child(int pipe, unsigned seconds, const std::string& path, Log (*read)(const std::string&)) {
  confine(seconds);
  const Sender sender(pipe);
  try {
    sender.send(read(path));
  } catch (const std::bad_alloc&) {
    sender.part(Part::failure,
                {fmt::format("{}: needs more than {} MiB of memory, the limit for a log: it is damaged, or "
                             "must be saved with fewer rows",
                             path, kMostMemory / kMebibyte)});
  } catch (const std::exception& failure) {
    sender.part(Part::failure, {failure.what()});
  }
  _exit(0);
}

}  // namespace

Log read_confined(const std::string& path, std::string_view library, Log (*read)(const std::string& path)) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > kLogSize.bytes)
    throw Failure(ExitCode::bad_input, fmt::format("{}: larger than {} MiB, the most that {} may have; cut it", path,
                                                   kLogSize.bytes / kMebibyte, kLogSize.of));
  const unsigned seconds = time_limit_s(unknown ? 0 : size);
  std::array<int, 2> ends{};
  // Only one thread forks at a time. Otherwise another child could keep this pipe open after its own child has crashed.
  static std::mutex forking;
  std::unique_lock alone(forking);
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Failure(ExitCode::permission, "cannot create a pipe");
  const pid_t child = fork();
  if (child == 0) run_child(ends[1], seconds, path, read);
  close(ends[1]);
  alone.unlock();
  Log log;
  log.path = path;
  std::string failure;
  // On a busy machine the child gets only a part of a processor.
  Receiver receiver(ends[0], std::chrono::steady_clock::now() + std::chrono::seconds(3 * seconds));
  const bool whole = child > 0 && receiver.take(log, failure);
  close(ends[0]);
  if (!whole && child > 0) kill(child, SIGKILL);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child < 0) throw Failure(ExitCode::permission, fmt::format("{}: cannot start a process to read it", path));
  if (!failure.empty()) throw Failure(ExitCode::bad_input, failure);
  const bool too_long = receiver.timed_out() || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU);
  if (!whole)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: damaged: {} {}; save it again", path, library,
                              too_long ? fmt::format("reads it for longer than {} s", seconds) : "fails on it"));
  return log;
}

}  // namespace host
