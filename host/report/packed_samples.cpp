#include "host/report/packed_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace host {

namespace {

constexpr std::uint32_t gap_code = 0xFFFFFF;
constexpr double highest_code = 0xFFFFFE;
constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void append_code(std::string& text, std::uint32_t code) {
  for (int shift = 18; shift >= 0; shift -= 6) text.push_back(digits[(code >> shift) & 63U]);
}

}  // namespace

PackedSamples pack_samples(std::span<const double> values) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  PackedSamples packed;
  if (lowest <= highest) {
    packed.lowest = lowest;
    packed.step = (highest - lowest) / highest_code;
  }
  packed.base64.reserve(4 * values.size());
  for (const double value : values) {
    const double code = packed.step > 0.0 ? std::round((value - packed.lowest) / packed.step) : 0.0;
    append_code(packed.base64, std::isfinite(value) ? static_cast<std::uint32_t>(code) : gap_code);
  }
  return packed;
}

}  // namespace host
