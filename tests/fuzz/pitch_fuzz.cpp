// Any bytes as what was measured of a screw: a table that the board takes and that reads back as it is, or a refusal.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/device/pitch_table.hpp"
#include "host/exit_codes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const double count_mm : {0.00244140625, 1e-5}) {
    host::PitchPoints points;
    try {
      points = host::parse_pitch(bytes, "fuzz.csv", count_mm);
    } catch (const host::Failure&) {
      continue;
    }
    if (points.size() < 2 || points.size() > firmware::kMostPitchPoints) std::abort();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!firmware::is_valid(points[i]) || (i > 0 && !firmware::may_follow(points[i - 1], points[i]))) std::abort();
    if (host::parse_pitch(host::format_pitch(points, count_mm), "again.csv", count_mm) != points) std::abort();
  }
  return 0;
}
