// Any line of either side of axis-plant/1: finite numbers of as many axes as belong there, or refused.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/external_plant/plant_answer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  try {
    const host::PlantGreeting greeting = host::parse_plant_greeting(line);
    if (greeting.axes < 1 || greeting.axes > 64 || !(greeting.period_s > 0.0 && greeting.period_s <= 1.0)) std::abort();
  } catch (const host::Failure&) {
  }
  for (std::size_t axes = 1; axes <= 4; ++axes) {
    try {
      const auto commands = host::parse_plant_line(line, 7, axes);
      if (commands.size() != axes) std::abort();
      for (const auto& u_V : commands)
        if (u_V && !(std::abs(*u_V) <= host::kMostOfPlant)) std::abort();
    } catch (const host::Failure&) {
    }
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
