#include "host/import/mapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/number.hpp"

namespace host {

namespace {

constexpr std::string_view kExample = "write for example --map t_s=t,x_mm=counts*0.00122+0,u_V=\"Command (V)\"";

bool is_name_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || c == '_' || c == '.' || c == '[' || c == ']' || c == '#' || c == '%' ||
         byte >= 0x80;
}

/// factor * source + shift, during parsing.
struct Linear {
  double factor = 0.0;
  double shift = 0.0;
};

class MappingParser {
 public:
  explicit MappingParser(std::string_view text) : text_(text) {}

  std::vector<Mapping> parse() {
    std::vector<Mapping> mappings;
    do {
      mappings.push_back(parse_one());
      const auto same = [&](const Mapping& m) { return m.column == mappings.back().column; };
      if (std::ranges::count_if(mappings, same) > 1) fail("'{}' is mapped twice; keep one", mappings.back().column);
    } while (take(','));
    if (!at_end()) fail("'{}' is not expected here; {}", text_.substr(at_), kExample);
    return mappings;
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::usage, fmt::format("--map '{}', character {}: {}", text_, at_ + 1,
                                               fmt::format(format, std::forward<Args>(args)...)));
  }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool at_end() {
    skip_blanks();
    return at_ == text_.size();
  }
  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  Mapping parse_one() {
    mapping_ = {};
    mapping_.column = take_name("the name of a column, such as x_mm");
    if (mapping_.column.find_first_of(",#\"\n\r") != std::string::npos)
      fail("'{}' cannot be the name of a column", mapping_.column);
    if (!take('=')) fail("expected '=' after '{}'; {}", mapping_.column, kExample);
    take_leading_column_number();
    const Linear sum = take_sum();
    if (mapping_.source.empty()) fail("'{}' has no variable or column to come from; {}", mapping_.column, kExample);
    if (!std::isfinite(sum.factor) || !std::isfinite(sum.shift) || sum.factor == 0.0)
      fail("'{}' would not depend on '{}'; check the factor", mapping_.column, mapping_.source);
    if (take('@')) mapping_.time_source = take_name("the variable that holds the time stamps");
    mapping_.factor = sum.factor;
    mapping_.shift = sum.shift;
    return mapping_;
  }

  /// `x_mm=3*0.5`: if no name follows up to the comma, a whole number at the start is the number of a column.
  void take_leading_column_number() {
    skip_blanks();
    std::size_t end = at_;
    while (end < text_.size() && text_[end] != ',') {
      const char c = text_[end];
      const bool exponent =
          (c == 'e' || c == 'E') && end > at_ && std::isdigit(static_cast<unsigned char>(text_[end - 1])) != 0;
      if (c == '"' || c == '\'' || c == '#' || (!exponent && std::isalpha(static_cast<unsigned char>(c)) != 0) ||
          c == '_' || static_cast<unsigned char>(c) >= 0x80)
        return;
      ++end;
    }
    std::size_t digits = at_;
    while (digits < end && std::isdigit(static_cast<unsigned char>(text_[digits])) != 0) ++digits;
    if (digits == at_ || (digits < end && (text_[digits] == '.' || text_[digits] == 'e' || text_[digits] == 'E')))
      return;
    column_number_end_ = digits;
  }

  Linear take_sum() {
    Linear sum = take_product(take('-') ? -1.0 : 1.0);
    while (!at_end() && (text_[at_] == '+' || text_[at_] == '-')) {
      const double sign = text_[at_++] == '-' ? -1.0 : 1.0;
      const Linear term = take_product(sign);
      sum.factor += term.factor;
      sum.shift += term.shift;
    }
    return sum;
  }

  Linear take_product(double sign) {
    Linear product = take_factor();
    product.factor *= sign;
    product.shift *= sign;
    while (!at_end() && (text_[at_] == '*' || text_[at_] == '/')) {
      const bool divide = text_[at_++] == '/';
      const double power = take('-') ? -1.0 : 1.0;
      const Linear next = take_factor();
      if (divide && next.factor != 0.0) fail("a record's column cannot be a number over '{}'", mapping_.source);
      if (divide && next.shift == 0.0) fail("division by zero");
      const double number = power * (divide ? 1.0 / next.shift : next.shift);
      product = next.factor != 0.0 ? Linear{power * product.shift * next.factor, 0.0}
                                   : Linear{product.factor * number, product.shift * number};
    }
    return product;
  }

  /// A number, or the source, which may occur once.
  Linear take_factor() {
    if (at_end()) fail("the expression ends too early; {}", kExample);
    if (column_number_end_ > at_) {
      mapping_.source = std::string(text_.substr(at_, column_number_end_ - at_));
      at_ = column_number_end_;
      column_number_end_ = 0;
      return {1.0, 0.0};
    }
    const char c = text_[at_];
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') return {0.0, take_number()};
    const std::string name = take_name("a number, or the name of a variable");
    if (!mapping_.source.empty())
      fail("'{}' depends on '{}' and on '{}'; a column comes from one source", mapping_.column, mapping_.source, name);
    mapping_.source = name;
    return {1.0, 0.0};
  }

  double take_number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{}) fail("expected a number");
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  std::string take_name(std::string_view what) {
    skip_blanks();
    if (at_ < text_.size() && (text_[at_] == '"' || text_[at_] == '\'')) return take_quoted();
    const std::size_t start = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
    if (at_ == start) fail("expected {}; {}", what, kExample);
    take_index();
    return std::string(text_.substr(start, at_ - start));
  }

  /// `log(:,2)` and `log(2)`: the second channel of a matrix.
  void take_index() {
    if (at_ == text_.size() || text_[at_] != '(') return;
    const std::size_t end = text_.find(')', at_);
    if (end == std::string_view::npos) fail("')' is missing");
    at_ = end + 1;
  }

  std::string take_quoted() {
    const char quote = text_[at_];
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos || end == at_ + 1) fail("expected a name in quotes");
    std::string name(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return name;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t column_number_end_ = 0;
  Mapping mapping_;
};

}  // namespace

std::vector<Mapping> parse_mappings(std::string_view text) { return MappingParser(text).parse(); }

}  // namespace host
