#include "host/parameters/design_file.hpp"

namespace host {

std::string design_toml(const sim::DriveDescription& model, const AxisDesign& design,
                        const ControlFilterChoice& filters, const ReferenceLimits& limits) {
  core_filters(filters, model.data.sample_period_s);
  return board_parameters_toml(model, design, limits) + compensation_toml(model) + filter_toml(model, filters);
}

nlohmann::json filter_json(const ControlFilterChoice& filters) {
  nlohmann::json document = {{"notch", nullptr}, {"low_pass", nullptr}};
  if (filters.notch)
    document["notch"] = {
        {"f_Hz", filters.notch->f_Hz}, {"damping", filters.notch->damping}, {"depth", filters.notch->depth}};
  if (filters.low_pass)
    document["low_pass"] = {{"f_Hz", filters.low_pass->f_Hz}, {"damping", filters.low_pass->damping}};
  return document;
}

}  // namespace host
