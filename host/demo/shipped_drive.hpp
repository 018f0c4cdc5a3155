// First part of the demonstration: a drive identified from a record of an independent simulator.
#pragma once

#include <string>

#include "host/demo/demo_figure.hpp"
#include "host/report/report.hpp"

namespace host {

/// `folder`: one case of the independent plant with model.toml, train-steps.csv, validate.csv and truth.json.
/// Identifies from the steps and predicts the validation record. Throws Failure(bad_input) if a file is missing.
DemoPart show_shipped_drive(const std::string& folder, Report& report);

}  // namespace host
