// Notch and low-pass after the feedback (firmware/core/control/control_filter.hpp), as chosen by a design.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/core/control/control_filter.hpp"
#include "host/parameters/compensation_parameters.hpp"

namespace host {

struct Notch {
  double f_Hz = 0.0;
  double damping = 0.5;  ///< half its width over its frequency
  double depth = 0.1;    ///< remaining gain at its frequency
};
struct LowPass {
  double f_Hz = 0.0;
  double damping = 0.7;
};
struct ControlFilterChoice {
  std::optional<Notch> notch;
  std::optional<LowPass> low_pass;
};

/// Both switches, and the values of those that are on.
std::vector<CompensationParameter> filter_parameters(const ControlFilterChoice& choice);

/// The same as TOML tables behind host::board_parameters_toml() of the same model.
std::string filter_toml(const sim::DriveDescription& model, const ControlFilterChoice& choice);

/// The same in the form that the control core takes. Throws Failure(bad_input) for a value out of its range, or not
/// below 0.45 of the control rate.
firmware::FilterParameters<float> core_filters(const ControlFilterChoice& choice, double sample_period_s);

}  // namespace host
