// identify, compare, diagnose, add, improve, design: the functions of the commands with the same names.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "host/compare/comparison_report.hpp"
#include "host/diagnose/addition.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/diagnosis_report.hpp"
#include "host/diagnose/improvement_report.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/fit/prediction_fit.hpp"
#include "host/identify/design_json.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/identification_json.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/identify/plausibility.hpp"
#include "host/model/effect_forms.hpp"
#include "host/parameters/design_file.hpp"
#include "host/parameters/drive_limits.hpp"
#include "host/plan/plan_json.hpp"
#include "host/plan/posterior.hpp"
#include "host/python/bindings.hpp"
#include "host/python/listening.hpp"
#include "host/python/question.hpp"
#include "host/python/sources.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

Answer identify(const py::sequence& given, const py::object& sheet, const std::string& method,
                const std::string& report, const std::string& gain, const py::sequence& loaded,
                std::optional<double> added_mass, std::optional<double> added_inertia, const std::string& purpose,
                std::optional<double> window_s) {
  const std::vector<RecordSource> sources = record_sources(given, "record");
  const auto drive_file = sheet.is_none() ? std::nullopt : std::optional<ModelSource>(sheet);
  const std::vector<RecordSource> heavier = record_sources(loaded, "loaded record");
  return result_of(py::none(), "identify", [&](const auto&) {
    Names warnings;
    const sim::DriveDescription drive =
        drive_file ? drive_file->read_data_sheet() : host::drive_named_by(sources.at(0).read(), warnings);
    const host::Measurements measured = host::MeasurementGate(drive).admit(read_all(sources));
    std::optional<host::Measurements> with_more;
    std::optional<host::AddedInertia> added;
    if (!heavier.empty()) {
      with_more.emplace(host::MeasurementGate(drive).admit(read_all(heavier)));
      added.emplace(host::AddedInertia{
          *with_more, added_inertia ? *added_inertia : host::inertia_of_mass(added_mass.value_or(0.0), drive.data)});
    }
    host::Identification found = host::identify_with_gain(
        measured, drive, host::method_named(method, measured.training()), {}, host::gain_source_named(gain), added);
    found.warnings.insert(found.warnings.begin(), warnings.begin(), warnings.end());
    std::optional<host::PredictionFit> prediction;
    if (purpose == "prediction")
      prediction = host::fit_for_prediction(found, measured, window_s.value_or(host::kPredictionWindow_s));
    if (!report.empty()) {
      const host::ComparedModel fit =
          host::compare_with(found.model.name, found.model, read_all(sources), host::kWindow_s, {});
      host::comparison_report({&fit, 1}).write(report);
    }
    nlohmann::json document = host::identification_json(found);
    document["effort_timing"] = host::effort_timing_json(measured.training_records());
    if (prediction) {
      document["for"] = purpose;
      document["prediction"] = host::prediction_json(*prediction);
    }
    document["log"] = host::log_faults_json(measured.log());
    return Answer{document.dump(), host::format_model(found.model)};
  });
}

host::ComparedModel compared(const ModelSource& model, const std::vector<RecordSource>& sources, double window_s) {
  const sim::DriveDescription drive = model.read();
  return host::compare_with(model.name(), drive, read_all(sources), window_s, {});
}

std::string compare(const py::object& model, const py::sequence& given, double window_s, const std::string& report) {
  const ModelSource source(model);
  const std::vector<RecordSource> sources = record_sources(given, "record");
  return result_of(py::none(), "compare", [&](const auto&) {
    const host::ComparedModel one = compared(source, sources, window_s);
    if (!report.empty()) host::comparison_report({&one, 1}).write(report);
    return host::comparison_document({&one, 1}).dump();
  });
}

py::tuple predict(const py::object& model, const py::object& given, double window_s) {
  const ModelSource source(model);
  const std::vector<RecordSource> sources{{given, "the record"}};
  return to_python(result_of(py::none(), "predict", [&](const auto&) {
    const host::ComparedModel one = compared(source, sources, window_s);
    return host::RecordColumns{host::predicted_columns(one.model, one.set.records.front().prepared), {}};
  }));
}

std::string diagnose(const py::object& model, const py::sequence& train, const py::sequence& validate, Names hold,
                     Names prior, Names absent, const std::string& believed, const std::string& report,
                     const py::object& progress) {
  const Question asked(model, train, validate, std::move(hold), std::move(prior), std::move(absent));
  return result_of(progress, "diagnose", [&](const host::ShareDone& done) {
    const sim::DriveDescription drive = asked.drive();
    const host::Measurements measured = asked.measurements(drive);
    std::optional<host::Beliefs> beliefs;
    std::optional<host::Decision> decision;
    if (!believed.empty()) {
      beliefs = host::read_beliefs(believed);
      decision = host::decide(drive, *beliefs, measured);
    }
    host::Diagnosis diagnosis = host::diagnose(drive, measured, done, nullptr, asked.absent);
    if (decision) host::apply(*decision, *beliefs, diagnosis);
    if (!report.empty()) host::write_diagnosis_report(diagnosis, asked.model.name(), report);
    nlohmann::json document = host::to_json(diagnosis);
    if (decision) document["decision"] = host::to_json(*decision);
    return document.dump();
  });
}

Answer improve(const py::object& model, const py::sequence& train, const py::sequence& validate, Names hold,
               Names prior, Names absent, const std::string& output, const std::string& report,
               const py::object& progress) {
  const Question asked(model, train, validate, std::move(hold), std::move(prior), std::move(absent));
  return result_of(progress, "improve", [&](const host::ShareDone& done) {
    const sim::DriveDescription drive = asked.drive();
    const host::Measurements measured = asked.measurements(drive);  // the result refers to them
    const host::Improvement improvement = host::improve(drive, measured, done, asked.absent);
    if (!output.empty()) host::write_model(improvement.model, output);
    if (!report.empty()) host::write_improvement_report(improvement, {asked.model.name(), output}, report);
    nlohmann::json document = host::to_json(improvement, output);
    document["warnings"] = host::messages_of(host::doubts_of(improvement.model));
    return Answer{document.dump(), host::format_model(improvement.model)};
  });
}

Answer add(const py::object& model, const std::string& kind, const py::sequence& train, const py::sequence& validate,
           const std::string& over) {
  const Question asked(model, train, validate, {}, {}, {});
  return result_of(py::none(), "add", [&](const auto&) {
    for (const std::string& one : host::added_kinds(kind)) host::known_effect(one);
    const sim::DriveDescription drive = asked.drive();
    const host::Measurements measured = asked.measurements(drive);
    const host::Addition addition = host::add_kind(drive, kind, over, measured);
    return Answer{host::to_json(addition, kind, measured, "").dump(), host::format_model(addition.judged.model)};
  });
}

/// Frequency in Hz, then damping and, for a notch, depth; missing values have their defaults.
host::ControlFilterChoice filters_of(const std::vector<double>& notch, const std::vector<double>& low_pass) {
  host::ControlFilterChoice filters;
  if (!notch.empty()) filters.notch = host::Notch{notch[0]};
  if (notch.size() > 1) filters.notch->damping = notch[1];
  if (notch.size() > 2) filters.notch->depth = notch[2];
  if (!low_pass.empty()) filters.low_pass = host::LowPass{low_pass[0]};
  if (low_pass.size() > 1) filters.low_pass->damping = low_pass[1];
  return filters;
}

Answer design(const py::object& model, std::optional<double> fc, std::optional<double> zeta, std::optional<double> rw,
              std::optional<double> rwd, std::optional<double> ru, std::optional<double> rx,
              const std::vector<double>& notch, const std::vector<double>& low_pass, const std::string& limits,
              double reserve, std::optional<double> velocity) {
  const ModelSource source(model);
  host::DesignOptions options;
  options.tach_variance = rw;
  options.command_variance = ru;
  options.position_variance = rx;
  options.disturbance_variance = rwd.value_or(options.disturbance_variance);
  options.bandwidth_Hz = fc.value_or(options.bandwidth_Hz);
  options.damping = zeta.value_or(options.damping);
  const host::ControlFilterChoice filters = filters_of(notch, low_pass);
  const host::LimitWishes wishes{.reserve = reserve,
                                 .as_the_drive_allows = limits == "drive",
                                 .top_speed_mm_s = velocity,
                                 .measured_Hz = {},
                                 .loop_Hz = options.bandwidth_Hz};
  return result_of(py::none(), "design", [&](const auto&) {
    const sim::DriveDescription drive = source.read(host::Bounds::examined_later);
    host::require_plausible(drive, {});
    const host::AxisDesign found = host::design_axis(drive, options);
    nlohmann::json document = host::design_json(found);
    document["filters"] = host::filter_json(filters);
    const host::DriveLimits found_limits = host::drive_limits(drive, wishes);
    document["limits"] = host::drive_limits_json(found_limits);
    return Answer{document.dump(), host::design_toml(drive, found, filters, found_limits.written)};
  });
}

}  // namespace

void bind_analysis(py::module_& module) {
  module.attr("WINDOW_S") = host::kWindow_s;
  module.def("identify", &identify);
  module.def("compare", &compare);
  module.def("predict", &predict);
  module.def("diagnose", &diagnose);
  module.def("add", &add);
  module.def("improve", &improve);
  module.def("design", &design);
}

}  // namespace axistool_python
