// Reports between the echo board and its tests.
#pragma once

#include <cstdint>
#include <cstring>

#include "hal/usb_hid.hpp"

namespace echo_board {

inline constexpr std::uint32_t kStreamMark = 0x5354524D;

inline hal::HidReport numbered(std::uint32_t number) {
  hal::HidReport report{};
  std::memcpy(report.data(), &number, sizeof number);
  return report;
}

inline std::uint32_t number_of(const hal::HidReport& report) {
  std::uint32_t number = 0;
  std::memcpy(&number, report.data(), sizeof number);
  return number;
}

/// Requests `count` numbered reports, one per millisecond.
inline hal::HidReport stream_request(std::uint32_t count) {
  hal::HidReport report = numbered(count);
  std::memcpy(report.data() + sizeof count, &kStreamMark, sizeof kStreamMark);
  return report;
}

inline bool is_stream_request(const hal::HidReport& report) {
  return std::memcmp(report.data() + sizeof kStreamMark, &kStreamMark, sizeof kStreamMark) == 0;
}

inline hal::HidReport inverted(const hal::HidReport& report) {
  hal::HidReport result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = ~report[i];
  return result;
}

}  // namespace echo_board
