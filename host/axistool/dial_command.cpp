// axistool dial: lost motion from readings of a dial gauge on the table.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/read_file.hpp"
#include "host/scale/dial_readings.hpp"

namespace axistool {

namespace {

struct DialArguments {
  std::string file, json;
};

void dial(const DialArguments& arguments) {
  const host::DialStudy study =
      host::study_dial(host::parse_dial_readings(host::read_file(arguments.file), arguments.file));
  if (!arguments.json.empty()) write_json(host::dial_json(study), arguments.json);
  if (arguments.json != "-") fmt::print("{}\n", host::dial_words(study));
}

}  // namespace

void add_dial(CLI::App& app) {
  auto arguments = std::make_shared<DialArguments>();
  CLI::App* command = app.add_subcommand("dial", "Measure lost motion from readings of a dial gauge on the table");
  add_input(*command, "READINGS", arguments->file,
            "CSV with columns x_mm (position shown by the control) and dial_mm (reading of the gauge), units also _um, "
            "_m; one row for each reading, in the order taken, with the axis at rest")
      ->required();
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool dial readings.csv\n"
      "Put the gauge against the table in the axis' direction. Move three steps of 0.05 mm forward and three back, a "
      "few times, and write down position and reading at each stop. Do not set the gauge to zero in between. Exit code "
      "9: the file is bad.");
  command->callback([arguments] { dial(*arguments); });
}

}  // namespace axistool
