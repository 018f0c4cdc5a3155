// axistool design: Kalman gain and state feedback from a model, as board parameters.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "host/atomic_file.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/identify/design_json.hpp"
#include "host/identify/plausibility.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/compensation_parameters.hpp"

namespace axistool {

namespace {

struct DesignArguments {
  std::string model, output, json;
  std::vector<std::string> accepted;
  host::DesignOptions options;
};

void print_table(const sim::DriveDescription& model, const host::AxisDesign& design) {
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  const char* travel = rotary ? "mm" : "m";
  const char* speed = rotary ? "rad/s" : "m/s";
  fmt::print("axis {}: J = {:.6g} {}, B = {:.6g} {}, period {:g} ms, {}\n\n", model.name, design.axis.inertia,
             rotary ? "kg m^2" : "kg", design.axis.viscous, rotary ? "Nm s/rad" : "N s/m",
             1e3 * model.data.sample_period_s, design.used.tach_variance ? "encoder and tachometer" : "encoder only");
  fmt::print("Kalman gain ({}state in {}, {}, V)\n", design.used.tach_variance ? "columns: encoder, tachometer; " : "",
             travel, speed);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < design.Kobs.cols(); ++column) fmt::print("  {:14.6f}", design.Kobs(row, column));
    fmt::print("\n");
  }
  fmt::print("\nobserver poles            fn         zeta\n");
  for (std::size_t k = 0; k < design.observer_poles.size(); ++k) {
    fmt::print("  {:8.4f} {:+8.4f}j  {:8.2f} Hz  {:6.3f}\n", design.observer_poles[k].real(),
               design.observer_poles[k].imag(), design.observer_fn_Hz[k], design.observer_zeta[k]);
  }
  fmt::print("\nstate feedback            {:.4f} V/{}, {:.4f} V/({})   (poles at {:g} Hz, zeta {:g})\n", design.Kc(0),
             travel, design.Kc(1), speed, design.used.bandwidth_Hz, design.used.damping);
}

void print_compensation(const sim::DriveDescription& model) {
  std::vector<std::string> on;
  for (const auto& [name, value] : host::compensation_parameters(model))
    if (name.ends_with(".on") && value != 0.0) on.push_back(name.substr(0, name.find('.')));
  if (model.find("tach_gain") != nullptr || model.find("tach_offset") != nullptr) on.emplace_back("tachometer");
  if (!on.empty()) fmt::print("the board compensates     {}\n", fmt::join(on, ", "));
  const auto rest = host::uncompensated_effects(model);
  if (!rest.empty()) fmt::print("it does not compensate    {}\n", fmt::join(rest, ", "));
}

void run(const DesignArguments& arguments) {
  const sim::DriveDescription model = host::read_model(arguments.model, host::Bounds::examined_later);
  host::require_plausible(model, arguments.accepted);
  const host::AxisDesign design = host::design_axis(model, arguments.options);
  if (!arguments.output.empty()) {
    host::write_file_atomically(arguments.output,
                                host::board_parameters_toml(model, design) + host::compensation_toml(model));
  }
  if (!arguments.json.empty()) write_json(host::design_json(design), arguments.json);
  if (arguments.json == "-") return;
  print_table(model, design);
  print_compensation(model);
  if (!arguments.output.empty()) fmt::print("\nboard parameters written to {}\n", arguments.output);
}

}  // namespace

void add_design(CLI::App& app) {
  auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command = app.add_subcommand("design", "Kalman gain and state feedback from a model -> board parameters");
  add_input(*command, "MODEL", arguments->model, "model file (axis-model/1)")->required();
  add_output(*command, "-o,--output", arguments->output, "file for the board parameters (axis-params/1)");
  command->add_option("--rw", arguments->options.tach_variance,
                      "tachometer variance, rad^2/s^2 (default 0.05) or m^2/s^2 (default: the model's own)");
  command->add_option("--rwd", arguments->options.disturbance_variance, "disturbance variance, V^2")
      ->capture_default_str();
  command->add_option("--ru", arguments->options.command_variance, "command variance, V^2 (default du^2/12)");
  command->add_option("--rx", arguments->options.position_variance, "position variance, mm^2 or m^2 (default dx^2/12)");
  command->add_option("--fc", arguments->options.bandwidth_Hz, "natural frequency of the closed loop, Hz")
      ->capture_default_str();
  command->add_option("--zeta", arguments->options.damping, "damping ratio of the closed loop")->capture_default_str();
  command->add_option("--accept", arguments->accepted,
                      "design although the values of this effect (inertia, viscous, coulomb, …) are none that a drive "
                      "has or that its records determine");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool design x.toml -o x-params.toml\n"
      "  axistool design x.toml --fc 40 --zeta 0.8 --json -\n"
      "Larger --rwd: the disturbance estimate follows faster and is noisier. Larger --fc: stiffer, until noise or a\n"
      "resonance limits it; keep it well below the observer's fn. The file also switches on what the board can\n"
      "compensate of the model's effects (cogging, presliding, friction along the travel, backlash, tachometer): "
      "after\n"
      "`improve`, design again and set-params once. Exit code 8: the model's values are none that a drive can have.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
