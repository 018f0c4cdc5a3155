#include "host/parameters/data_sheet_values.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

std::size_t place_of(std::size_t axis, std::string_view name) {
  return require_place(fmt::format("{}.{}", firmware::kAxisNames.at(axis), name));
}

}  // namespace

firmware::ParameterValues with_data_sheet(firmware::ParameterValues values, std::size_t axis,
                                          const sim::DataSheet& data) {
  require_volts(data, firmware::kAxisNames.at(axis), "a board");
  if (!(data.encoder_resolution > 0.0) || !(data.dac_resolution_V > 0.0))
    throw Failure(ExitCode::bad_input,
                  "the data sheet lacks the resolution of the encoder or of the converter: add [drive.encoder] "
                  "resolution_mm = … and [drive.dac] resolution_V = …, limit_V = …");
  values.set(place_of(axis, "drive.lead"), static_cast<float>(data.lead));
  values.set(place_of(axis, "drive.encoder_resolution"), static_cast<float>(data.encoder_resolution));
  values.set(place_of(axis, "drive.dac_resolution"), static_cast<float>(data.dac_resolution_V));
  values.set(place_of(axis, "drive.dac_limit"), static_cast<float>(data.dac_limit_V));
  values.set(place_of(axis, "tachometer.fitted"), data.tach_noise_variance ? 1.0F : 0.0F);
  return values;
}

bool has_initial_scales(const firmware::ParameterValues& values, std::size_t axis) {
  const firmware::ParameterValues initial(values.axes());
  for (const char* name : {"drive.lead", "drive.encoder_resolution", "drive.dac_resolution"}) {
    const std::size_t place = place_of(axis, name);
    if (values.at(place) != initial.at(place)) return false;
  }
  return true;
}

}  // namespace host
