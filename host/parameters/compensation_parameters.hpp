// Board parameters that compensate a model's effects (firmware/core/compensation).
#pragma once

#include <string>
#include <vector>

#include "firmware/core/compensation/compensation_parameters.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct CompensationParameter {
  std::string name;  ///< name in firmware/app/parameters/parameter_table.hpp, without the axis: "cogging.period_1"
  double value;      ///< 0 or 1 for a switch
};

/// All switches, on if the model has the effect; the values of the effects that are on; the tachometer's calibration.
/// Takes the largest harmonics of cogging, as many as the board has.
std::vector<CompensationParameter> compensation_parameters(const sim::DriveDescription& model);

/// TOML tables, one for each group, with meaning and with units for the model's kind of drive.
std::string parameter_tables(const sim::DriveDescription& model, const std::vector<CompensationParameter>& list);

/// The same as TOML tables, to append to board_parameters_toml() of the same model.
std::string compensation_toml(const sim::DriveDescription& model);

/// The same in the control core's form, without the tachometer's calibration. Presliding and friction along the travel
/// need friction feed-forward.
firmware::CompensationParameters<float> core_compensation(const sim::DriveDescription& model);

/// The reading is gain * speed + offset, rad/s (m/s). Gain 1 and offset 0 if the model has no tachometer effect.
struct TachometerReading {
  double gain = 1.0;
  double offset = 0.0;
};
TachometerReading tachometer_reading(const sim::DriveDescription& model);

/// Kinds of the model's effects that neither the feedback design nor the board's feed-forward includes, with a note if
/// harmonics of cogging were left out.
std::vector<std::string> uncompensated_effects(const sim::DriveDescription& model);

}  // namespace host
