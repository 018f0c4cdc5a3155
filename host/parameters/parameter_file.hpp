// Board parameters in files (`axis-params/1`, TOML) and on the command line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/store/stored_set.hpp"

namespace host {

struct Assignment {
  std::size_t place = 0;
  float value = 0;
};

/// Reads a file of parameters, which may contain only some of them. `axis` ("x", "y" or empty): the board's axis for a
/// file with a single axis of another name (`design` names it after the model). Throws Failure(bad_input) naming file,
/// line, parameter, range and unit.
std::vector<Assignment> read_parameter_file(const std::string& path, std::string_view axis = {});
std::vector<Assignment> parse_parameter_text(std::string_view text, std::string_view name, std::string_view axis = {});

/// "x.kalman.k11=0.3". Throws Failure(usage).
Assignment parse_assignment(std::string_view text);

/// Throws Failure(bad_input) for an axis that the board does not have.
void put(firmware::ParameterValues& values, const Assignment& one);

/// The same for all assignments of a file. Also throws as read_parameter_file().
void put_file(firmware::ParameterValues& values, const std::string& path, std::string_view axis = {});

/// Throws Failure(bad_input) if the values do not fit together, as far as the host can check it.
void require_fitting_set(const firmware::ParameterValues& values);

}  // namespace host
