#include "host/record/table_layout.hpp"

#include <algorithm>
#include <map>

#include "host/number.hpp"
#include "host/record/clock.hpp"

namespace host {

namespace {

using Fields = std::vector<std::string_view>;

std::string_view unquoted(std::string_view field) {
  field = trim_blanks(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  return field;
}

void split_at_blanks(std::string_view line, Fields& fields) {
  for (line = trim_blanks(line); !line.empty(); line = trim_blanks(line)) {
    const std::size_t end = line.front() == '"' ? line.find('"', 1) : line.find_first_of(" \t");
    const std::size_t length = end == std::string_view::npos ? line.size() : end + (line.front() == '"' ? 1 : 0);
    fields.push_back(unquoted(line.substr(0, length)));
    line.remove_prefix(length);
  }
}

/// Replaces a decimal comma by a point. Empty if the field also has a point, because the comma then separates thousands
/// or the field is not a number.
std::string with_point(std::string_view field) {
  std::string plain(field);
  if (plain.find('.') != std::string::npos || std::ranges::count(plain, ',') > 1) return {};
  std::ranges::replace(plain, ',', '.');
  return plain;
}

/// The first lines that are not empty; enough of them to tell a preamble from a table.
std::vector<std::string_view> sample_of(std::string_view text) {
  constexpr std::size_t kLines = 400;
  std::vector<std::string_view> lines;
  for (std::string_view line; lines.size() < kLines && take_line(text, line);)
    if (!trim_blanks(line).empty() && !is_remark(line)) lines.push_back(line);
  return lines;
}

/// Number of lines with the layout's number of fields, weighted by the share of fields that are numbers or times.
double merit_of(TableLayout& layout, const std::vector<std::string_view>& lines) {
  std::map<std::size_t, std::size_t> lines_with;
  Fields fields;
  for (const std::string_view line : lines) {
    layout.split(line, fields);
    ++lines_with[fields.size()];
  }
  std::size_t most = 0;
  for (const auto& [count, times] : lines_with) {
    if (times < most) continue;
    most = times;
    layout.fields = count;
  }
  if (layout.fields < 2 && layout.separator != 0) return 0.0;
  double merit = 0.0;
  for (const std::string_view line : lines) {
    layout.split(line, fields);
    if (fields.size() != layout.fields) continue;
    const auto known = std::ranges::count_if(fields, [&](std::string_view field) {
      return layout.number(field).has_value() || parse_clock(field).has_value();
    });
    const std::size_t filled =
        fields.size() - (fields.size() > 1 && fields.back().empty() ? 1 : 0);  // for lines that end with a separator
    merit += static_cast<double>(known) / static_cast<double>(filled);
  }
  return merit;
}

}  // namespace

void TableLayout::split(std::string_view line, Fields& out) const {
  out.clear();
  if (separator == 0) {
    split_at_blanks(line, out);
    return;
  }
  bool in_quotes = false;
  std::size_t start = 0;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    if (k < line.size() && line[k] == '"') in_quotes = !in_quotes;
    if (k < line.size() && (in_quotes || line[k] != separator)) continue;
    out.push_back(unquoted(line.substr(start, k - start)));
    start = k + 1;
  }
}

std::optional<double> TableLayout::number(std::string_view field) const {
  return decimal_comma ? parse_number(with_point(field)) : parse_number(field);
}

double TableLayout::last_digit(std::string_view field) const {
  return decimal_comma ? last_digit_of(with_point(field)) : last_digit_of(field);
}

std::string_view TableLayout::separator_name() const {
  switch (separator) {
    case ',':
      return "commas";
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    default:
      return "blanks";
  }
}

bool is_remark(std::string_view line) {
  line = trim_blanks(line);
  return line.starts_with('#') || line.starts_with('%');
}

bool take_line(std::string_view& rest, std::string_view& line) {
  line = {};
  if (rest.empty()) return false;
  const std::size_t end = rest.find('\n');
  line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return true;
}

TableLayout find_layout(std::string_view text) {
  const std::vector<std::string_view> lines = sample_of(text);
  TableLayout best;
  double most = -1.0;
  for (const char separator : {'\t', ';', ',', '\0'}) {
    for (const bool decimal_comma : {false, true}) {
      if (decimal_comma && separator == ',') continue;
      TableLayout layout{separator, decimal_comma, 0};
      const double merit = merit_of(layout, lines);
      if (layout.fields == 0 || merit <= most || (layout.fields < 2 && separator != 0)) continue;
      most = merit;
      best = layout;
    }
  }
  return best;
}

}  // namespace host
