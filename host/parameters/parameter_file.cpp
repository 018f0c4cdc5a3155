#include "host/parameters/parameter_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "firmware/app/parameters/parameter_check.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/parameter_names.hpp"
#include "host/parameters/set_refusal.hpp"
#include "host/read_file.hpp"
#include "host/toml_text.hpp"

namespace host {

namespace {

constexpr std::string_view kParameterFormat = "axis-params/1";

bool is_board_axis(std::string_view name) {
  return std::ranges::find(firmware::kAxisNames, name) != firmware::kAxisNames.end();
}

bool is_board_group(std::string_view name) {
  return std::ranges::any_of(firmware::kParameters, [&](const firmware::ParameterInfo& info) {
    return info.scope == firmware::ParameterScope::board && info.name.substr(0, info.name.find('.')) == name;
  });
}

/// The header of a backup (backup_file.hpp).
bool is_seal(std::string_view key) { return key == "count" || key == "crc32"; }

class ParameterReader {
 public:
  ParameterReader(std::string_view name, std::string_view axis) : name_(name), axis_(axis) {}

  std::vector<Assignment> read(std::string_view text) {
    const toml::table root = parse_toml(text, name_);
    const auto format = root["format"].value<std::string_view>();
    if (format != kParameterFormat)
      fail(1, "format = \"{}\" is missing: this is not a file of board parameters; `axistool design` writes one",
           kParameterFormat);
    for (const auto& [key, node] : root) {
      if (key.str() == "format" || is_seal(key.str())) continue;
      const std::size_t line = std::max<std::size_t>(1, key.source().begin.line);
      if (!node.is_table()) fail(line, "{}: parameters must be in tables, for example [x.kalman]", key.str());
      read_table(*node.as_table(), std::string(board_name_of(key.str(), line)));
    }
    return std::move(list_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(std::size_t line, fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: line {}: {}", name_, line, fmt::format(format, std::forward<Args>(args)...)));
  }

  std::string_view board_name_of(std::string_view top, std::size_t line) {
    if (is_board_group(top)) return top;
    if (axis_.empty() && is_board_axis(top)) return top;
    if (axis_.empty())
      fail(line, "the board has no axis {}; say which of its axes ({}) is meant: --axis {}", top,
           fmt::join(firmware::kAxisNames, ", "), firmware::kAxisNames.front());
    if (!std::exchange(taken_, std::string(top)).empty())
      fail(line, "the file holds more than one axis; --axis is for files with one");
    return axis_;
  }

  void read_table(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string name = prefix + "." + std::string(key.str());
      const std::size_t line = std::max<std::size_t>(1, key.source().begin.line);
      if (node.is_table())
        read_table(*node.as_table(), name);
      else
        list_.push_back(assignment(name, node, line));
    }
  }

  Assignment assignment(const std::string& name, const toml::node& node, std::size_t line) const {
    const std::size_t place = require_place(name, fmt::format("{}: line {}: ", name_, line));
    const bool is_switch = info_at(place).type == firmware::ParameterType::toggle;
    if (is_switch != node.is_boolean() || (!is_switch && !node.is_number()))
      fail(line, "{}: expected {}", name, is_switch ? "true or false" : "a number without quotes");
    const float value = is_switch ? (**node.as_boolean() ? 1.0F : 0.0F)
                                  : static_cast<float>(node.value<double>().value_or(std::nan("")));
    const auto problem = firmware::check_value(firmware::rule_at(place), value);
    if (problem != firmware::ValueRefusal::none)
      fail(line, "{}", describe(firmware::key_at(place), static_cast<std::uint8_t>(problem), value));
    return {place, value};
  }

  std::string_view name_;
  std::string_view axis_;
  std::string taken_;
  std::vector<Assignment> list_;
};

}  // namespace

std::vector<Assignment> parse_parameter_text(std::string_view text, std::string_view name, std::string_view axis) {
  return ParameterReader(name, axis).read(text);
}

std::vector<Assignment> read_parameter_file(const std::string& path, std::string_view axis) {
  return parse_parameter_text(read_file(path), path, axis);
}

void put_file(firmware::ParameterValues& values, const std::string& path, std::string_view axis) {
  for (const Assignment& one : read_parameter_file(path, axis)) put(values, one);
}

Assignment parse_assignment(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos)
    throw Failure(ExitCode::usage, fmt::format("{}: write NAME=VALUE, for example x.feedback.k1=48.4", text));
  std::size_t place = 0;
  try {
    place = require_place(text.substr(0, equals));
  } catch (const Failure& failure) {
    throw Failure(ExitCode::usage, failure.what());
  }
  const std::string number(text.substr(equals + 1));
  float value = number == "true" ? 1.0F : 0.0F;
  if (number != "true" && number != "false") {
    char* end = nullptr;
    value = std::strtof(number.c_str(), &end);
    if (number.empty() || *end != '\0')
      throw Failure(ExitCode::usage, fmt::format("{}: '{}' is not a number", text, number));
  }
  const auto problem = firmware::check_value(firmware::rule_at(place), value);
  if (problem != firmware::ValueRefusal::none)
    throw Failure(ExitCode::usage, describe(firmware::key_at(place), static_cast<std::uint8_t>(problem), value));
  return {place, value};
}

void put(firmware::ParameterValues& values, const Assignment& one) {
  if (one.place < values.size()) return values.set(one.place, one.value);
  throw Failure(ExitCode::bad_input, fmt::format("{}: the board has {} ax{}s, not that one", full_name(one.place),
                                                 values.axes(), values.axes() == 1 ? "i" : "e"));
}

void require_fitting_set(const firmware::ParameterValues& values) {
  const firmware::SetRefusal problem = firmware::check<float>(values);
  if (problem.kind == firmware::ValueRefusal::none) return;
  const float value = values.at(firmware::place_of(problem.key).value());
  const std::string why = why_refused(values, problem);
  throw Failure(ExitCode::bad_input, describe(problem.key, static_cast<std::uint8_t>(problem.kind), value) +
                                         (why.empty() ? "" : ": " + why));
}

}  // namespace host
