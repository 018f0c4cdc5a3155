// axistool commission: commissions an unknown axis in one command, or all axes of a machine.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "host/atomic_file.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/json_output.hpp"
#include "host/commission/commission.hpp"
#include "host/commission/matched_loops.hpp"
#include "host/commission/start.hpp"
#include "host/external_plant/external_plant.hpp"
#include "host/model/model_file.hpp"
#include "host/shipped_files.hpp"
#include "host/simulated_board/simulated_link.hpp"
#include "host/simulated_board/usual_wiring.hpp"

namespace axistool {

namespace {

struct CommissionArguments : DeviceArguments {
  std::vector<std::string> axes, models, drives, boxes;  ///< models, drives, boxes: one for all axes, or one for each
  std::string plant, folder, home, from, to;
  double bandwidth_Hz = host::CommissionOptions{}.bandwidth_Hz, modulus = host::CommissionOptions{}.modulus;
  std::uint64_t seed = 1;
  std::optional<double> overtravel, force_N;
  bool save = false;
};

bool is_simulated(const CommissionArguments& arguments) {
  return !arguments.models.empty() || !arguments.plant.empty();
}

/// The value for axis `i`; empty if the option was not given.
std::string of_axis(const std::vector<std::string>& given, std::size_t i) {
  return given.empty() ? "" : given[given.size() == 1 ? 0 : i];
}

/// The usual wiring, with a home switch within the box.
hal::pc::AxisWiring wiring_of(const host::CommissionOptions& options) {
  const double usual = options.sheet.data.kind == sim::DriveKind::rotary ? 25.0 : 0.025;
  return host::usual_wiring(options.sheet.data, std::min(usual, options.box.travel / 4.0));
}

/// An axis with the folder of its results.
struct Axis : host::CommissionStart {
  sim::DriveDescription machine;  ///< to simulate
};

/// The board, or simulated axes behind the board's own protocol.
host::BoardClient board_of(const CommissionArguments& arguments, const std::vector<Axis>& axes) {
  if (!is_simulated(arguments)) return open_board(arguments);
  std::size_t last = 0;
  for (const Axis& axis : axes) last = std::max<std::size_t>(last, axis.options.axis);
  std::vector<host::SimulatedDrive> drives(last + 1);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const auto named = std::ranges::find(axes, i, [](const Axis& axis) { return std::size_t{axis.options.axis}; });
    const Axis& like = named == axes.end() ? axes.front() : *named;
    drives[i].drive = like.machine;
    drives[i].wiring = wiring_of(like.options);
  }
  if (!arguments.plant.empty()) {
    const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(std::max(arguments.patience_s, 10.0)));
    const auto plant = std::make_shared<host::ExternalPlant>(arguments.plant, drives.size(),
                                                             drives.front().drive.data.sample_period_s, patience);
    for (std::size_t i = 0; i < drives.size(); ++i) {
      drives[i].drive = host::data_sheet_alone(drives[i].drive);
      drives[i].motion = host::ExternalPlant::axis(plant, i);
    }
  }
  return host::BoardClient(
      std::make_unique<host::SimulatedLink>(host::SimulatedDeviceOptions{drives, "", arguments.seed}));
}

/// Homing mode: from the command line, else from the simulated board's wiring, else from the board's parameters.
std::optional<host::CommissionHoming> homing_of(const CommissionArguments& arguments,
                                                const host::CommissionOptions& options) {
  using firmware::HomingMode;
  if (arguments.home.empty() && !is_simulated(arguments)) return std::nullopt;
  const host::UsualHome usual = host::usual_home(wiring_of(options));
  if (arguments.home.empty()) return host::CommissionHoming{usual.mode, usual.position};
  static const std::map<std::string, HomingMode> kModes{{"none", HomingMode::none},
                                                        {"switch", HomingMode::home_switch},
                                                        {"index", HomingMode::index},
                                                        {"both", HomingMode::switch_and_index}};
  const bool is_backward = arguments.home.starts_with('-');
  return host::CommissionHoming{kModes.at(arguments.home.substr(is_backward ? 1 : 0)), 0.0, is_backward};
}

/// The data sheet: from the command line, else of the simulated machine; empty: that of the folder.
std::optional<sim::DriveDescription> sheet_of(const std::string& drive, const std::string& model) {
  if (!drive.empty()) return host::read_drive(drive);
  if (model.empty()) return std::nullopt;
  sim::DriveDescription sheet = host::read_drive(host::machine_file(model));
  sheet.effects.clear();  // the effects are to be found
  return sheet;
}

Axis axis_of(const CommissionArguments& arguments, std::size_t i, const std::string& path) {
  const std::string model = of_axis(arguments.models, i);
  host::CommissionStart start =
      host::start_commission({.axis = arguments.axes[i],
                              .folder = path,
                              .sheet = sheet_of(of_axis(arguments.drives, i), model),
                              .box = of_axis(arguments.boxes, i),
                              .overtravel = arguments.overtravel,
                              .force_N = arguments.force_N,
                              .is_simulated = is_simulated(arguments),
                              .continues = arguments.axes.size() > 1 || !arguments.from.empty()});
  start.options.bandwidth_Hz = arguments.bandwidth_Hz;
  start.options.modulus = arguments.modulus;
  start.options.save = arguments.save;
  start.options.homing = homing_of(arguments, start.options);
  const sim::DriveDescription machine =
      model.empty() ? start.options.sheet : host::read_drive(host::machine_file(model));
  return {std::move(start), machine};
}

void require_one_or_all(const CommissionArguments& arguments) {
  for (const auto& [name, given] : {std::pair("--sim", &arguments.models), std::pair("--drive", &arguments.drives),
                                    std::pair("--box", &arguments.boxes)})
    if (given->size() > 1 && given->size() != arguments.axes.size())
      throw host::Failure(
          host::ExitCode::usage,
          fmt::format("{} is given {} times for {} axes: give it once for all axes, or once for each, in "
                      "the order of the axes",
                      name, given->size(), arguments.axes.size()));
  for (std::size_t i = 0; i < arguments.axes.size(); ++i)
    if (std::ranges::count(arguments.axes, arguments.axes[i]) > 1)
      throw host::Failure(host::ExitCode::usage, fmt::format("axis {} is named twice", arguments.axes[i]));
}

void tell_pages(const CommissionArguments& arguments, const std::vector<Axis>& axes) {
  if (!talks(arguments)) return;
  for (const Axis& axis : axes)
    if (axis.folder->document()["page"].is_string())
      fmt::print("Page: {}\n", axis.folder->document()["page"].get<std::string>());
}

void run(const CommissionArguments& arguments) {
  require_one_or_all(arguments);
  const bool is_machine = arguments.axes.size() > 1;
  const std::size_t last = host::kCommissionSteps.size() - 1;
  const std::size_t to = arguments.to.empty() ? last : host::commission_step(arguments.to);
  std::vector<Axis> axes;
  for (std::size_t i = 0; i < arguments.axes.size(); ++i)
    axes.push_back(axis_of(
        arguments, i,
        is_machine ? (std::filesystem::path(arguments.folder) / arguments.axes[i]).string() : arguments.folder));
  host::BoardClient board = board_of(arguments, axes);
  for (const std::string& axis : arguments.axes) axis_index(axis, board.axis_count());
  host::CommissionTalk talk;
  talk.consents = [&](const std::string& question) {
    require_consent(arguments, question);
    return true;
  };
  talk.stop = interrupted;
  talk.computes = [](bool computes) { computes ? release_interrupts() : catch_interrupts(); };
  if (talks(arguments))
    talk.tell = [](const std::string& text) {
      fmt::print("{}\n", text);
      std::fflush(stdout);
    };
  catch_interrupts();
  std::vector<host::CommissionedAxis> done;
  for (Axis& axis : axes) {
    if (is_machine) talk.tell(fmt::format("Axis {}", axis.options.axis_name));
    // An interrupted machine continues: a complete axis stays unchanged.
    const std::size_t next = is_machine ? axis.folder->first_undone().value_or(last + 1) : 0;
    const std::size_t from = arguments.from.empty() ? next : host::commission_step(arguments.from);
    if (from <= to) host::commission_axis(board, axis.options, talk, *axis.folder, from, to);
    done.push_back({axis.options, axis.folder.get()});
  }
  nlohmann::json document = axes.front().folder->document();
  if (is_machine) {
    document = {{"format", "axis-machine-commission/1"}, {"axes", nlohmann::json::object()}, {"loops", nullptr}};
    for (const Axis& axis : axes) document["axes"][axis.options.axis_name] = axis.folder->document();
    if (to == last) document["loops"] = host::match_loops(board, done, talk);
    host::write_file_atomically((std::filesystem::path(arguments.folder) / "machine.json").string(),
                                document.dump(2) + "\n");
  }
  if (!arguments.json.empty()) write_json(document, arguments.json);
  tell_pages(arguments, axes);
}

std::string footer() {
  std::string text =
      "Examples:\n"
      "  axistool commission x --sim cogging -o x --yes\n"
      "  axistool commission x --drive x.toml --box travel=80,speed=200,volts=3,time=360 -o x\n"
      "  axistool commission x -o x --from diagnose\n"
      "  axistool commission x y --drive x.toml --drive y.toml --box travel=80,speed=200,volts=3,time=360 -o machine\n"
      "  axistool commission x --plant 'python3 05-own-plant.py' --drive 05-own-plant.toml -o own --yes\n"
      "Every step asks before the axis moves. Its results are files in the folder; --from continues from them.\n"
      "Several axes are one machine: each has a folder of its own in that of -o, and after the last one all get the\n"
      "same closed loop, so that straight lines stay straight (machine.json). The same command continues a machine\n"
      "that was interrupted. Steps of an axis:\n";
  for (const host::CommissionStepText& step : host::kCommissionSteps)
    text += fmt::format("  {:<11} {}\n", step.name, step.does);
  return text + "Shipped machines for --sim: " + host::shipped_machines_text();
}

}  // namespace

void add_commission(CLI::App& app) {
  auto arguments = std::make_shared<CommissionArguments>();
  CLI::App* command = app.add_subcommand(
      "commission", "Commission an unknown axis: record, identify, find the missing effect, compensate");
  command->add_option("AXIS", arguments->axes, "x, y, …; several: the axes of one machine")->required();
  add_output(*command, "-o,--output", arguments->folder, "folder for every result", FileRole::output_folder)
      ->required();
  // One value for each occurrence of the option, so that the names of axes may follow it.
  add_input(*command, "--sim", arguments->models,
            "simulate this machine instead of using a board: a model file or a shipped machine; with several axes once "
            "for all, or once for each")
      ->allow_extra_args(false);
  command->add_option("--plant", arguments->plant, "program that simulates the machine, in lockstep (axis-plant/1)");
  add_input(*command, "--drive", arguments->drives, "data sheet of the drive (default: that of --sim); as --sim")
      ->allow_extra_args(false);
  command
      ->add_option("--box", arguments->boxes,
                   "travel=…,speed=…,volts=…,time=…: mm (linear: m), mm/s, V, total s; as --sim")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--overtravel", arguments->overtravel,
          "free beyond the box on each side, up to the hard stops, mm (linear: m); a speed from which the axis "
          "needs more to stop is refused once the drive is identified")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--home", arguments->home,
                   "how to home within the box: none, switch, index, both; -switch, -both if the switch is on the "
                   "negative side (default: homing.mode of the board)")
      ->check(CLI::IsMember({"none", "switch", "index", "both", "-switch", "-index", "-both"}));
  command->add_option("--from", arguments->from, "continue at this step");
  command->add_option("--to", arguments->to, "end after this step");
  command->add_option("--bandwidth", arguments->bandwidth_Hz, "bandwidth of the first closed loop, Hz")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1000.0));
  command->add_option("--margin", arguments->modulus, "modulus margin to keep when the bandwidth is raised")
      ->capture_default_str()
      ->check(CLI::Range(0.2, 0.9));
  command
      ->add_option(
          "--force", arguments->force_N,
          "amplitude of the process force on the table that the axis has to bear, N: the estimator is tuned for "
          "the least deviation under it (default: unknown; the axis stays as stiff as with the first estimator)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", arguments->seed, "seed of the simulated machine's noise")->capture_default_str();
  command->add_flag("--save", arguments->save, "save the better parameters in the board's flash");
  command
      ->add_option("--device", arguments->device, "board: usb:SERIAL, sim, socket:PATH; default: the only one on USB")
      ->envname("AXIS_DEVICE");
  command->add_option("--patience", arguments->patience_s, "seconds that board or plant may take to answer")
      ->envname("AXIS_PATIENCE")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str();
  command->add_flag("-y,--yes", arguments->yes, "do not ask");
  add_json_option(*command, arguments->json);
  command->footer(footer());
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
