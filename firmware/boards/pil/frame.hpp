// Frames for byte streams that may lose or change bytes: two marks, a length, the payload, its CRC-32.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "firmware/app/crc32.hpp"

namespace firmware::boards {

inline constexpr std::array<std::byte, 2> kFrameMark{std::byte{0xA5}, std::byte{0x5A}};

/// Hands the bytes of a frame around `payload` (at most 65535 bytes) to `send`, one by one.
template <typename Send>
void send_frame(std::span<const std::byte> payload, Send send) {
  const auto length = static_cast<std::uint16_t>(payload.size());
  const std::array<std::byte, 2> length_bytes{static_cast<std::byte>(length & 0xFF),
                                              static_cast<std::byte>(length >> 8)};
  const std::uint32_t crc = Crc32().add(length_bytes).add(payload).value();
  for (const std::byte byte : kFrameMark) send(byte);
  for (const std::byte byte : length_bytes) send(byte);
  for (const std::byte byte : payload) send(byte);
  for (int shift = 0; shift < 32; shift += 8) send(static_cast<std::byte>((crc >> shift) & 0xFF));
}

/// Finds frames of up to `capacity` payload bytes in a stream. Bytes that fail the checks are skipped and counted.
template <std::size_t capacity>
class FrameReceiver {
 public:
  /// Takes one byte; true when it completes a frame, whose payload then stays valid until the next call.
  bool take(std::byte byte) {
    buffer_[filled_++] = byte;
    while (filled_ != 0) {
      if (!begins_like_a_frame()) {
        drop_first();
        continue;
      }
      if (filled_ < kHead || filled_ < kHead + length() + kTail) return false;
      payload_size_ = length();
      const std::size_t frame_size = kHead + payload_size_ + kTail;
      std::uint32_t crc = 0;
      for (std::size_t i = 0; i < kTail; ++i)
        crc |= static_cast<std::uint32_t>(buffer_[frame_size - kTail + i]) << (8 * i);
      if (crc32(std::span(buffer_).subspan(kFrameMark.size(), 2 + payload_size_)) == crc) {
        filled_ = 0;  // bytes arrive one by one, so nothing follows
        return true;
      }
      ++rejected_;
      drop_first();
    }
    return false;
  }

  std::span<const std::byte> payload() const { return std::span(buffer_).subspan(kHead, payload_size_); }
  std::uint32_t rejected() const { return rejected_; }

 private:
  static constexpr std::size_t kHead = kFrameMark.size() + 2;
  static constexpr std::size_t kTail = 4;

  std::size_t length() const {
    return static_cast<std::size_t>(buffer_[2]) | static_cast<std::size_t>(buffer_[3]) << 8;
  }

  bool begins_like_a_frame() const {
    if (buffer_[0] != kFrameMark[0]) return false;
    if (filled_ > 1 && buffer_[1] != kFrameMark[1]) return false;
    return filled_ < kHead || length() <= capacity;
  }

  void drop_first() {
    --filled_;
    std::memmove(buffer_.data(), buffer_.data() + 1, filled_);
  }

  std::array<std::byte, kHead + capacity + kTail> buffer_{};
  std::size_t filled_ = 0;
  std::size_t payload_size_ = 0;
  std::uint32_t rejected_ = 0;
};

}  // namespace firmware::boards
