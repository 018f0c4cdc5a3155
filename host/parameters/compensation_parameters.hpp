// Board parameters that compensate a model's effects (firmware/core/compensation).
#pragma once

#include <string>
#include <vector>

#include "firmware/core/compensation/compensation_parameters.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct CompensationParameter {
  std::string name;  ///< as in firmware/app/parameters/parameter_table.hpp, without the axis: "cogging.period_1"
  double value;      ///< 0 or 1 for a switch
};

/// Every switch, on where the model has the effect, and the values of those that are on; the tachometer's calibration.
/// Of several coggings, takes the largest, as many as the board has harmonics.
std::vector<CompensationParameter> compensation_parameters(const sim::DriveDescription& model);

/// TOML tables, one a group, with units and meaning as the model's kind of drive has them.
std::string parameter_tables(const sim::DriveDescription& model, const std::vector<CompensationParameter>& list);

/// The same as TOML tables, one a group, to be appended to host::board_parameters_toml() of the same model.
std::string compensation_toml(const sim::DriveDescription& model);

/// The same in the form that the control core takes; presliding and friction along the travel need friction
/// feed-forward, and the tachometer's calibration is not part of it.
firmware::CompensationParameters<float> core_compensation(const sim::DriveDescription& model);

/// Its reading is gain * speed + offset, rad/s (m/s); 1 and 0 if the model has no such effect.
struct TachometerReading {
  double gain = 1.0;
  double offset = 0.0;
};
TachometerReading tachometer_reading(const sim::DriveDescription& model);

/// Kinds of the model's effects that neither the feedback design nor the board's feed-forward includes; and a note if
/// harmonics of cogging were left out.
std::vector<std::string> uncompensated_effects(const sim::DriveDescription& model);

}  // namespace host
