// Notch and low-pass filters of a design, after the feedback (firmware/core/control/control_filter.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/core/control/control_filter.hpp"
#include "host/parameters/compensation_parameters.hpp"

namespace host {

struct Notch {
  double f_Hz = 0.0;
  double damping = 0.5;  ///< half width relative to the frequency
  double depth = 0.1;    ///< gain at the frequency
};
struct LowPass {
  double f_Hz = 0.0;
  double damping = 0.7;
};
struct ControlFilterChoice {
  std::optional<Notch> notch;
  std::optional<LowPass> low_pass;
};

/// Both switches, and the values of the filters that are on.
std::vector<CompensationParameter> filter_parameters(const ControlFilterChoice& choice);

/// The same as TOML tables, to append to board_parameters_toml() of the same model.
std::string filter_toml(const sim::DriveDescription& model, const ControlFilterChoice& choice);

/// The same in the control core's form. Throws Failure(bad_input) for a value out of its range, or a frequency not
/// below 0.45 of the control rate.
firmware::FilterParameters<float> core_filters(const ControlFilterChoice& choice, double sample_period_s);

}  // namespace host
