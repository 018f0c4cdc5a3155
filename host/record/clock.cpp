#include "host/record/clock.hpp"

#include <charconv>
#include <cmath>
#include <string>

#include "host/number.hpp"

namespace host {

namespace {

/// Removes between `fewest` and `most` digits from the start of `text`; returns their value.
std::optional<int> take_digits(std::string_view& text, std::size_t fewest, std::size_t most) {
  std::size_t count = 0;
  while (count < most && count < text.size() && text[count] >= '0' && text[count] <= '9') ++count;
  if (count < fewest) return std::nullopt;
  int value = 0;
  std::from_chars(text.data(), text.data() + count, value);
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

/// Days since 1970-01-01 in the Gregorian calendar (H. Hinnant, chrono-compatible low-level date algorithms).
std::optional<std::int64_t> day_number(int year, int month, int day) {
  if (month < 1 || month > 12 || day < 1 || day > 31 || year < 1900 || year > 2200) return std::nullopt;
  const int y = month <= 2 ? year - 1 : year;
  const int era = y / 400, year_of_era = y - era * 400;
  const int day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return std::int64_t{era} * 146'097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719'468;
}

std::optional<std::int64_t> take_date(std::string_view& text) {
  std::string_view rest = text;
  const auto first = take_digits(rest, 2, 4);
  const bool year_first = text.size() - rest.size() == 4;
  const char separator = rest.empty() ? '\0' : rest.front();
  if (!first || !(year_first ? separator == '-' || separator == '/' : separator == '.')) return std::nullopt;
  take(rest, separator);
  const auto month = take_digits(rest, 1, 2);
  if (!month || !take(rest, separator)) return std::nullopt;
  const auto last = year_first ? take_digits(rest, 1, 2) : take_digits(rest, 4, 4);
  if (!last) return std::nullopt;
  const auto day = year_first ? day_number(*first, *month, *last) : day_number(*last, *month, *first);
  if (day) text = rest;
  return day;
}

bool take_time(std::string_view& text, ClockReading& reading) {
  std::string_view rest = text;
  const auto hours = take_digits(rest, 1, 2);
  if (!hours || *hours > 23 || !take(rest, ':')) return false;
  const auto minutes = take_digits(rest, 2, 2);
  if (!minutes || *minutes > 59 || !take(rest, ':')) return false;
  std::string seconds;
  while (!rest.empty() &&
         ((rest.front() >= '0' && rest.front() <= '9') || rest.front() == '.' || rest.front() == ',')) {
    seconds += rest.front() == ',' ? '.' : rest.front();
    rest.remove_prefix(1);
  }
  const auto value = parse_number(seconds);
  if (!value || seconds.size() < 2 || *value > 60.0) return false;
  reading.second = 3600.0 * *hours + 60.0 * *minutes + *value;
  reading.last_digit = last_digit_of(seconds);
  text = rest;
  return true;
}

}  // namespace

std::optional<ClockReading> parse_clock(std::string_view field) {
  std::string_view rest = trim_blanks(field);
  ClockReading reading;
  reading.day = take_date(rest);
  if (reading.day && rest.empty()) {
    reading.last_digit = 86'400.0;
    return reading;
  }
  if (reading.day && !take(rest, 'T') && !take(rest, ' ')) return std::nullopt;
  rest = trim_blanks(rest);
  if (!take_time(rest, reading)) return std::nullopt;
  take(rest, 'Z');
  if (!rest.empty()) return std::nullopt;
  return reading;
}

}  // namespace host
