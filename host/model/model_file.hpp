// Model files (`axis-model/1`, TOML): the data sheet of a drive and its list of effects, with intervals and origins.
#pragma once

#include <string>
#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

/// Whether the reader rejects values outside their physical bounds, or accepts them so that doubts_of() can report
/// them.
enum class Bounds { enforced, examined_later };

/// Reads a model. Throws Failure(bad_input) with file, line, field and remedy. An unknown field is an error, and so is
/// an interval that does not contain its value.
sim::DriveDescription read_model(const std::string& path, Bounds bounds = Bounds::enforced);

/// Reads the data sheet of a drive: a model file whose effects may be absent.
sim::DriveDescription read_drive(const std::string& path);

/// read_model and read_drive from text that is already in memory; `name` stands for the path in messages.
sim::DriveDescription parse_model(std::string_view text, std::string_view name, Bounds bounds = Bounds::enforced);
sim::DriveDescription parse_drive(std::string_view text, std::string_view name);

/// Writes a model to a temporary file beside its destination, calls fsync and renames it. Reading it again gives
/// exactly the same numbers, and the effects in the same order. Throws Failure(bad_input) if it cannot.
void write_model(const sim::DriveDescription& model, const std::string& path);

/// The text that write_model() writes. Throws Failure(bad_input) if an effect or parameter is not in the catalogue.
std::string format_model(const sim::DriveDescription& model);

}  // namespace host
