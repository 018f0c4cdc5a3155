// Names of parameters for users: "x.kalman.k11", "control.rate".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"

namespace host {

/// The row of the value at this place (firmware/app/parameters/parameter_values.hpp).
const firmware::ParameterInfo& info_at(std::size_t place);

/// The name with its axis.
std::string full_name(std::size_t place);
std::string full_name(firmware::ParameterKey key);  ///< "id N" for a key that the table does not have

/// Empty for a name that the table does not have. A board with fewer axes may not have its place.
std::optional<std::size_t> place_named(std::string_view name);

/// The same, but throws Failure(bad_input) with the nearest name; `where` begins the message ("file.toml:3: ").
std::size_t require_place(std::string_view name, const std::string& where = "");

/// For a board with as many axes as the axis board.
std::vector<std::string> all_parameter_names();

/// "; did you mean x.kalman?": the nearest parameter, group ("x.kalman"), or either without its axis; "" where none is.
std::string parameter_hint(std::string_view name);

/// "V/mm", or "V/mm; linear drive: V/m" where the unit depends on the kind of drive; "1" for a pure number.
std::string unit_text(const firmware::ParameterInfo& info);

/// The shortest number that reads back as the same single: "0.34611428", "true", "1000".
std::string value_text(const firmware::ParameterInfo& info, float value);

/// "x.kalman.k11 = 5.2 is above its maximum 2.0 (1)"; for a set's problem also what does not fit. Never called with
/// ValueRefusal::none.
std::string describe(firmware::ParameterKey key, std::uint8_t set_problem_kind, float value);

}  // namespace host
