// A position of 64 bits as two words of a message.
#pragma once

#include <cstdint>

namespace firmware {

constexpr std::int64_t whole_counts(std::uint32_t low, std::int32_t high) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32 | low);
}

}  // namespace firmware
