#include "host/interchange/export_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "host/compare/effort_prediction.hpp"
#include "host/identify/inverse_model.hpp"

namespace host {

namespace {

constexpr std::array<std::string_view, 6> kNames{"mjcf", "urdf", "linuxcnc", "c", "modelica", "python"};

std::set<std::string> expressed_by(ExportTarget target) {
  switch (target) {
    case ExportTarget::mjcf:
      return {"inertia", "viscous", "coulomb", "spring_torque"};
    case ExportTarget::urdf:
      return {"viscous", "coulomb"};
    default:
      return portable_kinds();
  }
}

/// The share of the squared torque or force by which two models differ on a record.
std::optional<double> share_of(const sim::DriveDescription& whole, const sim::DriveDescription& part,
                               const Record* record) {
  if (record == nullptr) return std::nullopt;
  const sim::Drive with(whole), without(part);
  if (!has_inverse(with) || !has_inverse(without)) return std::nullopt;
  const EffortRecord prepared = prepare_effort(*record, whole);
  EffortPrediction a, b;
  predict_effort(with, prepared, a);
  predict_effort(without, prepared, b);
  double difference = 0.0, all = 0.0;
  for (std::size_t k = 0; k < prepared.counts.size(); ++k) {
    if (!prepared.counts[k]) continue;
    const double change = (a.needed[k] - b.needed[k]) - (a.given[k] - b.given[k]);
    difference += change * change;
    all += a.given[k] * a.given[k];
  }
  return all > 0.0 ? std::optional(difference / all) : std::nullopt;
}

sim::DriveDescription without(const sim::DriveDescription& model, std::string_view kind) {
  sim::DriveDescription part = model;
  std::erase_if(part.effects, [&](const sim::EffectEntry& entry) { return entry.kind == kind; });
  return part;
}

/// The model without the effects that have no inverse. With it, the size of the other effects can be computed.
sim::DriveDescription invertible(const sim::DriveDescription& model) {
  sim::DriveDescription part = model;
  part.effects.clear();
  for (const sim::EffectEntry& entry : model.effects) {
    part.effects.push_back(entry);
    if (!has_inverse(sim::Drive(part))) part.effects.pop_back();
  }
  return part;
}

/// Notes that the format has only one friction level for both directions.
void note_levels(const sim::DriveDescription& model, const PortableModel& formulas, const Record* record,
                 std::vector<NotExpressed>& out) {
  if (formulas.friction[0].coulomb == formulas.friction[1].coulomb) return;
  if (std::ranges::any_of(out, [](const NotExpressed& n) { return n.kind == "coulomb_asymmetry"; })) return;
  sim::DriveDescription part = model;
  for (sim::EffectEntry& entry : part.effects)
    if (entry.kind == "coulomb") entry.parameters = {{"level", symmetric(formulas).level}};
  out.push_back({"coulomb_asymmetry", share_of(model, part, record)});
}

std::vector<std::string> notes_of(const sim::DriveDescription& model, std::string_view to, const Export& exported,
                                  const Record* record) {
  std::vector<std::string> notes{
      fmt::format("{}: model {} for {}, by axistool export", model.name.empty() ? "axis" : model.name, model.name, to)};
  if (exported.not_expressed.empty()) notes.emplace_back("This file expresses the whole model.");
  for (const NotExpressed& left_out : exported.not_expressed)
    notes.push_back(fmt::format("Not expressed: {}{}", left_out.kind,
                                left_out.share
                                    ? fmt::format(", {:.2g} % of the squared effort of {}", 100.0 * *left_out.share,
                                                  std::filesystem::path(record->path).filename().string())
                                : record != nullptr ? ", whose size does not follow from the effort alone"
                                                    : "; export --record RECORD computes its size"));
  return notes;
}

}  // namespace

std::optional<ExportTarget> export_target(std::string_view name) {
  const auto* const found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<ExportTarget>(found - kNames.begin());
}

Export export_model(const sim::DriveDescription& model, ExportTarget target, const std::string& path,
                    const Record* record) {
  const PortableModel formulas = portable(model);
  Export exported;
  exported.to = kNames[static_cast<std::size_t>(target)];
  const std::set<std::string> expressed = expressed_by(target);
  const sim::DriveDescription measured = invertible(model);
  for (const sim::EffectEntry& entry : model.effects) {
    if (expressed.contains(entry.kind)) continue;
    if (std::ranges::any_of(exported.not_expressed, [&](const NotExpressed& n) { return n.kind == entry.kind; }))
      continue;
    const bool shows =
        entry.kind != "inertia" && measured.find(entry.kind) != nullptr;  // a drive without inertia has no inverse
    exported.not_expressed.push_back(
        {entry.kind, shows ? share_of(measured, without(measured, entry.kind), record) : std::nullopt});
  }
  if (target == ExportTarget::mjcf || target == ExportTarget::urdf)
    note_levels(measured, formulas, record, exported.not_expressed);
  std::vector<std::string> notes = notes_of(model, exported.to, exported, record);
  const std::filesystem::path file(path);
  const std::string component = identifier(file.stem().string());
  if (target == ExportTarget::linuxcnc && file.filename() != component + ".comp")
    notes.push_back(fmt::format(
        "halcompile requires the file name to be the component's name: rename this file to {}.comp.", component));
  switch (target) {
    case ExportTarget::mjcf:
      exported.files.push_back({path, mjcf_joint(formulas, notes)});
      break;
    case ExportTarget::urdf:
      exported.files.push_back({path, urdf_joint(formulas, notes)});
      break;
    case ExportTarget::linuxcnc:
      exported.files.push_back({path, hal_component(formulas, component, notes)});
      exported.files.push_back(
          {std::filesystem::path(path).replace_extension(".hal").string(), hal_lines(formulas, component)});
      break;
    case ExportTarget::c:
      exported.files.push_back({path, c_header(formulas, notes)});
      break;
    case ExportTarget::modelica:
      exported.files.push_back({path, modelica_model(formulas, notes)});
      break;
    case ExportTarget::python:
      exported.files.push_back({path, python_module(formulas, notes)});
      break;
  }
  return exported;
}

nlohmann::json to_json(const Export& exported) {
  nlohmann::json files = nlohmann::json::array(), left_out = nlohmann::json::array();
  for (const ExportedFile& file : exported.files) files.push_back(file.path);
  for (const NotExpressed& one : exported.not_expressed)
    left_out.push_back({{"kind", one.kind}, {"share", one.share ? nlohmann::json(*one.share) : nlohmann::json()}});
  return {{"format", "axis-export/1"},
          {"to", exported.to},
          {"files", std::move(files)},
          {"not_expressed", std::move(left_out)}};
}

}  // namespace host
