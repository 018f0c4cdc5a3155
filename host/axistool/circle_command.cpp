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
                          fmt::format("{}: expected a model of axis x or y, not of \"{}\"", path, model.name));
    host::tell_turns(diagnosis, model);
  }
  if (!arguments.report.empty()) host::circle_report(diagnosis, names).write(arguments.report);
  if (!arguments.json.empty()) write_json(host::circle_json(diagnosis), arguments.json);
  if (arguments.json != "-") fmt::print("{}", host::circle_text(diagnosis, host::terminal_of(stdout)));
}

}  // namespace

void add_circle(CLI::App& app) {
  auto arguments = std::make_shared<CircleArguments>();
  CLI::App* command = app.add_subcommand("circle", "why a circle is not round: each cause in um, with its odds");
  add_input(*command, "RECORD", arguments->records,
            "records of circles: one with x_mm and y_mm, or pairs with one of each axis (# drive: x, # drive: y)")
      ->required();
  add_input(*command, "--model", arguments->models,
            "models of the axes, X.toml Y.toml: periods are also given in turns");
  add_output(*command, "--report", arguments->report, "HTML page: the circle magnified, each cause's share");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool circle circle-x.csv circle-y.csv\n"
      "  axistool circle both-ways-slow.csv both-ways-fast.csv --report circle.html --json -\n"
      "Records: the file of `run --capture` (x_mm, x_ref_mm, y_mm, y_ref_mm in one), or those of `hil circle -o` (one\n"
      "for each axis, paired in order). Every turn at a steady feed counts, in either direction; a record may hold\n"
      "several. Give both directions at two feeds. Sensors at the table: columns x2_mm and y2_mm (scales, grid "
      "encoder),\n"
      "or a ballbar's radius_mm (its length or its deviation; radius_um likewise). Without one, squareness, scales,\n"
      "backlash, play and straightness are listed as not observable. Exit code 8: no whole turn at a steady feed.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
