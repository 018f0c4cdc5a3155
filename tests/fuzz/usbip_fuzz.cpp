// Any bytes from a USB/IP host: the controller answers only requests, and disconnects if the data are not USB/IP.
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "hal/usbip/usbip_controller.hpp"
#include "hal/usbip/usbip_messages.hpp"

namespace {

using namespace std::chrono_literals;
using hal::usbip::Command;
using Bytes = std::vector<std::uint8_t>;

/// Requests of the host that are not answered yet.
class OpenRequests {
 public:
  /// Extracts the complete requests from the stream.
  void add(const std::uint8_t* data, std::size_t size) {
    stream_.insert(stream_.end(), data, data + size);
    while (stream_.size() >= hal::usbip::kHeaderSize) {
      const hal::usbip::Request request = hal::usbip::parse(header_at_front(stream_));
      const bool brings_data = request.command == Command::submit && !request.in;
      const std::size_t length = hal::usbip::kHeaderSize + (brings_data ? request.length : 0);
      if (stream_.size() < length) return;
      stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(length));
      // A host uses a sequence number only once: otherwise the replies could not be distinguished.
      unclear_ = unclear_ || std::any_of(requests_.begin(), requests_.end(), [&](const hal::usbip::Request& one) {
                   return one.sequence == request.sequence;
                 });
      requests_.push_back(request);
    }
  }

  /// Extracts the replies from the received data; each must be complete and match a request.
  void settle(Bytes received) {
    while (!received.empty() && !unclear_) {
      if (received.size() < hal::usbip::kHeaderSize) std::abort();
      const hal::usbip::Header header = header_at_front(received);
      const auto command = static_cast<Command>(hal::usbip::read_word(header, 0));
      const std::uint32_t sequence = hal::usbip::read_word(header, 4);
      const std::uint32_t moved = command == Command::submit_reply ? hal::usbip::read_word(header, 24) : 0;
      const auto asked = std::find_if(requests_.begin(), requests_.end(), [&](const hal::usbip::Request& one) {
        const Command answer = one.command == Command::submit ? Command::submit_reply : Command::unlink_reply;
        return one.sequence == sequence && answer == command && moved <= one.length;
      });
      if (asked == requests_.end()) std::abort();
      const std::size_t length = hal::usbip::kHeaderSize + (asked->in && command == Command::submit_reply ? moved : 0);
      if (received.size() < length) std::abort();
      received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(length));
      requests_.erase(asked);
    }
  }

 private:
  static hal::usbip::Header header_at_front(const Bytes& bytes) {
    hal::usbip::Header header{};
    std::copy_n(bytes.begin(), header.size(), header.begin());
    return header;
  }

  Bytes stream_;
  std::vector<hal::usbip::Request> requests_;
  bool unclear_ = false;
};

Bytes receive_all(int socket) {
  Bytes received;
  std::array<std::uint8_t, 4096> part{};
  for (;;) {
    const ssize_t size = recv(socket, part.data(), part.size(), MSG_DONTWAIT);
    if (size <= 0) return received;
    received.insert(received.end(), part.begin(), part.begin() + size);
  }
}

}  // namespace

/// The first byte sets the size of the pieces of the stream; the board returns every report.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static hal::tinyusb::HidPort port;
  static const bool started = port.start("FUZZ");
  if (!started || size == 0) return 0;
  const std::size_t piece = data[0] % 64 == 0 ? 4096 : 16 * (data[0] % 64);
  ++data;
  --size;
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) std::abort();
  {
    hal::usbip::UsbipController controller(ends[1], port, 0us);
    OpenRequests open;
    for (bool connected = true; connected && size > 0;) {
      const std::size_t length = std::min(piece, size);
      if (send(ends[0], data, length, 0) != static_cast<ssize_t>(length)) std::abort();
      open.add(data, length);
      data += length;
      size -= length;
      connected = controller.serve(0ns);
      for (hal::HidReport report; port.receive(report);) port.send(report);
      connected = connected && controller.serve(0ns);
      open.settle(receive_all(ends[0]));
    }
  }
  close(ends[0]);
  return 0;
}
