// The messages of USB/IP's second phase, transfers: the kernel's Documentation/usb/usbip_protocol.rst. Big-endian,
// headers of 48 bytes.
#pragma once

#include <array>
#include <cstdint>

namespace hal::usbip {

inline constexpr std::size_t kHeaderSize = 48;
using Header = std::array<std::uint8_t, kHeaderSize>;

enum class Command : std::uint32_t { submit = 1, unlink = 2, submit_reply = 3, unlink_reply = 4 };

// Status of a reply: negative error numbers of Linux, on every system.
inline constexpr std::int32_t kDone = 0, kStalled = -32, kUnlinked = -104;

/// Requests of the host. `submit`: a transfer. `unlink`: cancels the transfer `victim`.
struct Request {
  Command command{};
  std::uint32_t sequence = 0;
  bool in = false;
  std::uint32_t endpoint = 0;  ///< number, without direction
  std::uint32_t length = 0;    ///< submit: bytes that follow (out), or for which there is room (in)
  std::array<std::uint8_t, 8> setup{};
  std::uint32_t victim = 0;  ///< unlink
};

inline std::uint32_t read_word(const Header& header, std::size_t at) {
  return std::uint32_t{header[at]} << 24 | std::uint32_t{header[at + 1]} << 16 | std::uint32_t{header[at + 2]} << 8 |
         std::uint32_t{header[at + 3]};
}

inline void write_word(Header& header, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) header[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

inline Request parse(const Header& header) {
  Request request;
  request.command = static_cast<Command>(read_word(header, 0));
  request.sequence = read_word(header, 4);
  request.in = read_word(header, 12) != 0;
  request.endpoint = read_word(header, 16);
  if (request.command == Command::unlink) {
    request.victim = read_word(header, 20);
  } else {
    request.length = read_word(header, 24);
    for (std::size_t i = 0; i < request.setup.size(); ++i) request.setup[i] = header[40 + i];
  }
  return request;
}

/// Device, direction and endpoint are zero in replies.
inline Header reply(Command command, std::uint32_t sequence, std::int32_t status, std::uint32_t transferred = 0) {
  Header header{};
  write_word(header, 0, static_cast<std::uint32_t>(command));
  write_word(header, 4, sequence);
  write_word(header, 20, static_cast<std::uint32_t>(status));
  if (command == Command::submit_reply) write_word(header, 24, transferred);
  return header;
}

}  // namespace hal::usbip
