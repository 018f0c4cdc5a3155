// Names of parameters for users: "x.kalman.k11", "control.rate".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"

namespace host {

/// The table row of the value at this place (firmware/app/parameters/parameter_values.hpp).
const firmware::ParameterInfo& info_at(std::size_t place);

/// The name with its axis.
std::string full_name(std::size_t place);
std::string full_name(firmware::ParameterKey key);  ///< "id N" for a key that the table does not have

/// Empty for an unknown name. A board with fewer axes may lack this place.
std::optional<std::size_t> place_named(std::string_view name);

/// The same, but throws Failure(bad_input) with the nearest name; `where` begins the message ("file.toml:3: ").
std::size_t require_place(std::string_view name, const std::string& where = "");

/// All names, for a board with as many axes as the axis board.
std::vector<std::string> all_parameter_names();

/// "; did you mean x.kalman?": the nearest parameter or group ("x.kalman"), with or without its axis; "" if none is
/// near.
std::string parameter_hint(std::string_view name);

/// "V/mm", or "V/mm; linear drive: V/m" if the unit depends on the kind of drive; "1" for a pure number.
std::string unit_text(const firmware::ParameterInfo& info);

/// The shortest text that reads back as the same float: "0.34611428", "true", "1000".
std::string value_text(const firmware::ParameterInfo& info, float value);

/// "x.kalman.k11 = 5.2 is above its maximum 2.0 (1)"; for a problem of the whole set also the values that do not fit.
/// Must not be called with ValueRefusal::none.
std::string describe(firmware::ParameterKey key, std::uint8_t set_problem_kind, float value);

}  // namespace host
