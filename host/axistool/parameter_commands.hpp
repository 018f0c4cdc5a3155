// Common functions of the parameter commands.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"

namespace axistool {

struct Difference {
  std::size_t place;
  float before, after;
};

/// Compares bit by bit.
inline std::vector<Difference> differences(const firmware::ParameterValues& before,
                                           const firmware::ParameterValues& after) {
  std::vector<Difference> list;
  for (std::size_t place = 0; place < before.size(); ++place) {
    const float a = before.at(place), b = after.at(place);
    if (std::bit_cast<std::uint32_t>(a) != std::bit_cast<std::uint32_t>(b)) list.push_back({place, a, b});
  }
  return list;
}

/// The board's values with the changes of files and NAME=VALUE arguments.
firmware::ParameterValues with_changes(firmware::ParameterValues values, const std::vector<std::string>& sources,
                                       const std::string& axis);

void print_differences(const std::vector<Difference>& list, const char* before, const char* after);
nlohmann::json differences_json(const std::vector<Difference>& list);
/// A JSON number, or true or false for a switch.
nlohmann::json value_json(std::size_t place, float value);

}  // namespace axistool
