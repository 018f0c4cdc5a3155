#include "host/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace host {

std::optional<NamedNumber> parse_named_number(std::string_view text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string_view::npos) return {};
  const std::optional<double> value = parse_number(text.substr(sign + 1));
  if (!value || !(*value > 0.0) || !std::isfinite(*value)) return {};
  return NamedNumber{std::string(trim_blanks(text.substr(0, sign))), *value};
}

double last_digit_of(std::string_view number) {
  constexpr std::array kPowers = {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
  number = trim_blanks(number);
  double exponent = 0.0;
  const std::size_t e = number.find_first_of("eE");
  if (e != std::string_view::npos) {
    exponent = parse_number(number.substr(e + 1)).value_or(0.0);
    number = number.substr(0, e);
  }
  const std::size_t point = number.find('.');
  const std::size_t decimals = point == std::string_view::npos ? 0 : number.size() - point - 1;
  return exponent == 0.0 && decimals < kPowers.size() ? kPowers[decimals]
                                                      : std::pow(10.0, exponent - static_cast<double>(decimals));
}

}  // namespace host
