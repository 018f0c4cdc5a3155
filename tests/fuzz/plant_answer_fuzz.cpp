// Any line of a plant's program: finite readings of as many axes as were asked for, or refused.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/external_plant/plant_answer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  for (std::size_t axes = 1; axes <= 4; ++axes) {
    try {
      const auto readings = host::parse_plant_answer(line, 7, axes);
      if (readings.size() != axes) std::abort();
      for (const sim::ForeignReading& reading : readings)
        if (!(std::abs(reading.x) <= host::kMostOfPlant) ||
            (reading.w && !(std::abs(*reading.w) <= host::kMostOfPlant)))
          std::abort();
    } catch (const host::Failure&) {
    }
  }
  return 0;
}
