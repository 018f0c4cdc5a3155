#include "host/workbench/actions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "host/cancellation.hpp"
#include "host/compare/comparison_report.hpp"
#include "host/compare/look_alike.hpp"
#include "host/compare/tracking_error.hpp"
#include "host/diagnose/addition.hpp"
#include "host/diagnose/adjustment.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/diagnosis_report.hpp"
#include "host/diagnose/improvement_report.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/identification_json.hpp"
#include "host/identify/plausibility.hpp"
#include "host/model/effect_forms.hpp"
#include "host/model/known_parameters.hpp"
#include "host/model/model_file.hpp"
#include "host/opening/opening.hpp"
#include "host/read_file.hpp"
#include "host/record/edit_record.hpp"
#include "host/record/read_record.hpp"
#include "host/report/plot_json.hpp"
#include "host/report/text_format.hpp"
#include "host/workbench/effect_picture.hpp"

namespace host::workbench {

namespace {

void require_files(const Folder& folder, const Request& request) {
  for (const auto* names : {&request.models, &request.train, &request.validate})
    for (const std::string& name : *names) folder.existing(name);
}

/// Refuses records for which the page would wait too long.
void require_short(const Folder& folder, const Request& request) {
  require_files(folder, request);
  std::uintmax_t bytes = 0;
  for (const auto* names : {&request.train, &request.validate})
    for (const std::string& name : *names) bytes += std::filesystem::file_size(name);
  if (bytes * request.models.size() <= kComparedSize.bytes) return;
  throw Failure(
      ExitCode::refused,
      fmt::format("{} MiB of records: {} may have {} MiB, once for each model. Keep only a part of the record: "
                  "axistool cut {} --from S --to S -o PART.csv. Or run it in a shell: {}",
                  bytes * request.models.size() / kMebibyte, kComparedSize.of, kComparedSize.bytes / kMebibyte,
                  shell_word(request.train.front()), command_line(request, {})));
}

/// Shares of the time, by a record of ten million rows: of a model, reading its records; of all, everything but the
/// page.
constexpr double kRead = 0.3, kPredicted = 0.8;

std::vector<ComparedModel> models_with_records(const Request& request, const ShareDone& progress) {
  std::vector<ComparedModel> models;
  for (const std::string& path : request.models) {
    const auto share = [&](double part) {
      return (static_cast<double>(models.size()) + part) / static_cast<double>(request.models.size());
    };
    std::vector<Record> records;
    for (const std::string& record : request.train) {
      records.push_back(read_record(record));
      throw_if_cancelled();
      const double read = static_cast<double>(records.size()) / static_cast<double>(request.train.size());
      if (progress) progress(share(kRead * read));
    }
    models.push_back(compare_with(path, read_model(path), std::move(records), kWindow_s, request.accepted,
                                  part_of(progress, share(kRead), share(1.0))));
    throw_if_cancelled();
  }
  return models;
}

nlohmann::json identified(const Request& request, const Outputs& outputs) {
  const sim::DriveDescription sheet = read_drive(request.models.front());
  const Measurements measured = MeasurementGate(sheet, {request.accepted}).read(request.train);
  const Identification found = identify_drive(measured, sheet, method_named("", measured.training()));
  throw_if_cancelled();
  write_model(found.model, outputs.model);
  nlohmann::json document = identification_json(found);
  document["effort_timing"] = effort_timing_json(measured.training_records());
  document["log"] = log_faults_json(measured.log());
  return document;
}

nlohmann::json diagnosed(const Request& request, const sim::DriveDescription& model, const Measurements& measured,
                         const Outputs& outputs, const ShareDone& progress) {
  const Diagnosis diagnosis = request.quick ? diagnose_quickly(model, measured, request.absent)
                                            : diagnose(model, measured, progress, nullptr, request.absent);
  throw_if_cancelled();
  write_diagnosis_report(diagnosis, request.models.front(), outputs.report);
  return to_json(diagnosis);
}

nlohmann::json added(const Request& request, const sim::DriveDescription& model, const Measurements& measured,
                     const Outputs& outputs) {
  const Addition addition = add_kind(model, request.kind, request.over, measured);
  throw_if_cancelled();
  write_model(addition.judged.model, outputs.model);
  return to_json(addition, request.kind, measured, outputs.model);
}

nlohmann::json adjusted(const Request& request, const sim::DriveDescription& model, const Measurements& measured,
                        const Outputs& outputs) {
  const Adjustment adjustment = adjust(model, with_values(model, request.values), measured);
  throw_if_cancelled();
  write_model(adjustment.model, outputs.model);
  return to_json(adjustment, request.values, measured, outputs.model);
}

nlohmann::json improved(const Request& request, const sim::DriveDescription& model, const Measurements& measured,
                        const Outputs& outputs, const ShareDone& progress) {
  const Improvement improvement = improve(model, measured, progress, request.absent);
  throw_if_cancelled();
  write_model(improvement.model, outputs.model);
  write_improvement_report(improvement, {request.models.front(), outputs.model}, outputs.report);
  nlohmann::json document = to_json(improvement, outputs.model);
  document["warnings"] = messages_of(doubts_of(improvement.model));
  return document;
}

}  // namespace

std::vector<ComparedModel> compared_models(const Folder& folder, const Request& request) {
  require_short(folder, request);
  return models_with_records(request, {});
}

Comparison compare_all(const Folder& folder, const Request& request, const ShareDone& progress) {
  require_files(folder, request);
  const sim::DriveDescription first = read_model(request.models.front());
  if (const std::vector<Record> tracks = tracking_records(request.train, first.data); !tracks.empty()) {
    std::vector<TrackingError> errors;
    for (const Record& record : tracks) errors.push_back(tracking_error(record));
    return {tracking_json(errors), "", tracking_text(errors), ""};
  }
  const std::vector<ComparedModel> models = models_with_records(request, part_of(progress, 0.0, kPredicted));
  const std::size_t traces = record_in(request.focus, models.front().comparison);
  return {comparison_document(models), comparison_report(models, request.focus).html(), "", request.train[traces]};
}

Comparison compare(const Folder& folder, const Request& request) {
  require_short(folder, request);
  return compare_all(folder, request, {});
}

nlohmann::json look_alike(const Folder& folder, const Request& request) {
  if (request.task != Task::compare || request.like.empty())
    throw Failure(ExitCode::usage, "request, \"like\": expected compare with a coordinate");
  Request first = request;
  first.models.resize(1);
  return likeness_json(compared_models(folder, first).front(), request.focus, request.like);
}

Comparison compare_trial(const Folder& folder, const Request& request) {
  if (request.task != Task::adjust) throw Failure(ExitCode::usage, "request, \"do\": expected adjust");
  require_files(folder, request);
  Request comparison;
  comparison.models = {request.models.front(), folder.own_file(kTrial)};
  comparison.train = request.validate.empty() ? request.train : request.validate;
  comparison.accepted = request.accepted;
  write_model(with_values(read_model(request.models.front()), request.values), comparison.models.back());
  return compare(folder, comparison);
}

nlohmann::json look_first(const Folder& folder, const Request& request) {
  if (!request.quick) throw Failure(ExitCode::usage, "request, \"quick\": expected true");
  require_short(folder, request);
  for (const std::string& kind : request.absent) known_effect(kind);
  const sim::DriveDescription model = read_model(request.models.front());
  const Measurements measured =
      MeasurementGate(model, {.accepted = request.accepted}).read(request.train, request.validate);
  try {
    const Diagnosis diagnosis = diagnose_quickly(model, measured, request.absent);
    return {{"document", to_json(diagnosis)},
            {"report", diagnosis_report(diagnosis, request.models.front()).html()},
            {"command", command_line(request, {})}};
  } catch (const Failure& none) {  // a browser would log a refused request as an error
    if (none.code != ExitCode::answer_is_no) throw;
    return {{"document", nullptr}, {"reason", none.what()}};
  }
}

nlohmann::json gallery_picture(const std::string& kind) {
  const EffectPicture picture = picture_of(known_effect(kind));
  return {{"plot", scatter_plot_json(picture.plot)},
          {"title", picture.plot.title},
          {"caption", picture.plot.caption},
          {"stands_out", picture.stands_out},
          {"explained", picture.explained}};
}

nlohmann::json carry_out(const Folder& folder, const Request& request, const Outputs& outputs,
                         const ShareDone& progress) {
  require_files(folder, request);
  if (request.task == Task::identify) return identified(request, outputs);
  for (const std::string& kind : request.absent) known_effect(kind);
  if (request.task == Task::add)
    for (const std::string& kind : added_kinds(request.kind)) known_effect(kind);
  const sim::DriveDescription model = read_model(request.models.front());
  const Measurements measured =
      MeasurementGate(model, {.accepted = request.accepted}).read(request.train, request.validate);
  if (request.task == Task::add) return added(request, model, measured, outputs);
  if (request.task == Task::adjust) return adjusted(request, model, measured, outputs);
  if (request.task == Task::improve) return improved(request, model, measured, outputs, progress);
  return diagnosed(request, model, measured, outputs, progress);
}

nlohmann::json cut_out(const Folder& folder, const CutRequest& request) {
  const std::string text = read_file(folder.existing(request.record), kRecordSize);
  const Record whole = parse_record(text, request.record);
  const std::string stem = std::filesystem::path(request.record).replace_extension().string();
  nlohmann::json pieces = nlohmann::json::array(), commands = nlohmann::json::array();
  const auto keep = [&](const char* option, const char* word, double at_s, double from_s, double to_s) {
    const auto rows = std::ranges::count_if(whole.t_s, [&](double t) { return t >= from_s && t <= to_s; });
    if (rows < static_cast<std::ptrdiff_t>(kFewestRows)) return;
    const Record piece = cut_record(text, request.record, from_s, to_s);
    const std::string name = folder.free_name(fmt::format("{}-{}-{:.4g}s", stem, word, at_s), ".csv");
    write_record(piece, name);
    pieces.push_back(name);
    commands.push_back(
        fmt::format("axistool cut {} {} {} -o {}", shell_word(request.record), option, at_s, shell_word(name)));
  };
  keep("--to", "to", request.stretch.from_s, -HUGE_VAL, request.stretch.from_s);
  keep("--from", "from", request.stretch.to_s, request.stretch.to_s, HUGE_VAL);
  if (pieces.empty()) throw Failure(ExitCode::refused, request.record + ": no rows would remain");
  return {{"pieces", pieces}, {"commands", commands}};
}

nlohmann::json open_and_write(const Folder& folder, const OpenRequest& request) {
  std::string command = "axistool open";
  for (const std::string& log : request.logs) command += fmt::format(" {}", shell_word(folder.existing(log)));
  OpeningOptions options;
  if (const std::string map = fmt::format("{}", fmt::join(request.map, ",")); !map.empty()) {
    command += fmt::format(" --map {}", shell_word(map));
    take_mappings(options, map);
  }
  const Opening opening = open_logs(request.logs, options);
  const std::filesystem::path first(request.logs.front());
  const std::string target =
      folder.free_name(request.logs.size() == 1 ? std::filesystem::path(first).replace_extension().string()
                                                : (first.parent_path() / "records").string(),
                       "");
  std::vector<std::string> written;
  if ((request.yes || opening.asks().empty()) && !opening.records().empty()) written = write_opening(opening, target);
  return {{"document", to_json(opening, written)},
          {"command", fmt::format("{}{} -o {}", command, request.yes ? " --yes" : "", shell_word(target))}};
}

}  // namespace host::workbench
