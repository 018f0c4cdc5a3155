// Exports models to other programs, with the list of effects that these cannot express and the resulting error on a
// record.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/interchange/portable_model.hpp"
#include "host/record/record.hpp"

namespace host {

enum class ExportTarget { mjcf, urdf, linuxcnc, c, modelica, python };

/// "mjcf", "urdf", …; empty for an unknown name.
std::optional<ExportTarget> export_target(std::string_view name);

struct NotExpressed {
  std::string kind;
  std::optional<double> share;  ///< of the squared torque or force; empty if it is not known
};

struct ExportedFile {
  std::string path, text;
};

struct Export {
  std::string to;
  std::vector<ExportedFile> files;
  std::vector<NotExpressed> not_expressed;
};

/// `path`: the file to write; LinuxCNC gets further files beside it. `record`, adapted to the model, gives the error due to
/// the omitted effects. Throws Failure(bad_input) if the record is too short for the filter.
Export export_model(const sim::DriveDescription& model, ExportTarget target, const std::string& path,
                    const Record* record);

nlohmann::json to_json(const Export& exported);

/// The model as text in each format. `notes` are lines without a comment sign; they become comments at the start.
std::string c_header(const PortableModel& model, const std::vector<std::string>& notes);
std::string python_module(const PortableModel& model, const std::vector<std::string>& notes);
std::string modelica_model(const PortableModel& model, const std::vector<std::string>& notes);
std::string hal_component(const PortableModel& model, const std::string& component,
                          const std::vector<std::string>& notes);
std::string hal_lines(const PortableModel& model, const std::string& component);
std::string mjcf_joint(const PortableModel& model, const std::vector<std::string>& notes);
std::string urdf_joint(const PortableModel& model, const std::vector<std::string>& notes);

/// Friction as in MJCF and URDF: one viscous coefficient and one level for both directions.
struct SymmetricFriction {
  double viscous = 0.0, level = 0.0;
};
SymmetricFriction symmetric(const PortableModel& model);

/// A name that is valid in C, Modelica, XML and HAL.
std::string identifier(std::string_view name);

}  // namespace host
