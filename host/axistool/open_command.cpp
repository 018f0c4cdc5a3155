// axistool open: makes records from any controller's logs and diagnoses them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>

#include "host/atomic_file.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/insight_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/diagnosis_report.hpp"
#include "host/diagnose/log_to_verdict.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/identify/identification_json.hpp"
#include "host/model/model_file.hpp"
#include "host/model/sheet_text.hpp"
#include "host/opening/next_run.hpp"
#include "host/opening/opening.hpp"

namespace axistool {

namespace {

struct OpenArguments {
  std::vector<std::string> logs, accepted;
  std::string sheet, map, hal, folder, json, drive;
  double torque_constant = 0.0, period_s = 0.0;
  bool yes = false;
};

host::OpeningOptions options_of(const OpenArguments& arguments) {
  host::OpeningOptions options;
  if (!arguments.sheet.empty()) options.hints.sheet = host::read_drive(arguments.sheet).data;
  if (arguments.torque_constant > 0.0) options.hints.torque_constant = arguments.torque_constant;
  if (arguments.period_s > 0.0) options.hints.period_s = arguments.period_s;
  host::take_map(options, arguments.map);
  options.hal_path = arguments.hal;
  options.hints.drive = arguments.drive;
  return options;
}

void print(const host::OpenedFile& file) {
  fmt::print("{}: {}, {}\n", file.path, file.understood.layout,
             file.understood.rate_Hz > 0.0 ? fmt::format("{:.6g} Hz", file.understood.rate_Hz) : "rate not known");
  fmt::print("  {:<28} {:<12} {:<12} {:>5}  {}\n", "channel", "taken as", "factor", "sure", "why");
  for (const host::OpenedChannel& channel : file.understood.channels)
    fmt::print("  {:<28} {:<12} {:<12} {:4.0f}%  {}\n", channel.name, channel.taken_as.empty() ? "-" : channel.taken_as,
               channel.taken_as.empty() ? "" : fmt::format("{:.6g}", channel.factor), 100.0 * channel.sure,
               channel.why);
  for (const host::OpenedAxis& axis : file.understood.axes)
    if (const std::string words = host::constants_words(axis.constants); axis.makes_record && !words.empty())
      fmt::print("  {}the log shows: {}\n", axis.name.empty() ? "" : axis.name + ": ", words);
  for (const std::string& text : file.understood.missing) fmt::print("  missing: {}\n", text);
  if (const std::string next = host::next_run(file.understood); !next.empty()) fmt::print("  next: {}\n", next);
}

/// Asks on the terminal; without a terminal, only --yes accepts.
bool is_accepted(const host::Opening& opening, bool yes) {
  const std::vector<std::string> asks = opening.asks();
  if (asks.empty() || opening.records().empty() || yes) return true;
  if (isatty(STDIN_FILENO) == 0) return false;
  for (const std::string& ask : asks) {
    fmt::print(stderr, "{}\n  right? [y/N] ", ask);
    std::string answer;
    if (!std::getline(std::cin, answer) || (answer != "y" && answer != "Y" && answer != "yes")) return false;
  }
  return true;
}

bool wants_verdict(const OpenArguments& arguments) {
  return !arguments.sheet.empty() || arguments.torque_constant > 0.0;
}

/// Identifies and diagnoses one axis of the logs; writes its model and page beside the records.
nlohmann::json judge(const OpenArguments& arguments, const host::Opening& opening, const std::string& axis) {
  std::vector<host::Record> records;
  for (const host::OpenedRecord* record : opening.records())
    if (record->axis == axis) records.push_back(record->record);
  const auto lead = opening.files.front().understood.lead_mm_per_rad;
  const sim::DriveDescription sheet =
      arguments.sheet.empty() ? host::sheet_of_constant(records, arguments.torque_constant, lead.value_or(0.0))
                              : host::read_drive(arguments.sheet);
  std::unique_ptr<host::LogVerdict> found;
  {
    SearchProgress progress("diagnose");
    found = host::verdict_of(std::move(records), sheet, arguments.accepted, progress.callback());
  }
  nlohmann::json document = {{"axis", axis},
                             {"identification", host::identification_json(found->identification)},
                             {"verdict", host::to_json(found->diagnosis)["verdict"]},
                             {"log", host::log_faults_json(found->measured.log())}};
  if (!arguments.folder.empty()) {
    const std::filesystem::path folder(arguments.folder);
    document["model"] = (folder / host::name_for_axis("model", axis, ".toml")).string();
    document["page"] = (folder / host::name_for_axis("page", axis, ".html")).string();
    host::write_model(found->diagnosis.best, document["model"].get<std::string>());
    host::write_diagnosis_report(found->diagnosis, sheet.name, document["page"].get<std::string>());
  }
  if (arguments.json == "-") return document;
  print_log(found->measured.log());
  const host::DiagnosisVerdict& verdict = found->diagnosis.verdict;
  fmt::print("\n{}verdict: {}{}{}\n  {}\n  next: {}\n", axis.empty() ? "" : axis + ": ",
             host::status_name(verdict.status), verdict.effects.empty() ? "" : ": ", fmt::join(verdict.effects, " + "),
             verdict.explanation, verdict.next_experiment);
  return document;
}

/// The same for every axis that has records; a refusal of one axis does not stop the others.
nlohmann::json judge_all(const OpenArguments& arguments, const host::Opening& opening) {
  std::vector<std::string> axes;
  for (const host::OpenedRecord* record : opening.records())
    if (std::ranges::find(axes, record->axis) == axes.end()) axes.push_back(record->axis);
  nlohmann::json all = nlohmann::json::array();
  for (const std::string& axis : axes) {
    try {
      all.push_back(judge(arguments, opening, axis));
    } catch (const host::Failure& failure) {
      all.push_back({{"axis", axis}, {"refused", failure.what()}});
      if (arguments.json != "-") fmt::print("\n{}no verdict: {}\n", axis.empty() ? "" : axis + ": ", failure.what());
      end_with(failure.code);
    }
  }
  return all;
}

/// Writes a data sheet for each axis, filled in as far as the log and --kt allow, and lists the missing fields. Keeps
/// an existing sheet, because it may have been filled in by hand.
std::vector<std::string> write_sheets(const OpenArguments& arguments, const host::Opening& opening) {
  std::vector<std::string> written;
  for (const host::OpenedRecord* opened : opening.records()) {
    const std::string path =
        (std::filesystem::path(arguments.folder) / host::name_for_axis("sheet", opened->axis, ".toml")).string();
    if (std::filesystem::exists(path)) continue;
    const host::Record& record = opened->record;
    host::SheetValues values;
    values.name = !record.drive.empty() ? record.drive : !opened->axis.empty() ? opened->axis : "axis";
    values.kind = record.kind;
    values.by_current = !record.i_A.empty();
    if (arguments.torque_constant > 0.0) values.motor_constant = arguments.torque_constant;
    values.sample_period_s = record.sample_period_s;
    if (const auto lead = opening.files.front().understood.lead_mm_per_rad)
      values.lead_mm_per_turn = *lead * 2.0 * std::numbers::pi;
    for (const host::OpenedFile& file : opening.files)
      for (const host::OpenedAxis& axis : file.understood.axes)
        if (axis.name == opened->axis && !values.encoder_step_mm)
          values.encoder_step_mm = axis.constants.encoder_step_mm;
    host::write_file_atomically(path, host::sheet_text(values));
    const std::string missing = host::sheet_gaps(values);
    written.push_back(path + (missing.empty() ? "" : fmt::format(" (a data sheet; fill in {})", missing)));
  }
  return written;
}

void run(const OpenArguments& arguments) {
  const host::Opening opening = host::open_logs(arguments.logs, options_of(arguments));
  if (arguments.json != "-")
    for (const host::OpenedFile& file : opening.files) print(file);
  const bool accepted = is_accepted(opening, arguments.yes);
  std::vector<std::string> written;
  if (accepted && !arguments.folder.empty() && !opening.records().empty())
    written = host::write_opening(opening, arguments.folder);
  std::vector<std::string> sheets;
  if (!written.empty() && arguments.sheet.empty()) sheets = write_sheets(arguments, opening);
  if (arguments.json != "-") {
    for (const std::string& ask : opening.asks()) fmt::print("not sure: {}\n", ask);
    if (!accepted) fmt::print("No record was written: --yes accepts uncertain channels, --map corrects them.\n");
    for (const std::string& path : written) fmt::print("written: {}\n", path);
    for (const std::string& sheet : sheets) fmt::print("written: {}\n", sheet);
  }
  nlohmann::json document = host::to_json(opening, written);
  if (!accepted || opening.records().empty())
    end_with(host::ExitCode::answer_is_no);
  else if (wants_verdict(arguments))
    document["verdicts"] = judge_all(arguments, opening);
  if (!arguments.json.empty()) write_json(document, arguments.json);
}

}  // namespace

void add_open(CLI::App& app) {
  const auto arguments = std::make_shared<OpenArguments>();
  CLI::App* command = app.add_subcommand(
      "open", "Read any controller's logs: name the channels, write records, find the missing effect");
  add_input(
      *command, "LOG", arguments->logs,
      "logs: TwinCAT Scope, SINUMERIK trace, halsampler, halscope, ODrive, moteus, VESC, Betaflight Blackbox (CSV), "
      "camonitor, drive monitors, joint states in ROS 2 bags (.mcap, .db3), .h5, .mat, .npy, .npz, any table")
      ->required();
  CLI::Option* sheet =
      add_input(*command, "--sheet", arguments->sheet, "data sheet of the drive (axistool sheet makes one)");
  command->add_option("--kt", arguments->torque_constant, "only the motor constant: Nm/A, or N/A for a linear motor")
      ->check(CLI::PositiveNumber)
      ->excludes(sheet);
  command->add_option("--map", arguments->map,
                      "column=channel[*factor][+shift], … to override what was recognised (axistool help import); or "
                      "the mapping.toml of an earlier log");
  add_input(*command, "--hal", arguments->hal, "the .hal file that names halsampler's columns");
  command->add_option("--period", arguments->period_s, "sampling period (s) of a log that does not state it")
      ->check(CLI::PositiveNumber);
  command->add_option("--drive", arguments->drive, "name of the drive, for the records' headers");
  command->add_flag("--yes", arguments->yes, "accept uncertain channels");
  add_output(*command, "-o,--output", arguments->folder,
             "folder for the records, the accepted mapping.toml and a data sheet (sheet.toml)",
             FileRole::output_folder);
  add_accept_option(*command, arguments->accepted);
  add_json_option(*command, arguments->json);
  command->footer(
      "Lists for each channel the assumed quantity, the factor, the reason, and the confidence. Below 90 % it asks on "
      "a\n"
      "terminal; elsewhere it needs --yes. With --sheet or --kt it continues: identify, diagnose, one page; a log "
      "named\n"
      "valid…, test… or check… is for validation. With --kt alone 1 mm stands for 1 rad. Every axis of a log, every "
      "joint\n"
      "of a bag, makes a record; a bag does not tell whether a joint turns or slides: --sheet does, or the answer.\n"
      "Examples:\n"
      "  axistool open scope.csv                                  (only look)\n"
      "  axistool open steps.csv jog.csv --kt 0.6 -o x            (records, mapping)\n"
      "  axistool open next.csv --map x/mapping.toml -o x         (the next log of that machine)\n"
      "  axistool open pid.txt --hal loop.hal -o x\n"
      "  axistool open robot_0.mcap --map x_mm=slide.position*1000,v_mm_s=slide.velocity*1000,i_A=slide.effort\n"
      "Exit code 1: no record could be made, or a question is open.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
