// axistool design: Kalman gain and state feedback from models, as board parameters.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "host/atomic_file.hpp"
#include "host/axes/machine_design.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/hil/designed_loop.hpp"
#include "host/identify/plausibility.hpp"
#include "host/known_by_current.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/parameters/design_file.hpp"
#include "host/parameters/drive_limits.hpp"
#include "host/report/terminal.hpp"
#include "host/response/loop_design.hpp"
#include "host/response/response_report.hpp"

namespace axistool {

namespace {

struct DesignArguments {
  std::vector<std::string> models, accepted;
  std::string output, json;
  host::DesignOptions options;
  std::vector<std::string> response;
  std::string limit_source = "usual";
  std::string report, notch, low_pass, feedforward = "zero-phase";
  std::optional<double> margin, crossover_Hz;
  host::LimitWishes limits;
  bool own = false;
};

/// "110", "110,0.5", "110,0.5,0.1": up to three numbers above 0.
std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& word : CLI::detail::split(text, ',')) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (word.empty() || *end != '\0' || !(numbers.back() > 0.0) || numbers.size() > 3)
      throw host::Failure(host::ExitCode::usage,
                          fmt::format("{} {}: write HZ, or HZ,DAMPING or HZ,DAMPING,DEPTH", option, text));
  }
  return numbers;
}

/// Requirements on the loop beyond `options`.
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
  const bool is_machine = arguments.models.size() > 1;
  if (arguments.response.empty() && !is_machine && (aim.modulus || aim.crossover_Hz || aim.seek_notch))
    throw host::Failure(host::ExitCode::usage,
                        "--margin, --bandwidth and --notch auto need a measured response: give --response with the "
                        "JSON of `axistool bode`, or with records");
  return aim;
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

/// Limits of the references, in mm and s.
void print_limits(const sim::DriveDescription& model, const host::DriveLimits& limits) {
  const double unit = model.data.kind == sim::DriveKind::linear ? 1e3 : 1.0;
  const auto text = [&](const host::DriveLimit& limit, const char* of) {
    return std::isinf(limit.value) ? fmt::format("any {}", of)
                                   : fmt::format("{:.4g} {} ({})", unit * limit.value, of, limit.by);
  };
  fmt::print("limits of axis {:<11}{:.4g} mm/s, {:.4g} mm/s^2, {:.6g} mm/s^3; they need {:.3g} V of {:.3g} V\n",
             model.name, unit * limits.written.velocity, unit * limits.written.acceleration, unit * limits.written.jerk,
             limits.command_V, limits.limit_V);
  fmt::print("the drive allows          {}, {}, {}; {:g} % of its effort stay in reserve\n",
             text(limits.velocity, "mm/s"), text(limits.acceleration, "mm/s^2"), text(limits.jerk, "mm/s^3"),
             100.0 * limits.reserve);
  if (!limits.not_counted.empty()) fmt::print("effort beyond that for    {}\n", fmt::join(limits.not_counted, ", "));
}

sim::DriveDescription model_of(const std::string& path, const DesignArguments& arguments) {
  sim::DriveDescription model = host::read_model(path, host::Bounds::examined_later);
  host::require_volts(model.data, model.name, "a controller");
  host::require_plausible(model, arguments.accepted);
  return model;
}

/// The parameter file of an axis, named after it.
std::string parameter_file(const std::string& folder, const std::string& axis) {
  for (const char c : axis)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_')
      throw host::Failure(
          host::ExitCode::usage,
          fmt::format("the axis name \"{}\" cannot be a file name: use letters, digits, - and _ only", axis));
  return (std::filesystem::path(folder) / (axis + "-params.toml")).string();
}

void write_machine(const host::LoopSet& loops, const std::string& folder) {
  std::vector<std::string> files;
  for (const host::AxisLoop& loop : loops.axes) files.push_back(parameter_file(folder, loop.model.name));
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault)
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: cannot make this folder: {}", folder, fault.message()));
  for (std::size_t i = 0; i < files.size(); ++i)
    host::write_file_atomically(files[i], host::design_toml(loops.axes[i].model, loops.axes[i].design,
                                                            loops.axes[i].filters, loops.axes[i].limits.written));
}

void print_loops(const char* title, const host::LoopSet& loops) {
  fmt::print("{}\n", title);
  for (const host::AxisLoop& loop : loops.axes) {
    const std::string filters = filter_text(loop.filters);
    fmt::print("  axis {:<4} poles at {:6.2f} Hz, zeta {:g}; observer {:6.1f} Hz; modulus margin {}{}\n",
               loop.model.name, loop.design.used.bandwidth_Hz, loop.design.used.damping,
               loop.design.observer_fn_Hz.front(), loop.modulus ? fmt::format("{:.2f}", *loop.modulus) : "-",
               filters.empty() ? "" : "; " + filters);
  }
}

void print_machine(const host::MachineDesign& machine, const DesignArguments& arguments) {
  print_loops("one loop for all axes", machine.matched);
  fmt::print("  limited by {}\n", machine.limited_by);
  print_loops("\nthe best of each axis", machine.own);
  fmt::print(
      "\n"
      "Error from the mismatch of the axes (a line at 45 degrees; half axes of a circle of {:g} mm)\n"
      "{:>12}{:>16}{:>12}{:>16}{:>12}\n"
      "{:>12}{:>16}{:>12}{:>16}{:>12}\n",
      host::kForecastRadius_mm, "feed", "line, matched", "ellipse", "line, own", "ellipse", "mm/s", "um", "um", "um",
      "um");
  for (std::size_t i = 0; i < machine.matched.contour.size(); ++i) {
    const host::FeedContour &matched = machine.matched.contour[i], &own = machine.own.contour[i];
    fmt::print("{:12g}{:16.2f}{:12.2f}{:16.2f}{:12.2f}\n", matched.feed_mm_s, matched.line_45_um, matched.ellipse_um,
               own.line_45_um, own.ellipse_um);
  }
  if (!machine.matched.remaining.empty())
    fmt::print("The remaining error of the matched loop comes from the drives' {}.\n", machine.matched.remaining);
  for (const host::AxisLoop& loop : (arguments.own ? machine.own : machine.matched).axes)
    print_limits(loop.model, loop.limits);
  if (arguments.response.empty())
    fmt::print(
        "The margins follow from the models alone and ignore resonances and dead time that these lack. Measure them "
        "with `axistool bode` and give --response.\n");
  if (!arguments.output.empty())
    fmt::print("\n{} parameters written to {}\n", arguments.own ? "each axis's own" : "matched", arguments.output);
}

void run_machine(const DesignArguments& arguments) {
  if (!arguments.report.empty())
    throw host::Failure(host::ExitCode::usage, "--report shows one axis: give it one model");
  if (!arguments.response.empty() && arguments.response.size() != arguments.models.size())
    throw host::Failure(
        host::ExitCode::usage,
        fmt::format(
            "--response: {} files for {} axes; give one `bode --json` file per axis, in the order of the models",
            arguments.response.size(), arguments.models.size()));
  std::vector<host::AxisTask> tasks;
  for (std::size_t i = 0; i < arguments.models.size(); ++i) {
    tasks.push_back({model_of(arguments.models[i], arguments), {}});
    if (arguments.response.empty()) continue;
    tasks.back().measured = host::response_of({arguments.response[i]}, tasks.back().model);
    if (!tasks.back().measured->fit)
      throw host::Failure(host::ExitCode::refused,
                          arguments.response[i] + ": too few measured frequencies for a design");
  }
  const host::LoopAim aim = aim_of(arguments);
  host::core_filters(aim.filters, tasks.front().model.data.sample_period_s);  // in their ranges
  const host::MachineDesign machine = host::design_machine(tasks, arguments.options, aim, arguments.limits);
  if (!arguments.output.empty()) write_machine(arguments.own ? machine.own : machine.matched, arguments.output);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::machine_json(machine);
    document["written"] = arguments.own ? "own" : "matched";
    write_json(document, arguments.json);
  }
  if (arguments.json != "-") print_machine(machine, arguments);
}

void run(const DesignArguments& arguments) {
  if (arguments.own) throw host::Failure(host::ExitCode::usage, "--own needs several axes: give a model of each");
  const sim::DriveDescription model = model_of(arguments.models.front(), arguments);
  const host::LoopAim aim = aim_of(arguments);
  std::optional<host::AxisResponse> response;
  if (!arguments.response.empty()) response = host::response_of(arguments.response, model);
  const host::DesignedLoop designed = host::designed_loop(model, arguments.options, aim, arguments.limits, response);
  const auto& [design, filters, limits, loop] = designed;
  if (!arguments.output.empty()) {
    host::write_file_atomically(arguments.output, host::design_toml(model, design, filters, limits.written));
  }
  if (!arguments.json.empty()) write_json(host::designed_loop_json(designed), arguments.json);
  if (!arguments.report.empty()) host::designed_loop_report(model, designed, arguments.options).write(arguments.report);
  if (arguments.json == "-") return;
  print_table(model, design);
  print_limits(model, limits);
  print_compensation(model);
  if (filters.notch || filters.low_pass) fmt::print("filters                   {}\n", filter_text(filters));
  if (loop)
    fmt::print(
        "\n"
        "On the {} response; before: --fc {:g} without filters, after: this design:\n"
        "{}",
        arguments.response.front() == host::kModelled ? "model's" : "measured", arguments.options.bandwidth_Hz,
        host::margins_text(loop->after, &loop->before, host::terminal_of(stdout)));
  if (!arguments.output.empty()) fmt::print("\nboard parameters written to {}\n", arguments.output);
}

}  // namespace

void add_design(CLI::App& app) {
  auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command = app.add_subcommand("design", "Kalman gain and state feedback from a model -> board parameters");
  add_input(*command, "MODEL", arguments->models,
            "model file (axis-model/1); several: the axes of one machine, all with the same closed loop")
      ->required();
  const CLI::Option* const output =
      add_output(*command, "-o,--output", arguments->output,
                 "file for the board parameters (axis-params/1); with several models the folder for AXIS-params.toml");
  command->parse_complete_callback([arguments, output] {
    if (arguments->models.size() > 1) note_role(*output, FileRole::output_folder);
  });
  command->add_flag("--own", arguments->own,
                    "with several models: write the best loop of each axis, not the common one");
  command
      ->add_option("--feedforward", arguments->feedforward,
                   "zero-phase (ZPETC), or velocity: from the reference velocity alone")
      ->check(CLI::IsMember({"zero-phase", "velocity"}))
      ->capture_default_str();
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
                      "design although this effect's values (inertia, viscous, coulomb, …) are physically impossible "
                      "or not determined by the records");
  add_input(*command, "--response", arguments->response,
            "JSON of `bode` for this axis, or its records, or the word model for what the model predicts: the design "
            "is evaluated on it, and --margin, --bandwidth "
            "and --notch auto use it; with several models one file each, in the same order");
  command->add_option("--margin", arguments->margin, "raise --fc as far as this modulus margin allows (usually 0.5)")
      ->check(CLI::Range(0.05, 0.95));
  command->add_option("--bandwidth", arguments->crossover_Hz, "highest crossover frequency of the open loop, Hz")
      ->check(CLI::PositiveNumber);
  command->add_option(
      "--notch", arguments->notch,
      "HZ[,DAMPING[,DEPTH]] (defaults 0.5, 0.1), or auto: at the measured resonance where it helps most");
  command->add_option("--low-pass", arguments->low_pass, "HZ[,DAMPING] (0.7)");
  command
      ->add_option("--limits", arguments->limit_source,
                   "limits of references to write: usual (250 mm/s, 2000 mm/s^2, 50000 mm/s^3, lowered where the drive "
                   "needs it), or drive: all the acceleration and jerk that the drive allows")
      ->check(CLI::IsMember({"usual", "drive"}))
      ->capture_default_str();
  command
      ->add_option("--reserve", arguments->limits.reserve,
                   "share of the effort that these limits leave to feedback and cutting")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_option("--velocity", arguments->limits.top_speed_mm_s, "top speed of screw and guides, mm/s (250)")
      ->check(CLI::PositiveNumber);
  add_output(*command, "--report", arguments->report,
             "HTML page: a predicted step and move; with --response also the loop before and after");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool design x.toml -o x-params.toml\n"
      "  axistool design x.toml --fc 40 --zeta 0.8 --json -\n"
      "  axistool design x.toml --response bode.json --margin 0.5 --notch auto -o x-params.toml\n"
      "  axistool design x.toml --limits drive --reserve 0.4 --velocity 500 -o x-params.toml\n"
      "  axistool design x.toml y.toml --response bode-x.json bode-y.json --margin 0.5 -o machine\n"
      "A larger --rwd makes the disturbance estimate faster and noisier. A larger --fc makes the loop stiffer, until "
      "noise\n"
      "or a resonance limits it; keep it well below the observer's fn. The file also switches on the compensation of\n"
      "those effects of the model that the board supports (cogging, presliding, friction along the travel, backlash,\n"
      "tachometer): after `improve`, design again and set-params once.\n"
      "The limits keep the command below saturation with --reserve: by inertia, friction, weight, cogging, the "
      "converter's\n"
      "range, and the model's current_saturation and voltage_limit (add these effects from the amplifier's data). The\n"
      "acceleration builds up during one period of the loop, or of a lower resonance. Exit code 8 where friction "
      "leaves\n"
      "nothing for acceleration.\n"
      "Several models are the axes of one machine. They get the same closed loop (poles of loop and estimator, "
      "filters,\n"
      "feed-forward), as fast as the slowest axis allows at --margin, because axes with different lags rotate "
      "straight\n"
      "lines and turn circles into ellipses. Prints the remaining error for each feed in um, and the error with each\n"
      "axis's own best loop (--own). Exit code 8: the model's values are physically impossible.");
  command->callback([arguments] {
    arguments->options.zero_phase = arguments->feedforward == "zero-phase";
    arguments->limits.as_the_drive_allows = arguments->limit_source == "drive";
    arguments->models.size() > 1 ? run_machine(*arguments) : run(*arguments);
  });
}

}  // namespace axistool
