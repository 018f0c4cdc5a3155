// Any bytes as measured errors of a screw, or as a backup: a table that the board takes and returns unchanged, or a
// refusal.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "host/device/pitch_table.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/backup_file.hpp"

namespace {

bool board_takes(const host::PitchPoints& points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!firmware::is_valid(points[i]) || (i > 0 && !firmware::may_follow(points[i - 1], points[i]))) return false;
  return points.size() <= firmware::kMostPitchPoints;
}

void read_as_backup(std::string_view bytes) {
  try {
    const auto tables = host::pitch_of_backup(bytes, "fuzz.toml", 2);
    if (!tables) return;
    for (const auto& table : *tables)
      if (!board_takes(table)) std::abort();
    const std::string again = host::format_backup(firmware::ParameterValues(), {}, *tables);
    if (host::pitch_of_backup(again, "again.toml", 2) != tables) std::abort();
  } catch (const host::Failure&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  read_as_backup(bytes);
  for (const double count_mm : {0.00244140625, 1e-5}) {
    host::PitchPoints points;
    try {
      points = host::parse_pitch(bytes, "fuzz.csv", count_mm);
    } catch (const host::Failure&) {
      continue;
    }
    if (points.size() < 2 || !board_takes(points)) std::abort();
    if (host::parse_pitch(host::format_pitch(points, count_mm), "again.csv", count_mm) != points) std::abort();
  }
  return 0;
}
