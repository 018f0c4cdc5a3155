#include "host/link/socket_link.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "host/exit_codes.hpp"
#include "host/own_folder.hpp"

namespace host {

namespace {

class SocketLink : public ReportLink {
 public:
  SocketLink(OwnedDescriptor socket, std::string path)
      : socket_(std::move(socket)), path_(std::move(path)), mark_(::open(path_.c_str(), O_PATH | O_CLOEXEC)) {}

  void send(const hal::HidReport& report) override {
    constexpr int kPatience_ms = 1000;
    pollfd writable{socket_.get(), POLLOUT, 0};
    if (::poll(&writable, 1, kPatience_ms) == 0)
      throw Failure(ExitCode::time_out, fmt::format("{} takes no reports", name()));
    if (::send(socket_.get(), report.data(), report.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(report.size()))
      gone();
  }

  std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override {
    pollfd readable{socket_.get(), POLLIN, 0};
    if (::poll(&readable, 1, static_cast<int>(limit.count())) <= 0) return std::nullopt;
    hal::HidReport report;
    const ssize_t got = ::recv(socket_.get(), report.data(), report.size(), 0);
    if (got != static_cast<ssize_t>(report.size())) gone();
    return report;
  }

  std::string name() const override { return "socket:" + path_; }
  std::string file() const override { return path_; }

 private:
  [[noreturn]] void gone() const {
    throw Failure(ExitCode::no_such_device,
                  fmt::format("{}: the board has gone: unplugged, or its program has ended", name()));
  }

  OwnedDescriptor socket_;
  std::string path_;
  OwnedDescriptor mark_;  ///< an open file with the socket's path, for users_of(): a connection does not show its path
};

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    throw Failure(ExitCode::usage, fmt::format("{}: a socket's path has at most {} characters: choose a shorter one",
                                               path, sizeof address.sun_path - 1));
  std::memcpy(address.sun_path, path.c_str(), path.size());
  return address;
}

/// Sequenced packets: each report arrives as one piece, or not at all.
OwnedDescriptor new_socket() {
  OwnedDescriptor socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (!socket) throw Failure(ExitCode::no_such_device, fmt::format("no socket: {}", std::strerror(errno)));
  return socket;
}

int connect(const OwnedDescriptor& socket, const sockaddr_un& address) {
  return ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

bool is_socket(const std::string& path) {
  struct stat found {};
  return ::lstat(path.c_str(), &found) == 0 && S_ISSOCK(found.st_mode);
}

/// Throws if the file at `path` is not a socket. Only the socket of a board that has ended may be removed.
void require_no_other_file(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0 || S_ISSOCK(found.st_mode)) return;
  throw Failure(ExitCode::usage,
                fmt::format("{}: this file exists and is not a socket; choose another path with --socket", path));
}

}  // namespace

OwnedDescriptor::~OwnedDescriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::unique_ptr<ReportLink> connect_to_socket(const std::string& path) {
  OwnedDescriptor socket = new_socket();
  if (connect(socket, address_of(path)) != 0) {
    if (errno == EACCES || errno == EPERM)
      throw Failure(ExitCode::permission, fmt::format("{}: it belongs to another user", path));
    throw Failure(ExitCode::no_such_device,
                  fmt::format("no simulated board listens at {} ({}): start one with `axistool sim`", path,
                              std::strerror(errno)));
  }
  return std::make_unique<SocketLink>(std::move(socket), path);
}

std::string default_socket_path() { return own_folder("XDG_RUNTIME_DIR", ".local/state/axis") + "/axis-sim.socket"; }

void remove_socket(const std::string& path) {
  if (is_socket(path)) ::unlink(path.c_str());
}

OwnedDescriptor listen_at_socket(const std::string& path) {
  const sockaddr_un address = address_of(path);
  if (connect(new_socket(), address) == 0)
    throw Failure(ExitCode::refused,
                  fmt::format("a simulated board already runs at {}; choose another path with --socket", path));
  require_no_other_file(path);
  ::unlink(path.c_str());
  OwnedDescriptor socket = new_socket();
  const mode_t usual = ::umask(0077);  // only the owner may connect, because a connection can move axes
  const int bound = ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::umask(usual);
  if (bound != 0 || ::listen(socket.get(), 4) != 0)
    throw Failure(ExitCode::permission, fmt::format("{}: {}", path, std::strerror(errno)));
  return socket;
}

}  // namespace host
