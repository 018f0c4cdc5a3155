// axistool identify: inertia, viscous and Coulomb friction from records.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/identification_json.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct IdentifyArguments {
  std::vector<std::string> records, accepted;
  std::string output, drive, method, json;
  host::MotionOptions options;
};

/// The data sheet to work with: the file that was named, or the paper's drive that the record names.
sim::DriveDescription drive_for(const IdentifyArguments& arguments, std::vector<std::string>& warnings) {
  if (!arguments.drive.empty()) return host::read_drive(arguments.drive);
  return host::drive_named_by(host::read_record(arguments.records.front()), warnings);
}

void print_row(const char* name, const char* unit, const host::Estimate& estimate) {
  fmt::print("  {:<22} {:>12.6g}  [{:.6g}, {:.6g}] {}\n", name, estimate.value, estimate.ci95[0], estimate.ci95[1],
             unit);
}

void print_table(const host::Identification& found, const std::string& output) {
  const bool rotary = found.model.data.kind == sim::DriveKind::rotary;
  const char* effort = rotary ? "Nm" : "N";
  const char* speed = rotary ? "rad/s" : "m/s";
  fmt::print("{} on {} samples, zero-phase filter at {:.3g} Hz\n\n", host::method_name(found.method),
             found.estimate.rows, found.cutoff_Hz);
  fmt::print("  {:<22} {:>12}  95 % interval\n", "parameter", "value");
  print_row(rotary ? "inertia J" : "mass M", rotary ? "kg m^2" : "kg", found.estimate.inertia);
  print_row("viscous B", rotary ? "Nm s/rad" : "N s/m", found.estimate.viscous);
  if (found.estimate.positive) print_row("Coulomb forward", effort, *found.estimate.positive);
  if (found.estimate.negative) print_row("Coulomb backward", effort, *found.estimate.negative);
  if (found.tachometer) {
    print_row("tachometer gain", "", found.tachometer->gain);
    print_row("tachometer offset", speed, found.tachometer->offset);
  }
  if (found.tach_noise_variance) {
    fmt::print("  {:<22} {:>12.4g}  ({})^2, at standstill\n", "tachometer variance", *found.tach_noise_variance, speed);
  }
  fmt::print("\n  residual {:.3g} % of the {}; condition number {:.3g}; top speed {:.3g} {}\n",
             100.0 * found.relative_error, rotary ? "torque" : "force", found.estimate.condition_number,
             found.excitation.top_speed, speed);
  for (const std::string& warning : found.warnings) fmt::print("\nwarning: {}\n", warning);
  if (!output.empty()) {
    fmt::print(
        "\nModel written to {0}. Next: axistool friction RECORD --model {0} -o {0} (jogs at constant speeds), or\n"
        "axistool compare {0} RECORD (a record that was not fitted).\n",
        output);
  }
}

void run(const IdentifyArguments& arguments) {
  std::vector<std::string> warnings;
  const sim::DriveDescription drive = drive_for(arguments, warnings);
  const host::Measurements measured = host::MeasurementGate(drive, {arguments.accepted}).read(arguments.records);
  host::Identification found = host::identify_drive(
      measured, drive, host::method_named(arguments.method, measured.training()), arguments.options);
  found.warnings.insert(found.warnings.begin(), warnings.begin(), warnings.end());
  if (!arguments.output.empty()) host::write_model(found.model, arguments.output);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::identification_json(found);
    document["effort_timing"] = host::effort_timing_json(measured.training_records());
    document["log"] = host::log_faults_json(measured.log());
    write_json(document, arguments.json);
  }
  if (arguments.json == "-") return;
  print_log(measured.log());
  print_table(found, arguments.output);
}

}  // namespace

void add_identify(CLI::App& app) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand("identify", "inertia, viscous and Coulomb friction from records -> model");
  add_input(*command, "RECORD", arguments->records, "records of one drive (axis-record/1); several are stacked")
      ->required();
  add_output(*command, "-o,--output", arguments->output, "model to write (axis-model/1)");
  add_input(*command, "--drive", arguments->drive, "data sheet of the drive: a model file, with or without effects");
  command
      ->add_option(
          "--method", arguments->method,
          "ls: least squares without friction; unbiased-ls: the paper's, with Coulomb friction; sliding-ls: inverse "
          "model on samples where the axis certainly slides. Default: sliding-ls with a tachometer, else unbiased-ls")
      ->check(CLI::IsMember({"unbiased-ls", "ls", "sliding-ls"}));
  command
      ->add_option(
          "--deadband", arguments->options.deadband,
          "speed that counts as standstill, rad/s (default 0.5, or a tenth of the record's top speed if that is "
          "less) or m/s (default 0: every sample counts)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--cutoff", arguments->options.cutoff_Hz,
                      "cut-off of the zero-phase filter, Hz. Default: a tenth of the sampling rate, at most 100 Hz, "
                      "lowered until sensor noise is below 1 % of the acceleration");
  command
      ->add_option("--decimation", arguments->options.decimation,
                   "use every n-th filtered sample. Default: sampling rate / cut-off where every sample counts, else 1")
      ->check(CLI::PositiveNumber);
  add_accept_option(*command, arguments->accepted);
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool identify steps.csv -o x.toml --drive x-drive.toml\n"
      "  axistool identify a.csv b.csv -o x.toml --drive x-drive.toml --method unbiased-ls --json -\n"
      "Good excitation: open-loop steps in both directions, well above breakaway, of several amplitudes and "
      "durations.\n"
      "Intervals hold for coloured residuals (block sums with Student's t). Exit code 8: the axis did not move "
      "enough.");
  command->callback(
      [arguments] { with_log_of_failure(arguments->json, "axis-identification/1", [&] { run(*arguments); }); });
}

}  // namespace axistool
