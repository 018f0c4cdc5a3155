// axistool compare: how well a model predicts records, and where it fails.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/compare/comparison_report.hpp"
#include "host/compare/look_alike.hpp"
#include "host/compare/model_comparison.hpp"
#include "host/compare/tracking_error.hpp"
#include "host/model/model_file.hpp"
#include "host/output_target.hpp"
#include "host/record/read_record.hpp"
#include "host/report/terminal.hpp"
#include "host/report/text_format.hpp"

namespace axistool {

namespace {

struct CompareArguments {
  std::string model;
  std::vector<std::string> files, models, records, accepted;
  std::string json, report, predictions;
  double window_s = host::kWindow_s;
  double fail_above = 0.0;
  std::string traces;
  std::vector<double> stretch;
  double period_mm = 0.0;
  std::vector<std::string> map, plot;
  std::string like;

  host::Focus focus() const {
    host::Focus chosen{.record = traces};
    if (!stretch.empty()) chosen.stretch = host::TimeSpan{stretch[0], stretch[1]};
    if (period_mm > 0.0) chosen.period_mm = period_mm;
    if (!map.empty()) chosen.map = {map[0], map[1]};
    if (!plot.empty()) chosen.plot = {plot[0], plot[1]};
    return chosen;
  }
};

/// With one record, the given name; with several, number and name are appended: pred.csv -> pred-2-jog.csv.
std::string predictions_path(const CompareArguments& arguments, std::size_t index) {
  if (arguments.records.size() == 1) return arguments.predictions;
  const std::filesystem::path path(arguments.predictions);
  const std::string stem = std::filesystem::path(arguments.records[index]).stem().string();
  return (path.parent_path() /
          fmt::format("{}-{}-{}{}", path.stem().string(), index + 1, stem, path.extension().string()))
      .string();
}

/// For records without command and current: statistics of position and reference.
void run_tracking(const CompareArguments& arguments, const std::vector<host::Record>& records) {
  if (!arguments.predictions.empty() || !arguments.report.empty())
    throw host::Failure(host::ExitCode::bad_input,
                        "the record has no command or current (u_V or i_A), so nothing can be predicted: leave out "
                        "--predictions and --report");
  std::vector<host::TrackingError> errors;
  for (const host::Record& record : records) errors.push_back(host::tracking_error(record));
  if (!arguments.json.empty()) write_json(host::tracking_json(errors), arguments.json);
  if (arguments.json != "-") fmt::print("{}", host::tracking_text(errors));
}

/// Files that end in .toml are models.
void sort_files(CompareArguments& arguments) {
  arguments.models = {arguments.model};
  arguments.records.clear();
  for (const std::string& file : arguments.files)
    (file.ends_with(".toml") ? arguments.models : arguments.records).push_back(file);
  if (arguments.records.empty()) throw host::Failure(host::ExitCode::usage, "compare needs a record: MODEL… RECORD…");
  if (arguments.models.size() > 1 && !arguments.predictions.empty())
    throw host::Failure(host::ExitCode::usage, "--predictions takes one model: name one");
}

host::ComparedModel compared(const std::string& path, const CompareArguments& arguments) {
  const sim::DriveDescription model = host::read_model(path);
  std::vector<host::Record> records;
  for (const std::string& record : arguments.records) records.push_back(host::read_record(record));
  return host::compare_with(path, model, std::move(records), arguments.window_s, arguments.accepted);
}

void print_likeness(const nlohmann::json& likeness) {
  fmt::print("\nThe residual over {} has the shape of (correlation):\n",
             host::spaced(likeness["over"].get<std::string>()));
  for (const nlohmann::json& one : likeness["effects"])
    fmt::print("  {:4.2f}  {}\n", one["likeness"].get<double>(), one["title"].get<std::string>());
}

void run(CompareArguments& arguments) {
  sort_files(arguments);
  if (!arguments.plot.empty() && arguments.plot.front() == host::kPlottedError)
    throw host::Failure(host::ExitCode::usage, "--plot X,Y: the error can be Y only");
  if (!arguments.predictions.empty())
    for (std::size_t r = 0; r < arguments.records.size(); ++r) host::output_target(predictions_path(arguments, r));
  if (std::vector<host::Record> tracks =
          host::tracking_records(arguments.records, host::read_model(arguments.model).data);
      !tracks.empty()) {
    run_tracking(arguments, tracks);
    return;
  }
  std::vector<host::ComparedModel> models;
  for (const std::string& path : arguments.models) models.push_back(compared(path, arguments));

  if (!arguments.predictions.empty()) {
    for (std::size_t r = 0; r < arguments.records.size(); ++r)
      host::write_file_atomically(predictions_path(arguments, r),
                                  host::predictions_csv(models[0].model, models[0].set.records[r].prepared));
  }
  if (!arguments.report.empty()) host::comparison_report(models, arguments.focus()).write(arguments.report);
  const nlohmann::json likeness = arguments.like.empty()
                                      ? nlohmann::json()
                                      : host::likeness_json(models.front(), arguments.focus(), arguments.like);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::comparison_document(models);
    if (!likeness.is_null()) document["likeness"] = likeness;
    write_json(document, arguments.json);
  }
  if (arguments.json != "-") {
    fmt::print("{}", host::comparison_text(models, host::terminal_of(stdout)));
    if (!likeness.is_null()) print_likeness(likeness);
    if (!arguments.report.empty()) fmt::print("\nReport: {}\n", arguments.report);
  }
  const auto fails = [&](const host::ComparedModel& one) {
    return one.comparison.error.combined > arguments.fail_above;
  };
  if (arguments.fail_above > 0.0 && std::ranges::any_of(models, fails)) end_with(host::ExitCode::answer_is_no);
}

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "show how well a model predicts records, and where it fails");
  add_input(*command, "MODEL", arguments->model, "model of the drive (axis-model/1)")->required();
  add_input(*command, "RECORD", arguments->files, "records of the drive (axis-record/1), and further models (.toml)")
      ->required();
  add_accept_option(*command, arguments->accepted);
  add_json_option(*command, arguments->json);
  add_output(*command, "--report", arguments->report, "write an HTML page with plots to this file");
  add_output(*command, "--predictions", arguments->predictions,
             "write measured and predicted rows as CSV; with several records one file each: FILE-1-NAME.csv");
  command
      ->add_option("--window", arguments->window_s,
                   "length of a prediction, s; it restarts from the smoothed measured state")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--traces", arguments->traces,
                      "record whose traces the page draws; default: the one with the largest error");
  command
      ->add_option("--stretch", arguments->stretch,
                   "from and to, s, of that record: highlight this range in all plots of the page")
      ->expected(2);
  command->add_option("--period", arguments->period_mm, "plot the residual over one period of the travel, mm")
      ->check(CLI::PositiveNumber);
  command->add_option("--map", arguments->map, "the two coordinates of the map of the residual: position, speed, ...")
      ->expected(2)
      ->check(CLI::IsMember(std::vector<std::string>(host::kMapCoordinates.begin(), host::kMapCoordinates.end())));
  std::vector<std::string> plotted(host::kPlotCoordinates.begin(), host::kPlotCoordinates.end());
  plotted.emplace_back(host::kPlottedError);
  command
      ->add_option("--plot", arguments->plot,
                   "a further plot on the page, X and Y: position, phase (of --period), speed, acceleration, current, "
                   "time, travel_since_reversal, rest, temperature; as Y also error")
      ->expected(2)
      ->delimiter(',')
      ->check(CLI::IsMember(plotted));
  command
      ->add_option("--like", arguments->like,
                   "list the effects whose own part has the shape of the residual over this coordinate: position, …")
      ->check(CLI::IsMember(std::vector<std::string>(host::kPlotCoordinates.begin(), host::kPlotCoordinates.end())));
  command
      ->add_option("--fail-above", arguments->fail_above,
                   "exit code 1 if the combined error exceeds this multiple of the noise floor")
      ->check(CLI::PositiveNumber);
  command->footer(
      "Examples:\n"
      "  axistool compare x.toml jog.csv\n"
      "  axistool compare x.toml steps.csv jog.csv --report compare.html --json compare.json\n"
      "  axistool compare x.toml better.toml validate.csv --report both.html   # several models, on top of each other\n"
      "  axistool compare x.toml validate.csv --fail-above 2      # for scripts\n"
      "  axistool compare x.toml jog.csv --report acceleration.html --plot acceleration,error\n"
      "  axistool compare x.toml jog.csv --like speed             # which effects look like its residual over speed\n"
      "The model predicts from the recorded command alone. The noise floor is the error that sensor noise and the\n"
      "uncertainty of the restart leave; error/floor is about 1 for a perfect model. Log faults (shifted, wrapped,\n"
      "mis-scaled channels) are listed first: correct them before you trust the rest.");
  command->callback(
      [arguments] { with_log_of_failure(arguments->json, "axis-comparison/1", [&] { run(*arguments); }); });
}

}  // namespace axistool
