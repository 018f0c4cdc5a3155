// A trace as text with four characters per sample.
#pragma once

#include <span>
#include <string>

namespace host {

/// Samples as base64 of 24-bit big-endian codes: value = lowest + code * step; code 0xFFFFFF is a gap (NaN). The step
/// is the range / 16 777 214, far below the resolution of a screen or a sensor.
struct PackedSamples {
  double lowest = 0.0;
  double step = 0.0;
  std::string base64;
};

/// Infinite values become gaps.
PackedSamples pack_samples(std::span<const double> values);

}  // namespace host
