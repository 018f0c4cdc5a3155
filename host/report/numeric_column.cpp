#include "host/report/numeric_column.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace host {

namespace {

bool begins_with_number(std::string_view cell) {
  const std::size_t digit = cell.find_first_not_of("+-−–±. ");
  return digit == std::string_view::npos || (cell[digit] >= '0' && cell[digit] <= '9');
}

}  // namespace

bool is_numeric_column(const Table& table, std::size_t column) {
  return std::all_of(table.rows.begin(), table.rows.end(), [&](const std::vector<std::string>& row) {
    return column >= row.size() || begins_with_number(row[column]);
  });
}

}  // namespace host
