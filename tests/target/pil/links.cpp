#include "tests/target/pil/links.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace target_test {

namespace {

constexpr int kPatience_ms = 30'000;

firmware::boards::PilRequest end_of_run() {
  firmware::boards::PilRequest request;
  request.number = firmware::boards::kPilEnd;
  return request;
}

std::unique_ptr<Stream> open_fifo(const std::string& path) {
  if (mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("cannot create the FIFO " + path);
  // For reading and writing, so that neither end waits for the other to open it.
  const int descriptor = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) throw std::runtime_error("cannot open the FIFO " + path);
  return std::make_unique<Stream>(descriptor);
}

std::unique_ptr<Stream> connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) throw std::runtime_error("the socket's path is too long: " + path);
  std::copy(path.begin(), path.end(), address.sun_path);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  for (int attempt = 0; attempt < 500; ++attempt) {  // the emulator creates the socket within a fraction of this
    if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      return std::make_unique<Stream>(descriptor);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  close(descriptor);
  throw std::runtime_error("the emulator does not open its serial port");
}

/// Emulated time advances by 64 ns per instruction. The pauses between two control interrupts then take little time,
/// and no result depends on the speed of this computer.
std::vector<std::string> emulator_options(const std::string& mode) {
  return {"-icount", "shift=6,align=off,sleep=off", "-semihosting-config", "enable=on,target=native,arg=" + mode};
}

}  // namespace

Stream::~Stream() { close(descriptor_); }

void Stream::write(std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t size = ::write(descriptor_, bytes.data(), bytes.size());
    if (size <= 0) throw std::runtime_error("the board does not take what it is sent");
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

void Stream::read(std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    pollfd waiting{descriptor_, POLLIN, 0};
    if (poll(&waiting, 1, kPatience_ms) <= 0) throw std::runtime_error("the board does not answer");
    const ssize_t size = ::read(descriptor_, bytes.data(), bytes.size());
    if (size <= 0) throw std::runtime_error("the board has gone");
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

FileLink::FileLink(const std::string& image_name)
    : requests_(open_fifo(folder_.path("pil-requests"))), replies_(open_fifo(folder_.path("pil-replies"))) {
  std::vector<std::string> options = emulator_options("pil-files");
  options.insert(options.end(), {"-serial", "null"});
  board_ = std::make_unique<Qemu>("netduinoplus2", image(image_name), folder_.path(""), options);
}

int FileLink::finish() {
  send(end_of_run());
  return board_->wait();
}

SerialLink::SerialLink(const std::string& image_name) {
  std::vector<std::string> options{"-semihosting-config", "enable=on,target=native,arg=pil-serial", "-serial",
                                   "unix:" + folder_.path("serial") + ",server=on,wait=on"};
  board_ = std::make_unique<Qemu>("netduinoplus2", image(image_name), folder_.path(""), options);
  socket_ = connect_to(folder_.path("serial"));
  receive_frame();  // hello: the receiver is on
}

void SerialLink::receive_frame() {
  std::byte byte{};
  do socket_->read(std::span(&byte, 1));
  while (!receiver_.take(byte));
}

int SerialLink::finish() {
  send(end_of_run());
  return board_->wait();
}

}  // namespace target_test
