// axistool design: Kalman gain and state feedback from a model, as board parameters.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <memory>

#include "host/atomic_file.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/identify/design_json.hpp"
#include "host/identify/plausibility.hpp"
#include "host/known_by_current.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/parameters/design_file.hpp"
#include "host/record/read_record.hpp"
#include "host/response/loop_design.hpp"
#include "host/response/response_report.hpp"

namespace axistool {

namespace {

struct DesignArguments {
  std::string model, output, json;
  std::vector<std::string> accepted;
  host::DesignOptions options;
  std::vector<std::string> response;
  std::string report, notch, low_pass;
  std::optional<double> margin, crossover_Hz;
};

/// "110", "110,0.5", "110,0.5,0.1": up to three numbers above 0.
std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& word : CLI::detail::split(text, ',')) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (word.empty() || *end != '\0' || !(numbers.back() > 0.0) || numbers.size() > 3)
      throw host::Failure(
          host::ExitCode::usage,
          fmt::format("{} {}: write its frequency in Hz, and behind commas damping and depth", option, text));
  }
  return numbers;
}

/// What is asked of the loop beyond `options`.
host::LoopAim aim_of(const DesignArguments& arguments) {
  host::LoopAim aim;
  aim.modulus = arguments.margin;
  aim.crossover_Hz = arguments.crossover_Hz;
  aim.seek_notch = arguments.notch == "auto";
  if (!arguments.notch.empty() && !aim.seek_notch) {
    const std::vector<double> n = numbers_of("--notch", arguments.notch);
    aim.filters.notch = host::Notch{n[0]};
    if (n.size() > 1) aim.filters.notch->damping = n[1];
    if (n.size() > 2) aim.filters.notch->depth = n[2];
  }
  if (!arguments.low_pass.empty()) {
    const std::vector<double> n = numbers_of("--low-pass", arguments.low_pass);
    aim.filters.low_pass = host::LowPass{n[0]};
    if (n.size() > 1) aim.filters.low_pass->damping = n[1];
  }
  if (arguments.response.empty() && (aim.modulus || aim.crossover_Hz || aim.seek_notch))
    throw host::Failure(host::ExitCode::usage,
                        "--margin, --bandwidth and --notch auto look at a measured response: give --response with what "
                        "`axistool bode --json` wrote, or with records");
  return aim;
}

host::AxisResponse measured_response(const std::vector<std::string>& files) {
  if (files.size() == 1 && files.front().ends_with(".json")) return host::read_response(files.front());
  std::vector<host::Record> records;
  for (const std::string& path : files) records.push_back(host::read_record(path));
  return host::analyse_response(records, nullptr);
}

std::string filter_text(const host::ControlFilterChoice& filters) {
  std::string text;
  if (filters.notch)
    text += fmt::format("notch at {:.4g} Hz, damping {:g}, depth {:g}", filters.notch->f_Hz, filters.notch->damping,
                        filters.notch->depth);
  if (filters.low_pass) text += fmt::format("{}low-pass at {:g} Hz", text.empty() ? "" : "; ", filters.low_pass->f_Hz);
  return text;
}

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
  host::require_volts(model.data, model.name, "a controller");
  host::require_plausible(model, arguments.accepted);
  const host::LoopAim aim = aim_of(arguments);
  std::optional<host::LoopDesign> loop;
  if (!arguments.response.empty())
    loop = host::design_loop(model, arguments.options, aim, measured_response(arguments.response));
  const host::AxisDesign design = loop ? loop->design : host::design_axis(model, arguments.options);
  const host::ControlFilterChoice filters = loop ? loop->filters : aim.filters;
  host::core_filters(filters, model.data.sample_period_s);  // in their ranges
  if (loop && loop->after.margins && !loop->after.margins->is_stable)
    throw host::Failure(host::ExitCode::refused,
                        "the measured drive would oscillate with this controller; nothing was written. --margin 0.5 "
                        "finds the bandwidth that it allows");
  if (!arguments.output.empty()) {
    host::write_file_atomically(arguments.output, host::design_toml(model, design, filters));
  }
  if (!arguments.json.empty()) {
    nlohmann::json document = host::design_json(design);
    document["filters"] = host::filter_json(filters);
    if (loop) {
      document["before"] = host::response_json(loop->before)["margins"];
      document["after"] = host::response_json(loop->after)["margins"];
    }
    write_json(document, arguments.json);
  }
  if (loop && !arguments.report.empty())
    host::response_report(loop->after, "axis " + model.name + ", designed", &loop->before).write(arguments.report);
  if (arguments.json == "-") return;
  print_table(model, design);
  print_compensation(model);
  if (filters.notch || filters.low_pass) fmt::print("filters                   {}\n", filter_text(filters));
  if (loop)
    fmt::print("\nOn the measured response, --fc {:g} without filters before, as designed after:\n{}",
               arguments.options.bandwidth_Hz,
               host::margins_text(loop->after, &loop->before, host::terminal_of(stdout)));
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
  add_input(*command, "--response", arguments->response,
            "what `bode --json` wrote of this axis, or records of it: the design is shown on it, and --margin, "
            "--bandwidth and --notch auto are sought on it");
  command->add_option("--margin", arguments->margin, "raise --fc as far as this modulus margin allows (0.5 is usual)")
      ->check(CLI::Range(0.05, 0.95));
  command->add_option("--bandwidth", arguments->crossover_Hz, "but the open loop's crossover no higher than this, Hz")
      ->check(CLI::PositiveNumber);
  command->add_option("--notch", arguments->notch,
                      "HZ[,DAMPING[,DEPTH]] (0.5, 0.1), or auto: on the measured resonance where it gains most");
  command->add_option("--low-pass", arguments->low_pass, "HZ[,DAMPING] (0.7)");
  add_output(*command, "--report", arguments->report, "with --response: page of the loop before and after");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool design x.toml -o x-params.toml\n"
      "  axistool design x.toml --fc 40 --zeta 0.8 --json -\n"
      "  axistool design x.toml --response bode.json --margin 0.5 --notch auto -o x-params.toml\n"
      "Larger --rwd: the disturbance estimate follows faster and is noisier. Larger --fc: stiffer, until noise or a\n"
      "resonance limits it; keep it well below the observer's fn. The file also switches on what the board can\n"
      "compensate of the model's effects (cogging, presliding, friction along the travel, backlash, tachometer): "
      "after\n"
      "`improve`, design again and set-params once. Exit code 8: the model's values are none that a drive can have.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
