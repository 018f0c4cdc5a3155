// CRC-32 as Ethernet, gzip and PNG compute it (ISO 3309: polynomial 0x04C11DB7, reflected, ends inverted).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace firmware {

/// Feeds on pieces; value() is the checksum of all of them together. Sixteen table entries: 64 bytes of flash.
class Crc32 {
 public:
  constexpr Crc32& add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      remainder_ ^= static_cast<std::uint32_t>(byte);
      remainder_ = (remainder_ >> 4) ^ kNibble[remainder_ & 0xF];
      remainder_ = (remainder_ >> 4) ^ kNibble[remainder_ & 0xF];
    }
    return *this;
  }

  constexpr std::uint32_t value() const { return ~remainder_; }

 private:
  static constexpr std::array<std::uint32_t, 16> kNibble = [] {
    std::array<std::uint32_t, 16> table{};
    for (std::uint32_t i = 0; i < 16; ++i) {
      std::uint32_t remainder = i;
      for (int bit = 0; bit < 4; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xEDB88320u : 0u);
      table[i] = remainder;
    }
    return table;
  }();

  std::uint32_t remainder_ = 0xFFFFFFFFu;
};

constexpr std::uint32_t crc32(std::span<const std::byte> bytes) { return Crc32().add(bytes).value(); }

}  // namespace firmware
