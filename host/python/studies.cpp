// friction, plan, bode, circle, export, effects, scoreboard: the functions of the commands with the same names.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/axes/circle_report.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/evidence/presumed_sheet.hpp"
#include "host/identify/friction_json.hpp"
#include "host/interchange/export_model.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/plan/plan_json.hpp"
#include "host/plan/plan_report.hpp"
#include "host/python/bindings.hpp"
#include "host/python/listening.hpp"
#include "host/python/question.hpp"
#include "host/record/channel_checks.hpp"
#include "host/report/effect_pages.hpp"
#include "host/response/model_starts.hpp"
#include "host/response/response_report.hpp"
#include "host/scoreboard/scoreboard.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

Answer friction(const py::sequence& given, const py::object& model, const std::string& method, double settle_s,
                double shortest_s) {
  const std::vector<RecordSource> sources = record_sources(given, "record");
  const ModelSource source(model);
  return result_of(py::none(), "friction", [&](const auto&) {
    const sim::DriveDescription drive = source.read();
    const host::Measurements measured = host::MeasurementGate(drive).admit(read_all(sources));
    host::ConstantSpeedOptions options;
    options.settle_s = settle_s;
    options.shortest_s = shortest_s;
    const host::FrictionIdentification found =
        host::identify_friction(measured, drive, host::friction_method_named(method), options);
    nlohmann::json document = host::friction_json(found);
    document["log"] = host::log_faults_json(measured.log());
    return Answer{document.dump(), host::format_model(found.model)};
  });
}

/// Returns the document, and the text of the run's file (empty without a run).
Answer plan(const py::object& model, const py::sequence& train, const py::sequence& validate,
            const std::vector<Names>& rivals, const std::string& box, double most_steps, const std::string& output,
            const std::string& report, const py::object& progress) {
  const Question asked(model, train, validate, {}, {}, {});
  return result_of(progress, "plan", [&](const host::ShareDone& done) {
    const sim::DriveDescription drive = asked.drive();
    const host::ExcitationLimits limits = host::parse_box(box, drive.data.kind);
    const host::Measurements measured = asked.measurements(drive);
    const std::vector<const host::Record*> all = measured.all_records();
    const auto half = [&](double from) { return [&done, from](double share) { done(from + 0.5 * share); }; };
    const std::vector<host::Rival> fitted = host::rivals_for(drive, measured, all, rivals, half(0.0));
    host::PlanOptions options;
    options.most_steps = most_steps;
    const host::Plan found = host::plan_run(drive, all, fitted, limits, options, half(0.5));
    if (found.separable && !output.empty()) host::write_run_plan(found.run, output);
    if (!report.empty()) host::write_plan_report(found, asked.model.name(), output, report);
    return Answer{host::to_json(found, output).dump(), found.separable ? host::run_plan_toml(found.run) : ""};
  });
}

/// The controller with `parameters` (text of a file), else the one that design makes from the model.
std::optional<firmware::AxisParameters<float>> controller_of(const std::optional<sim::DriveDescription>& model,
                                                             const std::string& parameters) {
  if (!parameters.empty()) {
    firmware::ParameterValues values;
    for (const host::Assignment& one : host::parse_parameter_text(parameters, "the parameters", "x"))
      host::put(values, one);
    return firmware::axis_parameters<float>(values.axis(0));
  }
  if (!model) return std::nullopt;
  return host::designed_parameters(*model, host::design_axis(*model, {}));
}

/// Returns the document, and the text of the model with the measured effects (empty without a model or a fit).
Answer bode(const py::sequence& given, const py::object& model, const std::string& parameters,
            const std::string& report) {
  const std::vector<RecordSource> sources = record_sources(given, "record");
  const auto source = model.is_none() ? std::nullopt : std::optional<ModelSource>(model);
  return result_of(py::none(), "bode", [&](const auto&) {
    const auto drive = source ? std::optional(source->read()) : std::nullopt;
    const auto controller = controller_of(drive, parameters);
    std::vector<host::Record> records = read_all(sources);
    const sim::DriveDescription sheet = drive ? *drive : host::presumed_sheet(records.at(0));
    const host::Measurements measured = host::MeasurementGate(sheet).admit(std::move(records));
    const host::AxisResponse axis = host::analyse_response(measured.training(), controller ? &*controller : nullptr);
    if (!report.empty())
      host::response_report(axis, fmt::format("{} records", measured.training().size())).write(report);
    nlohmann::json document = host::response_json(axis);
    if (!drive || !axis.fit) return Answer{document.dump(), ""};
    const host::ModelStarts starts = host::with_response(*drive, *axis.fit, "axistool bode");
    document["said"] = starts.said;
    return Answer{document.dump(), host::format_model(starts.model)};
  });
}

std::string circle(const py::sequence& given, const py::sequence& models, const std::string& report) {
  const std::vector<RecordSource> sources = record_sources(given, "record");
  std::vector<ModelSource> axes;
  for (const py::handle& one : models) axes.emplace_back(one);
  return result_of(py::none(), "circle", [&](const auto&) {
    host::CircleDiagnosis diagnosis = host::diagnose_circle(host::circle_passes(read_all(sources)));
    for (const ModelSource& axis : axes) host::tell_turns(diagnosis, axis.read(), axis.name());
    if (!report.empty()) host::circle_report(diagnosis, names_of(sources)).write(report);
    return host::circle_json(diagnosis).dump();
  });
}

/// Returns the document, and path and text of each file.
std::pair<std::string, std::vector<std::pair<std::string, std::string>>> export_model(const py::object& model,
                                                                                      const std::string& to,
                                                                                      const std::string& path,
                                                                                      const py::object& record) {
  const ModelSource source(model);
  const auto given = record.is_none() ? std::nullopt : std::optional<RecordSource>(std::in_place, record, "the record");
  const host::Export exported = result_of(py::none(), "export", [&](const auto&) {
    const sim::DriveDescription drive = source.read();
    const auto target = host::export_target(to);
    if (!target)
      throw host::Failure(host::ExitCode::usage,
                          fmt::format("--to: {} not in {{mjcf,urdf,linuxcnc,c,modelica,python}}", to));
    std::optional<host::Record> judge;
    if (given) {
      judge = given->read();
      host::adapt_to(*judge, drive.data);
    }
    return host::export_model(drive, *target, path, judge ? &*judge : nullptr);
  });
  std::vector<std::pair<std::string, std::string>> files;
  for (const host::ExportedFile& file : exported.files) files.emplace_back(file.path, file.text);
  return {host::to_json(exported).dump(), files};
}

std::string scoreboard(const std::string& folder, bool cuts, std::size_t sample, std::uint64_t seed, std::size_t nulls,
                       const py::object& progress) {
  return result_of(progress, "scoreboard", [&](const Told& done) {
    const host::ScoreboardOptions options{folder, cuts, sample, seed, nulls};
    std::vector<host::Answer> answers;
    const std::vector<host::Trial> trials = host::scoreboard_trials(options).trials;
    const auto all = static_cast<double>(trials.size() + nulls);
    const auto share = [&] { return static_cast<double>(answers.size()) / all; };
    for (const host::Trial& trial : trials) {
      answers.push_back(host::run_trial(trial));
      done(share());
    }
    for (std::size_t k = 0; k < nulls; ++k) {
      answers.push_back(host::scoreboard_null(options, k));
      done(share());
    }
    return host::scoreboard_json(answers).dump();
  });
}

}  // namespace

void bind_studies(py::module_& module) {
  module.attr("MOST_STEPS") = host::PlanOptions{}.most_steps;
  module.def("friction", &friction);
  module.def("plan", &plan);
  module.def("bode", &bode);
  module.def("circle", &circle);
  module.def("export_model", &export_model);
  module.def("effects", [](const std::string& kind) {
    return (kind.empty() ? host::effects_json() : host::effects_json(host::known_effect(kind))).dump();
  });
  module.def("scoreboard", &scoreboard);
}

}  // namespace axistool_python
