// Reads and writes files with the measured errors of a screw (host/device/pitch_table.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host/device/pitch_table.hpp"
#include "host/exit_codes.hpp"
#include "host/number.hpp"
#include "host/record/table_layout.hpp"

namespace host {

namespace {

constexpr double kUnitsPerCount = 65536.0;
constexpr TableLayout kCommas{.separator = ','};
constexpr std::string_view kColumns = "x_mm, and forward_um with backward_um, or error_um";

struct PitchColumn {
  std::string_view name;  ///< without the unit
  double mm = 0.0;        ///< size of the column's unit, mm
};

class PitchFile {
 public:
  PitchFile(std::string_view text, std::string_view name, double count_mm)
      : text_(text), name_(name), count_mm_(count_mm) {}

  PitchPoints read() {
    while (next_line()) {
      if (trim_blanks(line_).empty() || line_.front() == '#') continue;
      kCommas.split(line_, fields_);
      if (columns_.empty())
        take_header();
      else
        take_row();
    }
    if (columns_.empty()) fail("", fmt::format("no header: name the columns {}", kColumns));
    if (points_.size() < 2)
      fail("", fmt::format("{} rows: a table has 2 to {}", points_.size(), firmware::kMostPitchPoints));
    return std::move(points_);
  }

 private:
  [[noreturn]] void fail(std::string_view column, const std::string& what) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}:{}: {}{}", name_, number_,
                                                   column.empty() ? "" : fmt::format("column {}: ", column), what));
  }

  bool next_line() {
    if (!take_line(text_, line_)) return false;
    if (++number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) line_.remove_prefix(3);
    return true;
  }

  void take_header() {
    for (const std::string_view text : fields_) {
      const std::size_t bar = std::min(text.rfind('_'), text.size());
      const std::string_view what = text.substr(0, bar), unit = text.substr(std::min(bar + 1, text.size()));
      const double mm = unit == "mm" ? 1.0 : unit == "um" ? 1e-3 : unit == "m" ? 1e3 : 0.0;
      const bool is_known = what == "x" || what == "forward" || what == "backward" || what == "error";
      if (!is_known || mm == 0.0)
        fail(text.substr(0, 40), fmt::format("not known: the columns are {} (units _um, _mm, _m)", kColumns));
      if (place_of(what)) fail(text, "occurs twice: remove one");
      columns_.push_back({what, mm});
    }
    const bool has_both = place_of("forward") && place_of("backward");
    const bool has_any = place_of("forward") || place_of("backward");
    if (!place_of("x") || (place_of("error") ? has_any : !has_both))
      fail("", fmt::format("the header must name {}", kColumns));
  }

  std::optional<std::size_t> place_of(std::string_view what) const {
    const auto found =
        std::find_if(columns_.begin(), columns_.end(), [&](const PitchColumn& f) { return f.name == what; });
    return found == columns_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - columns_.begin()));
  }

  /// Converts to whole 2^-16 counts.
  std::int32_t whole(std::string_view what, double per_count, double most) const {
    const std::size_t place = *place_of(what);
    const auto value = parse_number(fields_[place]);
    if (!value || !std::isfinite(*value))
      fail(what, fmt::format("'{}' is not a number; write it with a decimal point and without blanks",
                             fields_[place].substr(0, 40)));
    const double parts = *value * columns_[place].mm / count_mm_ * per_count;
    if (!(std::abs(parts) <= most))
      fail(what, fmt::format("{} is more than the {:g} mm that the board can store: check the unit",
                             fields_[place].substr(0, 40), most / per_count * count_mm_));
    return static_cast<std::int32_t>(std::lround(parts));
  }

  void take_row() {
    if (fields_.size() != columns_.size())
      fail("",
           fmt::format("{} fields, but the header has {}: give one field per column", fields_.size(), columns_.size()));
    if (points_.size() == firmware::kMostPitchPoints)
      fail("",
           fmt::format("more than {} rows: leave some out where the screw is straight", firmware::kMostPitchPoints));
    constexpr double kFarthest = 1 << 30;
    const auto deviation = [this](std::string_view what) {
      return whole(what, kUnitsPerCount, static_cast<double>(firmware::kLargestDeviation));
    };
    firmware::PitchPoint point;
    point.counts = whole("x", 1.0, kFarthest);
    point.forward = deviation(place_of("error") ? "error" : "forward");
    point.backward = place_of("error") ? point.forward : deviation("backward");
    if (!points_.empty() && point.counts <= points_.back().counts)
      fail("x",
           "not above the previous row: give one row per position, in ascending order; average repeated measurements");
    if (!points_.empty() && !may_follow(points_.back(), point))
      fail("x", "the deviation changes by more than 1/64 of the travel since the previous row: check the unit");
    points_.push_back(point);
  }

  std::string_view text_, name_, line_;
  double count_mm_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  std::vector<PitchColumn> columns_;
  PitchPoints points_;
};

}  // namespace

PitchPoints parse_pitch(std::string_view text, std::string_view name, double count_mm) {
  return PitchFile(text, name, count_mm).read();
}

std::string format_pitch(const PitchPoints& points, double count_mm) {
  std::string text = "x_mm,forward_um,backward_um\n";
  const double um = 1e3 * count_mm / kUnitsPerCount;
  for (const firmware::PitchPoint& one : points)
    text += fmt::format("{:.9g},{:.9g},{:.9g}\n", one.counts * count_mm, one.forward * um, one.backward * um);
  return text;
}

}  // namespace host
