#include "host/parameters/parameter_names.hpp"

#include <fmt/format.h>

#include <set>

#include "firmware/app/parameters/parameter_check.hpp"
#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"

namespace host {

const firmware::ParameterInfo& info_at(std::size_t place) { return firmware::kParameters[firmware::row_at(place)]; }

std::string full_name(std::size_t place) {
  const std::string name(info_at(place).name);
  const std::size_t owner = firmware::key_at(place).owner();
  return owner == 0 ? name : std::string(firmware::kAxisNames[owner - 1]) + "." + name;
}

std::string full_name(firmware::ParameterKey key) {
  const auto place = firmware::place_of(key);
  return place ? full_name(*place) : fmt::format("id {}", key.code);
}

std::optional<std::size_t> place_named(std::string_view name) {
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kMostAxes); ++place)
    if (full_name(place) == name) return place;
  return std::nullopt;
}

std::size_t require_place(std::string_view name, const std::string& where) {
  if (const auto place = place_named(name)) return *place;
  const std::vector<std::string> names = all_parameter_names();
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw Failure(ExitCode::bad_input, fmt::format("{}no parameter is called {}{}; `axistool parameters` lists them",
                                                 where, name, did_you_mean(name, known)));
}

std::vector<std::string> all_parameter_names() {
  std::vector<std::string> names;
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place)
    names.push_back(full_name(place));
  return names;
}

std::string parameter_hint(std::string_view name) {
  std::set<std::string> names;
  for (const std::string& full : all_parameter_names()) {
    const std::string without_axis = full.substr(full.find('.', 0) + 1);
    for (const std::string& one : {full, without_axis})
      for (std::size_t dot = one.find('.'); dot != std::string::npos; dot = one.find('.', dot + 1))
        names.insert(one.substr(0, dot));
    names.insert({full, without_axis});
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  return did_you_mean(name, known);
}

std::string unit_text(const firmware::ParameterInfo& info) {
  return info.unit == info.linear_unit ? std::string(info.unit)
                                       : fmt::format("{}; linear drive: {}", info.unit, info.linear_unit);
}

std::string value_text(const firmware::ParameterInfo& info, float value) {
  if (info.type == firmware::ParameterType::toggle && (value == 0.0F || value == 1.0F))
    return value != 0.0F ? "true" : "false";
  std::string text = fmt::format("{}", value);
  const bool is_plain = text.find_first_not_of("-0123456789") == std::string::npos;
  return is_plain && info.type == firmware::ParameterType::real ? text + ".0" : text;
}

std::string describe(firmware::ParameterKey key, std::uint8_t set_problem_kind, float value) {
  const std::string name = full_name(key);
  const auto place = firmware::place_of(key);
  if (!place) return fmt::format("{} is unknown to this axistool: use the version that matches the firmware", name);
  const firmware::ParameterInfo& info = info_at(*place);
  const std::string text = value_text(info, value);
  const auto outside = [&](const char* side, float limit) {
    return info.type == firmware::ParameterType::toggle
               ? fmt::format("{} = {} must be true or false", name, text)
               : fmt::format("{} = {} is {} {} ({})", name, text, side, value_text(info, limit), unit_text(info));
  };
  switch (static_cast<firmware::ValueRefusal>(set_problem_kind)) {
    case firmware::ValueRefusal::below_minimum:
      return outside("below its minimum", info.minimum);
    case firmware::ValueRefusal::above_maximum:
      return outside("above its maximum", info.maximum);
    case firmware::ValueRefusal::not_whole:
      return fmt::format("{} = {} must be {}", name, text,
                         info.type == firmware::ParameterType::toggle ? "true or false" : "a whole number");
    case firmware::ValueRefusal::rate_disagrees:
      return fmt::format(
          "{} = {} s does not match control.rate: set control.rate = {:.6g}, or design for the board's rate", name,
          text, 1.0 / static_cast<double>(value));
    case firmware::ValueRefusal::refused_by_core:
      return fmt::format("{} = {} ({}) does not go with the other parameters of its axis: {}", name, text,
                         unit_text(info), info.doc);
    case firmware::ValueRefusal::not_a_number:
    case firmware::ValueRefusal::none:
      break;
  }
  return fmt::format("{} is not a finite number; it must lie between {} and {} ({})", name,
                     value_text(info, info.minimum), value_text(info, info.maximum), unit_text(info));
}

}  // namespace host
