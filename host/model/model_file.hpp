// Model files (`axis-model/1`, TOML): a drive's data sheet and its list of effects, with intervals and origins.
#pragma once

#include <string>
#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

/// Whether a reader refuses values outside their physical bounds, or accepts them for doubts_of() to report.
enum class Bounds { enforced, examined_later };

/// Reads a model. Throws Failure(bad_input) naming file, line, field and remedy; an unknown field is an error too, and
/// so is an interval that does not contain its value.
sim::DriveDescription read_model(const std::string& path, Bounds bounds = Bounds::enforced);

/// Reads the data sheet of a drive: a model file whose effects may be absent.
sim::DriveDescription read_drive(const std::string& path);

/// read_model and read_drive from text that is already in memory; `name` stands for the path in messages.
sim::DriveDescription parse_model(std::string_view text, std::string_view name, Bounds bounds = Bounds::enforced);
sim::DriveDescription parse_drive(std::string_view text, std::string_view name);

/// Writes a model beside its destination, fsyncs, renames. Reading it again gives the same numbers to the last bit, and
/// the effects in the same order. Throws Failure(bad_input) when it cannot.
void write_model(const sim::DriveDescription& model, const std::string& path);

/// The text of write_model. Throws Failure(bad_input) where an effect or parameter is not in the catalogue.
std::string format_model(const sim::DriveDescription& model);

}  // namespace host
