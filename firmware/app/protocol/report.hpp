// The envelope of every report: version, type, sequence number, status, length, checksum. Bytes: README.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "firmware/app/crc32.hpp"
#include "firmware/app/motion_owner.hpp"
#include "firmware/app/protocol/messages.hpp"
#include "hal/usb_hid.hpp"

namespace firmware {

inline constexpr std::uint8_t kProtocolVersion = 1;
inline constexpr std::size_t kPayloadOffset = 8;
inline constexpr std::size_t kCrcOffset = hal::kHidReportSize - sizeof(std::uint32_t);
static_assert(kCrcOffset - kPayloadOffset == kPayloadSize);

/// A report's contents. Bytes of the payload beyond `length` are 0.
struct Message {
  MessageType type = MessageType::identify;
  Status status = Status::ok;  ///< of a reply; a request has its client's pass here
  std::uint16_t sequence = 0;
  std::uint8_t length = 0;
  std::uint16_t client = 0;  ///< the requesting client; a reply repeats it
  std::array<std::byte, kPayloadSize> payload{};

  constexpr void set_pass(std::uint8_t pass) { status = static_cast<Status>(pass); }
  /// For a request: number and pass of the client.
  constexpr ClientToken asker() const { return client | ClientToken{static_cast<std::uint8_t>(status)} << 16; }

  template <typename Payload>
  void put(const Payload& value) {
    static_assert(std::is_trivially_copyable_v<Payload> && sizeof(Payload) <= kPayloadSize);
    std::memcpy(payload.data(), &value, sizeof value);
    length = sizeof value;
  }

  /// False, without changing `value`, if the payload has another length.
  template <typename Payload>
  bool get(Payload& value) const {
    static_assert(std::is_trivially_copyable_v<Payload> && sizeof(Payload) <= kPayloadSize);
    if (length != sizeof value) return false;
    std::memcpy(&value, payload.data(), sizeof value);
    return true;
  }

  bool operator==(const Message&) const = default;
};

/// Passes the payload to `handler`; malformed if the request has another length.
template <typename Payload, typename Handler>
Status with(const Message& request, Handler handler) {
  Payload payload;
  return request.get(payload) ? handler(payload) : Status::malformed;
}

inline hal::HidReport encode(const Message& message) {
  hal::HidReport report{};
  report[0] = std::byte{kProtocolVersion};
  report[1] = static_cast<std::byte>(message.type);
  report[2] = static_cast<std::byte>(message.sequence & 0xFF);
  report[3] = static_cast<std::byte>(message.sequence >> 8);
  report[4] = static_cast<std::byte>(message.status);
  report[5] = static_cast<std::byte>(message.length);
  report[6] = static_cast<std::byte>(message.client & 0xFF);
  report[7] = static_cast<std::byte>(message.client >> 8);
  std::memcpy(report.data() + kPayloadOffset, message.payload.data(),
              std::min<std::size_t>(message.length, kPayloadSize));
  const std::uint32_t crc = crc32(std::span(report).first(kCrcOffset));
  std::memcpy(report.data() + kCrcOffset, &crc, sizeof crc);
  return report;
}

/// Decodes any 64 bytes. Checks the checksum first, because a damaged report may contain anything.
inline Status decode(const hal::HidReport& report, Message& message) {
  std::uint32_t crc = 0;
  std::memcpy(&crc, report.data() + kCrcOffset, sizeof crc);
  if (crc32(std::span(report).first(kCrcOffset)) != crc) return Status::damaged;
  if (report[0] != std::byte{kProtocolVersion}) return Status::wrong_version;
  const auto length = std::to_integer<std::uint8_t>(report[5]);
  if (length > kPayloadSize) return Status::damaged;
  message = {};
  message.type = static_cast<MessageType>(report[1]);
  message.sequence =
      static_cast<std::uint16_t>(std::to_integer<unsigned>(report[2]) | std::to_integer<unsigned>(report[3]) << 8);
  message.status = static_cast<Status>(report[4]);
  message.client =
      static_cast<std::uint16_t>(std::to_integer<unsigned>(report[6]) | std::to_integer<unsigned>(report[7]) << 8);
  message.length = length;
  std::memcpy(message.payload.data(), report.data() + kPayloadOffset, length);
  return Status::ok;
}

}  // namespace firmware
