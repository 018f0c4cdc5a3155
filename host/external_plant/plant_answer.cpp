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

[[noreturn]] void refuse(const std::string& what, std::uint64_t k, std::size_t axes) {
  std::string form = fmt::format("{}", k);
  for (std::size_t axis = 0; axis < axes; ++axis) form += " X W";
  throw Failure(ExitCode::protocol,
                fmt::format("{}; an answer is \"{}\": position, then tachometer or -, an axis", what, form));
}

/// Nothing where `text` as a whole is no finite number within bounds.
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

std::vector<sim::ForeignReading> parse_plant_answer(std::string_view line, std::uint64_t k, std::size_t axes) {
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.size() != 1 + 2 * axes)
    refuse(fmt::format("{} fields where {} belong", fields.size(), 1 + 2 * axes), k, axes);
  std::uint64_t period = 0;
  const auto [end, fault] = std::from_chars(fields[0].data(), fields[0].data() + fields[0].size(), period);
  if (fault != std::errc() || end != fields[0].data() + fields[0].size() || period != k)
    refuse(fmt::format("it begins with '{}' in period {}", fields[0], k), k, axes);
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
