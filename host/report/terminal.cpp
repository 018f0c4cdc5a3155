#include "host/report/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "host/report/numeric_column.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

constexpr int default_columns = 100;
constexpr int fewest_columns = 40;
constexpr int widest_bar = 48;

/// Number of visible characters: UTF-8 continuation bytes do not count.
int visible_width(std::string_view text) {
  return static_cast<int>(std::count_if(
      text.begin(), text.end(), [](char letter) { return (static_cast<unsigned char>(letter) & 0xC0U) != 0x80U; }));
}

std::string repeated(std::string_view text, int count) {
  std::string all;
  for (int k = 0; k < count; ++k) all += text;
  return all;
}

std::string padded(std::string_view text, int width, bool to_the_right = false) {
  const std::string blanks(static_cast<std::size_t>(std::max(0, width - visible_width(text))), ' ');
  return to_the_right ? blanks + std::string(text) : std::string(text) + blanks;
}

std::string without_trailing_blanks(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

/// A bar of `share` of `width` cells, in eighths of a cell. The reference is at `mark_cell` (negative: no reference).
std::string bar_text(double share, int width, int mark_cell) {
  static constexpr const char* eighths[] = {" ", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const int filled = static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * width * 8));
  std::string text;
  for (int cell = 0; cell < width; ++cell) {
    const int level = std::clamp(filled - 8 * cell, 0, 8);
    if (cell == mark_cell) {
      text += "|";
    } else {
      text += level == 8 ? "█" : eighths[level];
    }
  }
  return text;
}

const char* series_escape(SeriesRole role) {
  switch (role) {
    case SeriesRole::before:
    case SeriesRole::predicted:
      return "\x1b[33m";
    case SeriesRole::after:
    case SeriesRole::model:
    case SeriesRole::validate:
      return "\x1b[34m";
    case SeriesRole::train:
      return "\x1b[36m";
    case SeriesRole::residual:
      return "\x1b[35m";
    case SeriesRole::measured:
    case SeriesRole::floor:
    case SeriesRole::other:
      break;
  }
  return "\x1b[37m";
}

int environment_columns() {
  const char* columns = std::getenv("COLUMNS");
  return columns == nullptr ? 0 : std::atoi(columns);
}

template <typename Items, typename Width>
int widest(const Items& items, Width width) {
  int most = 0;
  for (const auto& item : items) most = std::max(most, width(item));
  return most;
}

}  // namespace

Terminal terminal_of(std::FILE* stream) {
  Terminal terminal;
  const int descriptor = ::fileno(stream);
  terminal.is_terminal = ::isatty(descriptor) == 1;
  const char* no_colour = std::getenv("NO_COLOR");
  const char* kind = std::getenv("TERM");
  const bool refuses_colour =
      (no_colour != nullptr && *no_colour != '\0') || (kind != nullptr && std::string_view(kind) == "dumb");
  terminal.colour = terminal.is_terminal && !refuses_colour;
  winsize size{};
  const bool has_size = terminal.is_terminal && ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  const int columns = has_size ? size.ws_col : environment_columns();
  terminal.columns = columns > 0 ? std::max(columns, fewest_columns) : default_columns;
  return terminal;
}

std::string coloured(std::string_view text, Tone tone, const Terminal& terminal) {
  const char* escape = "";
  if (tone == Tone::good) escape = "\x1b[1;32m";
  if (tone == Tone::attention) escape = "\x1b[1;33m";
  if (tone == Tone::bad) escape = "\x1b[1;31m";
  if (!terminal.colour || *escape == '\0') return std::string(text);
  return fmt::format("{}{}\x1b[0m", escape, text);
}

std::string terminal_bars(const BarChart& chart, const Terminal& terminal) {
  const int label_width = widest(chart.rows, [](const BarRow& row) { return visible_width(row.label); });
  const int name_width =
      chart.series.size() < 2 ? 0 : widest(chart.series, [](const BarSeries& s) { return visible_width(s.name) + 2; });
  const int value_width = 10 + visible_width(chart.unit);
  const int room = terminal.columns - label_width - 2 - name_width - value_width;
  const int width = std::clamp(room, 8, widest_bar);
  const double longest = chart.longest();
  const double scale = 1.0 / longest;
  const int mark =
      chart.reference ? std::min(width - 1, static_cast<int>(chart.reference->second * scale * width)) : -1;

  std::string text = chart.title.empty() ? "" : chart.title + "\n";
  for (const BarRow& row : chart.rows) {
    for (std::size_t k = 0; k < chart.series.size(); ++k) {
      const double value = k < row.values.size() ? row.values[k] : std::nan("");
      std::string bar = bar_text(std::isfinite(value) ? value * scale : 0.0, width, mark);
      if (terminal.colour) bar = fmt::format("{}{}\x1b[0m", series_escape(chart.series[k].role), bar);
      const std::string unit = chart.unit.empty() || !std::isfinite(value) ? "" : " " + chart.unit;
      const std::string name = name_width > 0 ? padded(chart.series[k].name, name_width) : "";
      text += fmt::format("{}  {}{} {}{}\n", padded(k == 0 ? row.label : "", label_width), name, bar,
                          format_value(value), unit);
    }
  }
  if (chart.reference)
    text += fmt::format("{}  | {}\n", std::string(static_cast<std::size_t>(label_width), ' '), chart.reference->first);
  return text;
}

std::string terminal_table(const Table& table, const Terminal& terminal) {
  std::vector<int> widths;
  for (std::size_t column = 0; column < table.headings.size(); ++column) {
    const int cells = widest(table.rows, [&](const std::vector<std::string>& row) {
      return column < row.size() ? visible_width(row[column]) : 0;
    });
    widths.push_back(std::max(cells, visible_width(table.headings[column])));
  }
  const auto line_of = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t column = 0; column < std::min(cells.size(), widths.size()); ++column) {
      line += (column == 0 ? "" : "  ") + padded(cells[column], widths[column], is_numeric_column(table, column));
    }
    return without_trailing_blanks(line) + "\n";
  };
  std::string text = table.title.empty() ? "" : table.title + "\n";
  const std::string heading = line_of(table.headings);
  text += terminal.colour ? "\x1b[1m" + heading.substr(0, heading.size() - 1) + "\x1b[0m\n" : heading;
  std::vector<std::string> rule;
  for (const int width : widths) rule.push_back(repeated("─", width));
  text += line_of(rule);
  for (const std::vector<std::string>& row : table.rows) text += line_of(row);
  return text;
}

std::string terminal_verdict(const Verdict& verdict, const Terminal& terminal) {
  std::string text;
  if (!verdict.label.empty()) text += coloured(verdict.label, verdict.tone, terminal) + "\n";
  text += wrapped(verdict.headline, terminal.columns);
  for (const auto* sentences : {&verdict.sentences, &verdict.details})
    for (const std::string& sentence : *sentences) text += wrapped(sentence, terminal.columns, "  ");
  if (!verdict.command.empty()) text += "  " + verdict.command + "\n";
  return text;
}

std::string wrapped(std::string_view text, int columns, std::string_view indent) {
  std::string all;
  std::string line(indent);
  bool is_empty = true;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    if (word.empty()) continue;
    if (!is_empty && visible_width(line) + 1 + visible_width(word) > columns) {
      all += line + "\n";
      line = indent;
      is_empty = true;
    }
    if (!is_empty) line += " ";
    line += word;
    is_empty = false;
  }
  return is_empty ? all : all + line + "\n";
}

}  // namespace host
