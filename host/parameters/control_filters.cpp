#include "host/parameters/control_filters.hpp"

#include <fmt/format.h>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

std::vector<CompensationParameter> filter_parameters(const ControlFilterChoice& choice) {
  std::vector<CompensationParameter> list = {{"notch.on", choice.notch ? 1.0 : 0.0}};
  if (choice.notch) {
    list.push_back({"notch.frequency", choice.notch->f_Hz});
    list.push_back({"notch.damping", choice.notch->damping});
    list.push_back({"notch.depth", choice.notch->depth});
  }
  list.push_back({"low_pass.on", choice.low_pass ? 1.0 : 0.0});
  if (choice.low_pass) {
    list.push_back({"low_pass.frequency", choice.low_pass->f_Hz});
    list.push_back({"low_pass.damping", choice.low_pass->damping});
  }
  return list;
}

std::string filter_toml(const sim::DriveDescription& model, const ControlFilterChoice& choice) {
  return parameter_tables(model, filter_parameters(choice));
}

firmware::FilterParameters<float> core_filters(const ControlFilterChoice& choice, double sample_period_s) {
  firmware::ParameterValues values;
  const auto set = [&](const std::string& name, double value) {
    const std::size_t place = require_place("x." + name);
    if (firmware::check_value(firmware::rule_at(place), static_cast<float>(value)) != firmware::ValueRefusal::none)
      throw Failure(ExitCode::bad_input, fmt::format("{} = {:g} is out of its range, {:g} to {:g}", name, value,
                                                     info_at(place).minimum, info_at(place).maximum));
    values.set(place, static_cast<float>(value));
  };
  set("drive.sample_period", sample_period_s);
  for (const CompensationParameter& parameter : filter_parameters(choice)) set(parameter.name, parameter.value);
  for (const double f_Hz : {choice.notch ? choice.notch->f_Hz : 0.0, choice.low_pass ? choice.low_pass->f_Hz : 0.0})
    if (!(f_Hz * sample_period_s < 0.45))
      throw Failure(ExitCode::bad_input,
                    fmt::format("a filter at {:g} Hz is not below 0.45 of the control rate, {:g} Hz", f_Hz,
                                1.0 / sample_period_s));
  return firmware::axis_parameters<float>(values.axis(0)).filters;
}

}  // namespace host
