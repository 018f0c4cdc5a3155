// axistool friction: the friction curve from jogs at constant speeds.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/identify/friction_json.hpp"
#include "host/model/model_file.hpp"
#include "host/statistics.hpp"

namespace axistool {

namespace {

struct FrictionArguments {
  std::vector<std::string> records, accepted;
  std::string model, output, json, method = "joint";
  host::ConstantSpeedOptions options;
};

void print_row(const std::string& name, const char* unit, const host::Estimate& estimate, bool has_interval) {
  fmt::print("  {:<26} {:>10.5g}", name, estimate.value);
  if (has_interval) fmt::print("  [{:.5g}, {:.5g}]", estimate.ci95[0], estimate.ci95[1]);
  fmt::print("  {}\n", unit);
}

void print_points(const host::FrictionIdentification& found, const char* speed, const char* effort) {
  fmt::print("  {:>10} {:>10} {:>8} {:>12} {:>10} {:>7}\n", speed, effort, "±", "disturbance", "curve", "s");
  bool jitters = false;
  for (const host::FrictionPoint& point : found.points) {
    const std::string observed = point.observed_effort ? fmt::format("{:.4f}", *point.observed_effort) : "-";
    fmt::print("  {:>10.4g} {:>10.4f} {:>8.4f} {:>12} {:>10.4f} {:>7.2f}{}\n", point.speed, point.effort,
               host::kNormal95 * point.standard_error, observed, found.fit.law.effort(point.speed), point.duration_s,
               point.is_steady() ? "" : " *");
    jitters = jitters || !point.is_steady();
  }
  if (jitters && found.method == host::FrictionMethod::joint) {
    fmt::print("  * not used: noise in the loop makes the speed cross zero, so the mean friction is too small\n");
  }
}

void print_table(const host::FrictionIdentification& found, const std::string& output) {
  const bool rotary = found.model.data.kind == sim::DriveKind::rotary;
  const char* speed = rotary ? "rad/s" : "m/s";
  const char* effort = rotary ? "Nm" : "N";
  const bool intervals = found.method == host::FrictionMethod::joint;
  fmt::print("{} fit through {} constant speeds; residual {:.3g} {} rms\n\n", host::method_name(found.method),
             found.points.size(), found.fit.rms, effort);
  print_points(found, speed, effort);
  fmt::print("\n  {:<26} {:>10}{}\n", "parameter", "value", intervals ? "  95 % interval" : "");
  print_row("viscous B'", rotary ? "Nm s/rad" : "N s/m", found.fit.viscous, intervals);
  const char* const directions[] = {"forward", "backward"};
  for (std::size_t d = 0; d < 2; ++d) {
    const std::string where = fmt::format(", {}", directions[d]);
    print_row("Coulomb" + where, effort, found.fit.coulomb[d], intervals);
    if (!found.fit.has_stribeck) continue;
    print_row("static" + where, effort, found.fit.static_level[d], intervals);
    print_row("omega1" + where, speed, found.fit.omega1[d], intervals);
    print_row("omega2" + where, speed, found.fit.omega2[d], intervals);
  }
  if (found.tachometer) print_row("tachometer gain", "", found.tachometer->gain, true);
  if (found.viscous_by_disturbance) {
    fmt::print("\n  cross-check: B' by the Kalman disturbance {:.4g}, by the mean control signal {:.4g}\n",
               found.viscous_by_disturbance->value, found.fit.viscous.value);
  }
  if (found.fit.has_stribeck) {
    fmt::print("  The points determine the curve; omega1, omega2 and the static level are correlated in it.\n");
  }
  for (const std::string& warning : found.warnings) fmt::print("\nwarning: {}\n", warning);
  if (!output.empty()) {
    fmt::print("\nModel written to {0}. Next: axistool compare {0} RECORD, or axistool design {0} -o PARAMS\n", output);
  }
}

void run(const FrictionArguments& arguments) {
  const sim::DriveDescription model = host::read_model(arguments.model);
  const host::Measurements measured = host::MeasurementGate(model, {arguments.accepted}).read(arguments.records);
  const host::FrictionIdentification found =
      host::identify_friction(measured, model, host::friction_method_named(arguments.method), arguments.options);
  if (!arguments.output.empty()) host::write_model(found.model, arguments.output);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::friction_json(found);
    document["log"] = host::log_faults_json(measured.log());
    write_json(document, arguments.json);
  }
  if (arguments.json == "-") return;
  print_log(measured.log());
  print_table(found, arguments.output);
}

}  // namespace

void add_friction(CLI::App& app) {
  auto arguments = std::make_shared<FrictionArguments>();
  CLI::App* command = app.add_subcommand("friction", "friction curve from jogs at constant speeds -> model");
  add_input(*command, "RECORD", arguments->records,
            "records with jogs in both directions; constant speeds are found automatically")
      ->required();
  // Not add_input(), because the model may be overwritten with the new one.
  command->add_option("--model", arguments->model, "model with inertia (and a first estimate of viscous friction)")
      ->required();
  add_output(*command, "-o,--output", arguments->output, "model to write, with the friction curve");
  command
      ->add_option("--method", arguments->method,
                   "joint: one fit of B', Coulomb, static, omega1, omega2 to the mean control signal; paper: as "
                   "published, from the Kalman disturbance, parameter by parameter")
      ->check(CLI::IsMember({"joint", "paper"}))
      ->capture_default_str();
  command->add_option("--settle", arguments->options.settle_s, "time to skip at the start of each constant speed, s")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--shortest", arguments->options.shortest_s, "shortest time that a speed must be held, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_accept_option(*command, arguments->accepted);
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool friction jog.csv --model x.toml -o x-friction.toml\n"
      "  axistool friction slow.csv fast.csv --model x.toml -o x.toml --method paper\n"
      "Jog in closed loop at about ten speeds in both directions, for example 0.1 to 100 mm/s, each for 0.6 s or "
      "more.\n"
      "Exit code 8: too few constant speeds.");
  command->callback([arguments] { with_log_of_failure(arguments->json, "axis-friction/1", [&] { run(*arguments); }); });
}

}  // namespace axistool
