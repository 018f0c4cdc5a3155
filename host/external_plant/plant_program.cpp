#include "host/external_plant/plant_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <thread>

#include "host/exit_codes.hpp"

namespace host {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t kLongestReply = 4096;

/// False once the deadline has passed.
bool wait_for(int descriptor, short event, steady_clock::time_point deadline) {
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now()).count();
    pollfd end{descriptor, event, 0};
    const int ready = ::poll(&end, 1, static_cast<int>(std::clamp<long long>(left, 0, 1'000'000)));
    if (ready > 0) return true;
    if (ready == 0) return false;
    if (errno != EINTR) return false;
  }
}

/// The text for a message: control characters as '?', limited to one line.
std::string shown(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  constexpr std::size_t kMost = 200;
  return text.size() > kMost ? text.substr(0, kMost) + " …" : text;
}

}  // namespace

PlantProgram::PlantProgram(std::string command) : command_(std::move(command)) {
  std::array<int, 2> input{}, output{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input.data()) != 0 || ::pipe2(output.data(), O_CLOEXEC) != 0)
    throw Failure(ExitCode::permission, "cannot make the pipes to the plant's program");
  child_ = ::fork();
  if (child_ == 0) {
    ::setpgid(0, 0);
    ::dup2(input[1], STDIN_FILENO);
    ::dup2(output[1], STDOUT_FILENO);
    ::signal(SIGINT, SIG_DFL);
    ::execl("/bin/sh", "sh", "-c", command_.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(input[1]);
  ::close(output[1]);
  to_ = input[0];
  from_ = output[0];
  if (child_ < 0) {
    ::close(to_);
    ::close(from_);
    throw Failure(ExitCode::no_such_device, fmt::format("cannot start the plant's program '{}'", command_));
  }
  ::fcntl(to_, F_SETFL, O_NONBLOCK);
  ::fcntl(from_, F_SETFL, O_NONBLOCK);
}

PlantProgram::~PlantProgram() {
  ::close(to_);
  ::close(from_);
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round) {
    if (::waitpid(child_, nullptr, WNOHANG) != 0) return;
    std::this_thread::sleep_for(milliseconds(10));
  }
  ::kill(-child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
}

std::string PlantProgram::complaint(const std::string& what) const {
  return fmt::format("the plant '{}' {}; it {}", command_, what,
                     last_.empty() ? "had said nothing" : "last said '" + shown(last_) + "'");
}

void PlantProgram::fail_ended() {
  int status = 0;
  pid_t ended = 0;
  for (int round = 0; round < 20 && ended == 0; ++round) {  // its output may close shortly before it ends
    ended = ::waitpid(child_, &status, WNOHANG);
    if (ended == 0) std::this_thread::sleep_for(milliseconds(10));
  }
  if (!buffer_.empty()) last_ = buffer_;
  std::string how = "has closed its output";
  if (ended == child_ && WIFEXITED(status)) how = fmt::format("has ended (exit status {})", WEXITSTATUS(status));
  if (ended == child_ && WIFSIGNALED(status)) how = fmt::format("has ended (signal {})", WTERMSIG(status));
  throw Failure(ExitCode::no_such_device, complaint(how));
}

void PlantProgram::send(std::string_view text, steady_clock::time_point deadline) {
  while (!text.empty()) {
    const ssize_t sent = ::send(to_, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      text.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!wait_for(to_, POLLOUT, deadline))
        throw Failure(ExitCode::time_out, complaint("does not read its input (--patience gives it longer)"));
    } else if (errno != EINTR) {
      fail_ended();
    }
  }
}

void PlantProgram::fetch(steady_clock::time_point deadline) {
  std::array<char, kLongestReply> part{};
  const ssize_t got = ::read(from_, part.data(), part.size());
  if (got > 0) {
    buffer_.append(part.data(), static_cast<std::size_t>(got));
  } else if (got == 0) {
    fail_ended();
  } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
    if (!wait_for(from_, POLLIN, deadline))
      throw Failure(ExitCode::time_out,
                    complaint("does not answer in time (--patience gives it longer; does it flush each line?)"));
  } else if (errno != EINTR) {
    fail_ended();
  }
}

std::string PlantProgram::ask(std::string_view line, milliseconds patience) {
  const auto deadline = steady_clock::now() + patience;
  send(line, deadline);
  std::size_t end = 0;
  while ((end = buffer_.find('\n')) == std::string::npos) {
    if (buffer_.size() > kLongestReply) {
      last_ = buffer_;
      throw Failure(ExitCode::protocol, complaint("sends a line without end"));
    }
    fetch(deadline);
  }
  last_ = buffer_.substr(0, end);
  buffer_.erase(0, end + 1);
  return last_;
}

}  // namespace host
