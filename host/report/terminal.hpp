// Figures for a terminal: bars, tables, colour if wanted.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "host/report/content.hpp"

namespace host {

/// Properties of a stream. Colour is used only on a terminal, and not if NO_COLOR is set (https://no-color.org) or TERM
/// is "dumb". The width is that of the terminal, otherwise COLUMNS, otherwise 100.
struct Terminal {
  bool is_terminal = false;
  bool colour = false;
  int columns = 100;
};

Terminal terminal_of(std::FILE* stream);

/// `text` in the colour of a tone (good: green, attention: yellow, bad: red); unchanged if there is no colour.
std::string coloured(std::string_view text, Tone tone, const Terminal& terminal);

/// Horizontal bars, scaled to the width of the terminal. Each line ends with a line feed. The reference is a '|' on
/// every bar.
std::string terminal_bars(const BarChart& chart, const Terminal& terminal);

/// Aligned columns with numbers to the right. Cells are never cut.
std::string terminal_table(const Table& table, const Terminal& terminal);

/// Label and headline, the sentences wrapped to the width of the terminal, and the command on one line.
std::string terminal_verdict(const Verdict& verdict, const Terminal& terminal);

/// `text` wrapped at blanks into lines of at most `columns` characters, each after `indent`.
std::string wrapped(std::string_view text, int columns, std::string_view indent = "");

}  // namespace host
