// axistool circle: why a circle is not round, from records of it.
#include <fmt/format.h>

#include <memory>

#include "host/axes/circle_report.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "host/report/terminal.hpp"

namespace axistool {

namespace {

struct CircleArguments {
  std::vector<std::string> records, models;
  std::string json, report;
};

void run(const CircleArguments& arguments) {
  std::vector<host::Record> records;
  std::string names;
  for (const std::string& path : arguments.records) {
    records.push_back(host::read_record(path));
    names += (names.empty() ? "" : ", ") + path;
  }
  host::CircleDiagnosis diagnosis = host::diagnose_circle(host::circle_passes(records));
  for (const std::string& path : arguments.models) {
    const sim::DriveDescription model = host::read_model(path);
    if (model.name != "x" && model.name != "y")
      throw host::Failure(host::ExitCode::usage,
                          fmt::format("{}: a model of axis x or y belongs here, not of \"{}\"", path, model.name));
    host::tell_turns(diagnosis, model);
  }
  if (!arguments.report.empty()) host::circle_report(diagnosis, names).write(arguments.report);
  if (!arguments.json.empty()) write_json(host::circle_json(diagnosis), arguments.json);
  if (arguments.json != "-") fmt::print("{}", host::circle_text(diagnosis, host::terminal_of(stdout)));
}

}  // namespace

void add_circle(CLI::App& app) {
  auto arguments = std::make_shared<CircleArguments>();
  CLI::App* command = app.add_subcommand("circle", "why a circle is not round: causes, each in um and with its odds");
  add_input(*command, "RECORD", arguments->records,
            "records of circles: one with x_mm and y_mm, or one of each axis (# drive: x, # drive: y) in pairs")
      ->required();
  add_input(*command, "--model", arguments->models,
            "models of the axes, X.toml Y.toml: periods are told in turns, too");
  add_output(*command, "--report", arguments->report, "HTML page: the circle magnified, each cause's share");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool circle circle-x.csv circle-y.csv\n"
      "  axistool circle both-ways-slow.csv both-ways-fast.csv --report circle.html --json -\n"
      "Records: what `run --capture` writes (x_mm, x_ref_mm, y_mm, y_ref_mm in one), or what `hil circle -o` writes "
      "(a\n"
      "record of each axis, paired in their order). Every turn at a steady feed counts, in either direction, "
      "also\n"
      "several in one record: give both directions at two feeds. Sensors at the table: columns x2_mm and y2_mm "
      "(scales,\n"
      "grid encoder), or a ballbar's radius_mm (its length, or what it deviates by; radius_um likewise). Without one,\n"
      "squareness, scales, backlash, play and straightness are named as what cannot be seen. Exit code 8: no whole "
      "turn\n"
      "at a steady feed.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
