// axistool adjust: sets values of a model by hand and prints the errors before and after.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/diagnose/adjustment.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/model/known_parameters.hpp"
#include "host/model/model_file.hpp"

namespace axistool {

namespace {

struct AdjustArguments {
  std::string model, output, json;
  std::vector<std::string> values, train, validate, accepted;
};

void run(const AdjustArguments& arguments) {
  const sim::DriveDescription model = host::read_model(arguments.model);
  const host::Measurements measured =
      host::MeasurementGate(model, {arguments.accepted}).read(arguments.train, arguments.validate);
  const host::Adjustment adjustment = host::adjust(model, host::with_values(model, arguments.values), measured);
  host::write_model(adjustment.model, arguments.output);
  if (!arguments.json.empty())
    write_json(host::to_json(adjustment, arguments.values, measured, arguments.output), arguments.json);
  if (arguments.json == "-") return;
  print_log(measured.log());
  fmt::print("Prediction error over noise floor: training {:.3f} -> {:.3f}, held back {:.3f} -> {:.3f}\n",
             adjustment.given.train.combined, adjustment.after.train.combined, adjustment.given.validate.combined,
             adjustment.after.validate.combined);
  fmt::print("Model written to {}\n", arguments.output);
}

}  // namespace

void add_adjust(CLI::App& app) {
  auto arguments = std::make_shared<AdjustArguments>();
  CLI::App* command = app.add_subcommand("adjust", "set values of a model by hand; print the errors before and after");
  add_input(*command, "model", arguments->model, "model file (axis-model/1)")->required();
  command->add_option("values", arguments->values, "NAME=VALUE, e.g. cogging.cosine_Nm=0.2")->required();
  add_input(*command, "--train", arguments->train, "training records")->required();
  add_input(*command, "--validate", arguments->validate, "validation records");
  add_output(*command, "-o,--output", arguments->output, "the new model")->required();
  add_accept_option(*command, arguments->accepted);
  add_json_option(*command, arguments->json);
  command->footer("Example:\n  axistool adjust x.toml inertia.J_kg_m2=0.004 --train jog.csv -o x-adjusted.toml");
  command->callback(
      [arguments] { with_log_of_failure(arguments->json, "axis-adjustment/1", [&] { run(*arguments); }); });
}

}  // namespace axistool
