// Tables of pitch errors, in the board and in files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/compensation/pitch_table.hpp"
#include "host/device/board_client.hpp"

namespace host {

using PitchPoints = std::vector<firmware::PitchPoint>;

/// Measured errors from a CSV file: lines that begin with `#`, a header with column names, and one row per position in
/// ascending order. Columns, in any order: the position `x_mm` (`x_m`), and the deviation, actual minus commanded, by
/// direction of approach: `forward_um` and `backward_um` (also _mm, _m), or `error_um` for both. `count_mm`: travel of
/// a count of the axis's encoder. Throws Failure(bad_input) with file, line, column and remedy.
PitchPoints parse_pitch(std::string_view text, std::string_view name, double count_mm);
/// Text that parse_pitch() reads back within half of 2^-16 counts.
std::string format_pitch(const PitchPoints& points, double count_mm);

/// Travel per encoder count, mm.
double count_mm_of(const firmware::ParameterValues& values, std::size_t axis);

PitchPoints read_pitch(BoardClient& board, std::uint8_t axis);
/// Replaces the axis's table, switches it on or off and saves it with all present parameters of the board. Without
/// points, removes the table. Reads back and compares. Only while every drive is disabled.
void write_pitch(BoardClient& board, std::uint8_t axis, const PitchPoints& points, bool on);

/// "11 points, 0 to 400 mm, on"; empty without a table.
std::string pitch_text(const PitchPoints& points, bool on, double count_mm);
/// The same for a board's table; reads only its first and last points.
std::string read_pitch_text(BoardClient& board, std::uint8_t axis, bool on, double count_mm);

}  // namespace host
