// Checksum of a whole set of values, by which host and board agree on the set to be taken over.
#pragma once

#include "firmware/app/crc32.hpp"
#include "firmware/app/parameters/parameter_values.hpp"

namespace firmware {

/// CRC-32 over the values in the order of the table, four bytes each, little-endian.
inline std::uint32_t set_crc(const ParameterValues& values) {
  Crc32 crc;
  for (std::size_t place = 0; place < values.size(); ++place) {
    const float value = values.at(place);
    crc.add(std::as_bytes(std::span(&value, 1)));
  }
  return crc.value();
}

}  // namespace firmware
