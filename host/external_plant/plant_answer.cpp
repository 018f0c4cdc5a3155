#include "host/external_plant/plant_answer.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/number.hpp"

namespace host {

namespace {

std::vector<std::string_view> fields_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> fields;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    fields.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

/// Reads the number of the period, the first word of the line.
bool is_period(std::string_view field, std::uint64_t k) {
  std::uint64_t period = 0;
  const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), period);
  return fault == std::errc() && end == field.data() + field.size() && period == k;
}

[[noreturn]] void refuse(const std::string& what, std::uint64_t k, std::size_t axes) {
  std::string form = fmt::format("{}", k);
  for (std::size_t axis = 0; axis < axes; ++axis) form += " X W";
  throw Failure(ExitCode::protocol,
                fmt::format("{}; an answer is \"{}\": position, then tachometer or -, an axis", what, form));
}

/// Empty unless the whole `text` is a finite number within bounds.
std::optional<double> number(std::string_view text) {
  const std::optional<double> value = parse_number(text);
  return value && std::abs(*value) <= kMostOfPlant ? value : std::nullopt;
}

}  // namespace

std::string plant_greeting(std::size_t axes, double period_s) {
  return fmt::format("axis-plant/1 {} {}\n", axes, period_s);
}

std::string plant_line(std::uint64_t k, std::span<const std::optional<double>> commands_V) {
  std::string line = fmt::format("{}", k);
  for (const std::optional<double>& u_V : commands_V) line += u_V ? fmt::format(" {}", *u_V) : std::string(" off");
  return line + '\n';
}

PlantGreeting parse_plant_greeting(std::string_view line) {
  constexpr double kMostAxes = 64.0, kLongest_s = 1.0;
  const std::vector<std::string_view> fields = fields_of(line);
  const auto axes = fields.size() == 3 ? parse_number(fields[1]) : std::nullopt;
  const auto period_s = fields.size() == 3 ? parse_number(fields[2]) : std::nullopt;
  if (!axes || !period_s || fields[0] != "axis-plant/1" || !(*axes >= 1.0 && *axes <= kMostAxes) ||
      std::trunc(*axes) != *axes || !(*period_s > 0.0 && *period_s <= kLongest_s))
    throw Failure(ExitCode::protocol,
                  fmt::format("the first line is no greeting; it is \"axis-plant/1 AXES PERIOD_S\": 1 to {:g} axes, a "
                              "period up to {:g} s",
                              kMostAxes, kLongest_s));
  return {static_cast<std::size_t>(*axes), *period_s};
}

std::vector<std::optional<double>> parse_plant_line(std::string_view line, std::uint64_t k, std::size_t axes) {
  const auto wrong = [&](const std::string& what) {
    return Failure(ExitCode::protocol,
                   fmt::format("{}; a line is \"{} U\": a voltage or off, for each of {} axes", what, k, axes));
  };
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.size() != 1 + axes) throw wrong(fmt::format("{} fields where {} belong", fields.size(), 1 + axes));
  if (!is_period(fields[0], k)) throw wrong(fmt::format("it begins with '{}' in period {}", fields[0], k));
  std::vector<std::optional<double>> commands_V(axes);
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const std::string_view text = fields[1 + axis];
    commands_V[axis] = number(text);
    if (!commands_V[axis] && text != "off") throw wrong(fmt::format("'{}' is no voltage", text));
  }
  return commands_V;
}

std::string plant_answer(std::uint64_t k, std::span<const sim::ForeignReading> readings) {
  std::string line = fmt::format("{}", k);
  for (const sim::ForeignReading& reading : readings)
    line += reading.w ? fmt::format(" {} {}", reading.x, *reading.w) : fmt::format(" {} -", reading.x);
  return line + '\n';
}

std::vector<sim::ForeignReading> parse_plant_answer(std::string_view line, std::uint64_t k, std::size_t axes) {
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.size() != 1 + 2 * axes)
    refuse(fmt::format("{} fields where {} belong", fields.size(), 1 + 2 * axes), k, axes);
  if (!is_period(fields[0], k)) refuse(fmt::format("it begins with '{}' in period {}", fields[0], k), k, axes);
  std::vector<sim::ForeignReading> readings(axes);
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const std::string_view position = fields[1 + 2 * axis], speed = fields[2 + 2 * axis];
    const std::optional<double> x = number(position), w = number(speed);
    if (!x) refuse(fmt::format("'{}' is no position", position), k, axes);
    if (!w && speed != "-") refuse(fmt::format("'{}' is no tachometer's reading", speed), k, axes);
    readings[axis] = {*x, w};
  }
  return readings;
}

}  // namespace host
