// Model files (`axis-model/1`, TOML): a drive's data sheet and its list of effects, with intervals and origins.
#pragma once

#include <string>

#include "sim/drive_description.hpp"

namespace host {

/// Reads a model. Throws Failure(bad_input) naming file, line, field and remedy.
sim::DriveDescription read_model(const std::string& path);

/// Writes a model beside its destination, fsyncs, renames. Throws Failure(bad_input) when it cannot.
void write_model(const sim::DriveDescription& model, const std::string& path);

}  // namespace host
