// axistool identify: inertia, viscous and Coulomb friction from records.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/compare/comparison_report.hpp"
#include "host/fit/prediction_fit.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/identification_json.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct IdentifyArguments {
  std::vector<std::string> records, loaded, accepted;
  std::string output, drive, method, json, report, gain = "sheet", purpose = "control";
  double window_s = host::kPredictionWindow_s;
  std::optional<double> added_mass, added_inertia;
  host::MotionOptions options;
};

/// The data sheet: the named file, or the paper's drive if the record names it.
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
  if (found.amplifier) print_row("amplifier gain Ka", "A/V", found.amplifier->gain);
  if (found.gain_check) {
    print_row("true gain / assumed", "", found.gain_check->factor);
    fmt::print("  {:<22} {:>12.6g}  instead of {:.6g} {}/V or {}/A\n", "torque gain by inertia",
               found.gain_check->found, found.gain_check->assumed, effort, effort);
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

/// Writes the page of compare for the identified model on its own records.
void write_report(const IdentifyArguments& arguments, const sim::DriveDescription& model) {
  std::vector<host::Record> records;
  for (const std::string& path : arguments.records) records.push_back(host::read_record(path));
  const std::string& name = arguments.output.empty() ? model.name : arguments.output;
  const host::ComparedModel fit =
      host::compare_with(name, model, std::move(records), arguments.window_s, arguments.accepted);
  host::comparison_report({&fit, 1}).write(arguments.report);
}

void run(const IdentifyArguments& arguments) {
  std::vector<std::string> warnings;
  const sim::DriveDescription drive = drive_for(arguments, warnings);
  const host::Measurements measured = host::MeasurementGate(drive, {arguments.accepted}).read(arguments.records);
  std::optional<host::Measurements> loaded;
  std::optional<host::AddedInertia> added;
  if (!arguments.loaded.empty()) {
    if (arguments.added_mass.has_value() == arguments.added_inertia.has_value())
      throw host::Failure(host::ExitCode::usage,
                          "--loaded: say what was added, with either --added-mass or --added-inertia");
    loaded.emplace(host::MeasurementGate(drive, {arguments.accepted}).read(arguments.loaded));
    added.emplace(host::AddedInertia{*loaded, arguments.added_inertia
                                                  ? *arguments.added_inertia
                                                  : host::inertia_of_mass(*arguments.added_mass, drive.data)});
  } else if (arguments.added_mass || arguments.added_inertia) {
    throw host::Failure(host::ExitCode::usage, "--added-mass and --added-inertia need --loaded: records with it");
  }
  host::Identification found =
      host::identify_with_gain(measured, drive, host::method_named(arguments.method, measured.training()),
                               arguments.options, host::gain_source_named(arguments.gain), added);
  found.warnings.insert(found.warnings.begin(), warnings.begin(), warnings.end());
  std::optional<host::PredictionFit> prediction;
  if (arguments.purpose == "prediction") prediction = host::fit_for_prediction(found, measured, arguments.window_s);
  if (!arguments.output.empty()) host::write_model(found.model, arguments.output);
  if (!arguments.report.empty()) write_report(arguments, found.model);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::identification_json(found);
    document["effort_timing"] = host::effort_timing_json(measured.training_records());
    if (prediction) {
      document["for"] = arguments.purpose;
      document["prediction"] = host::prediction_json(*prediction);
    }
    document["log"] = host::log_faults_json(measured.log());
    write_json(document, arguments.json);
  }
  if (arguments.json == "-") return;
  print_log(measured.log());
  print_table(found, arguments.output);
  if (prediction)
    fmt::print(
        "Fitted for prediction over {:g} s: error {:.2f} -> {:.2f} noise floors; torque or force {:.3g} -> {:.3g} %\n",
        prediction->window_s, prediction->before, prediction->after, 100.0 * prediction->relative_error_before,
        100.0 * found.relative_error);
}

}  // namespace

void add_identify(CLI::App& app) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand("identify", "inertia, viscous and Coulomb friction from records -> model");
  add_input(*command, "RECORD", arguments->records, "records of one drive (axis-record/1); several are stacked")
      ->required();
  add_output(*command, "-o,--output", arguments->output, "model to write (axis-model/1)");
  add_output(*command, "--report", arguments->report,
             "write an HTML page with plots to this file: the identified model compared with its own records");
  add_input(*command, "--drive", arguments->drive, "data sheet of the drive: a model file, with or without effects");
  command
      ->add_option(
          "--method", arguments->method,
          "ls: least squares without friction; unbiased-ls: the paper's, with Coulomb friction; sliding-ls: inverse "
          "model on samples where the axis certainly slides. Default: sliding-ls with a tachometer, else unbiased-ls")
      ->check(CLI::IsMember({"unbiased-ls", "ls", "sliding-ls"}));
  command
      ->add_option(
          "--for", arguments->purpose,
          "control: least error of torque or force, for feed-forward and controller; prediction: least error of "
          "the motion that the model predicts over --window")
      ->check(CLI::IsMember({"control", "prediction"}))
      ->capture_default_str();
  const CLI::Option* const window =
      command->add_option("--window", arguments->window_s, "length of the predictions of --for prediction, s")
          ->check(CLI::Range(0.01, 100.0))
          ->capture_default_str();
  command
      ->add_option(
          "--gain", arguments->gain,
          "torque per command: sheet; current: Ka from u_V and i_A of the records; inertia: Kt*Ka from --loaded")
      ->check(CLI::IsMember({"sheet", "current", "inertia"}))
      ->capture_default_str();
  add_input(*command, "--loaded", arguments->loaded, "records of the same drive with a known inertia added");
  command->add_option("--added-mass", arguments->added_mass, "what was added: mass on the table, kg")
      ->check(CLI::PositiveNumber);
  command->add_option("--added-inertia", arguments->added_inertia, "the same at the motor, kg m^2 (linear drive: kg)")
      ->check(CLI::PositiveNumber);
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
      "  axistool identify steps.csv --drive x-drive.toml --gain current -o x.toml\n"
      "  axistool identify steps.csv --drive x-drive.toml --loaded heavy.csv --added-mass 40 --gain inertia -o x.toml\n"
      "  axistool identify steps.csv --drive x-drive.toml --for prediction -o x.toml\n"
      "Records with command and current also show the amplifier's gain Ka. A known added inertia shows Kt*Ka: the "
      "identified\n"
      "inertia grows by less than was added where the true gain is larger than the data sheet's.\n"
      "Good excitation: open-loop steps in both directions, well above breakaway, of several amplitudes and "
      "durations.\n"
      "Intervals hold for coloured residuals (block sums with Student's t). Exit code 8: the axis did not move "
      "enough.");
  command->callback([arguments, window] {
    if (window->count() > 0 && arguments->purpose != "prediction")
      throw host::Failure(host::ExitCode::usage, "--window needs --for prediction: the fit for control has no window");
    with_log_of_failure(arguments->json, "axis-identification/1", [&] { run(*arguments); });
  });
}

}  // namespace axistool
