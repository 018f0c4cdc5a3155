// axistool export: a model in other programs' formats.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/interchange/export_model.hpp"
#include "host/model/model_file.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct ExportArguments {
  std::string model, to, path, record, json;
};

void run(const ExportArguments& arguments) {
  const sim::DriveDescription model = host::read_model(arguments.model);
  std::optional<host::Record> record;
  if (!arguments.record.empty()) {
    record = host::read_record(arguments.record);
    host::adapt_to(*record, model.data);
  }
  const host::Export exported =
      host::export_model(model, *host::export_target(arguments.to), arguments.path, record ? &*record : nullptr);
  for (const host::ExportedFile& file : exported.files) host::write_file_atomically(file.path, file.text);
  if (!arguments.json.empty()) write_json(host::to_json(exported), arguments.json);
  if (arguments.json == "-") return;
  for (const host::ExportedFile& file : exported.files) fmt::print("written: {}\n", file.path);
  for (const host::NotExpressed& one : exported.not_expressed)
    fmt::print("not expressed: {}{}\n", one.kind,
               one.share ? fmt::format(", {:.3g} % of the record's squared torque or force", 100.0 * *one.share) : "");
}

}  // namespace

void add_export(CLI::App& app) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Export a model to MuJoCo, URDF, LinuxCNC, C, Modelica or Python");
  add_input(*command, "model", arguments->model, "model file (axis-model/1)")->required();
  command->add_option("--to", arguments->to, "mjcf, urdf, linuxcnc, c, modelica or python")
      ->required()
      ->check(CLI::IsMember({"mjcf", "urdf", "linuxcnc", "c", "modelica", "python"}));
  add_output(*command, "-o,--output", arguments->path, "file to write; LinuxCNC's .hal file is written beside it")
      ->required();
  add_input(*command, "--record", arguments->record,
            "record on which to compute the error of omitted effects (those that the format cannot express)");
  add_json_option(*command, arguments->json);
  command->footer(
      "Each file lists the effects that its format cannot express.\n"
      "Examples:\n"
      "  axistool export x.toml --to c -o x_friction.h\n"
      "  axistool export x.toml --to linuxcnc -o x_friction.comp --record jog.csv\n"
      "  axistool export x.toml --to mjcf -o x.xml --record jog.csv --json -");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
