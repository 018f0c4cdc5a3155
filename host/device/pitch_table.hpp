// A board's tables of pitch errors, in the board and as files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/compensation/pitch_table.hpp"
#include "host/device/board_client.hpp"

namespace host {

using PitchPoints = std::vector<firmware::PitchPoint>;

/// What was measured, from a CSV file: lines that begin with `#`, a header of named columns, a row a place in rising
/// order. Columns, in any order: the place `x_mm` (`x_m`), and the deviations from it, actual less wanted, `forward_um`
/// and `backward_um` (also _mm, _m) by the direction of approach, or `error_um` for both.
/// `count_mm`: travel of a count of the axis's encoder. Throws Failure(bad_input) with file, line, column and remedy.
PitchPoints parse_pitch(std::string_view text, std::string_view name, double count_mm);
/// What parse_pitch() reads again, within half of 2^-16 counts.
std::string format_pitch(const PitchPoints& points, double count_mm);

/// Travel of a count, mm.
double count_mm_of(const firmware::ParameterValues& values, std::size_t axis);

PitchPoints read_pitch(BoardClient& board, std::uint8_t axis);
/// Replaces the axis's table, switches it and saves it with all parameters that the board has now. No points: removes
/// it. Reads back and compares. Only while every drive is disabled.
void write_pitch(BoardClient& board, std::uint8_t axis, const PitchPoints& points, bool on);

/// "11 points, 0 to 400 mm, on"; empty without a table.
std::string pitch_text(const PitchPoints& points, bool on, double count_mm);
/// The same of a board's table, of which it reads the first points and the last.
std::string read_pitch_text(BoardClient& board, std::uint8_t axis, bool on, double count_mm);

}  // namespace host
