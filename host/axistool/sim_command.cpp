// axistool sim: a simulated board, for use without hardware.
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>

#include "firmware/app/parameters/parameter_values.hpp"
#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/external_plant/external_plant.hpp"
#include "host/external_plant/plant_server.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/model/model_file.hpp"
#include "host/number.hpp"
#include "host/open_board.hpp"
#include "host/output_target.hpp"
#include "host/own_folder.hpp"
#include "host/simulated_board/simulated_image.hpp"
#include "host/simulated_board/socket_board.hpp"
#include "host/simulated_board/usb_board.hpp"
#include "host/simulated_board/usual_wiring.hpp"

namespace axistool {

namespace {

struct SimArguments {
  std::string socket, flash, plant;
  std::vector<std::string> surfaces;
  std::array<std::string, hal::kMostAxes> models;
  std::size_t axes = hal::kAxisCount;
  std::string serial_number = "SIMULATED";
  std::uint64_t seed = 1;
  double patience_s = 10.0;
  bool forget = false, usb = false, as_plant = false;
  std::string printed, image, image_version = "next";
};

std::atomic<bool> stop = false;

std::string default_flash_file() {
  return host::own_folder("XDG_STATE_HOME", ".local/state") + "/axis/simulated-flash.bin";
}

void make_folder_of(const std::string& flash_file) {
  const auto folder = std::filesystem::path(flash_file).parent_path();
  std::error_code fault;
  if (!folder.empty()) std::filesystem::create_directories(folder, fault);
  if (fault)
    throw host::Failure(host::ExitCode::permission,
                        fmt::format("{}: cannot make the folder for the board's parameters: {}; --flash FILE keeps "
                                    "them elsewhere, --forget discards them",
                                    folder.string(), fault.message()));
}

/// Without a model, the paper's two axes alternate.
host::SimulatedDrive drive(const std::string& file, std::size_t axis) {
  return host::usual_axis(file.empty() ? host::paper_drive(firmware::kAxisNames.at(axis % 2)).value()
                                       : host::read_drive(file));
}

/// AXIS=TRAVEL: the probe is in contact at this travel and beyond, on the side away from 0.
hal::pc::SimulatedSurface surface(const std::string& text, std::size_t axes) {
  const std::size_t equals = text.find('=');
  const auto travel = host::parse_number(equals == std::string::npos ? "" : text.substr(equals + 1));
  if (!travel || *travel == 0.0)
    throw host::Failure(host::ExitCode::usage,
                        fmt::format("--probe {}: give an axis and a travel that is not 0, such as x=20", text));
  return {host::axis_index(text.substr(0, equals), axes), *travel, *travel > 0.0};
}

/// Replaces the drives by the external program; only their data sheets are used.
void hand_over(std::vector<host::SimulatedDrive>& drives, const SimArguments& arguments) {
  const auto patience =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(arguments.patience_s));
  const auto plant = std::make_shared<host::ExternalPlant>(arguments.plant, drives.size(),
                                                           drives.front().drive.data.sample_period_s, patience);
  for (std::size_t axis = 0; axis < drives.size(); ++axis) {
    drives[axis].drive = host::data_sheet_alone(drives[axis].drive);
    drives[axis].motion = host::ExternalPlant::axis(plant, axis);
  }
}

void tell(const std::string& place, const std::string& flash_file, const std::string& device) {
  fmt::print("simulated board {}\nparameters {}\nuse it with --device {}; Ctrl-C ends it\n", place,
             flash_file.empty() ? "are discarded at the end" : "in " + flash_file, device);
  std::fflush(stdout);
}

/// The machine's data sheet, for --drive of excite and commission.
void print_drive(const SimArguments& arguments) {
  const std::uint8_t axis = host::axis_index(arguments.printed, arguments.axes);
  sim::DriveDescription sheet = drive(arguments.models.at(axis), axis).drive;
  sheet.name = arguments.printed;
  sheet.effects.clear();
  fmt::print("{}", host::format_model(sheet));
}

void run(SimArguments arguments) {
  if (!arguments.printed.empty()) {
    print_drive(arguments);
    return;
  }
  if (!arguments.image.empty()) {
    const std::vector<std::byte> image = host::simulated_image(arguments.image_version);
    host::write_file_atomically(arguments.image, {reinterpret_cast<const char*>(image.data()), image.size()});
    return;
  }
  if (arguments.as_plant) {
    std::vector<sim::DriveDescription> drives;
    for (std::size_t axis = 0; axis < arguments.axes; ++axis)
      drives.push_back(drive(arguments.models[axis], axis).drive);
    host::serve_plant(drives, arguments.seed, std::cin, std::cout);
    return;
  }
  if (arguments.socket.empty()) arguments.socket = host::default_socket_path();
  host::SimulatedDeviceOptions options;
  options.seed = arguments.seed;
  for (std::size_t axis = 0; axis < arguments.axes; ++axis)
    options.drives.push_back(drive(arguments.models[axis], axis));
  for (const std::string& one : arguments.surfaces) options.surfaces.push_back(surface(one, arguments.axes));
  if (!arguments.plant.empty()) hand_over(options.drives, arguments);
  if (!arguments.forget) {
    options.flash_file = arguments.flash.empty() ? default_flash_file() : arguments.flash;
    make_folder_of(options.flash_file);
    host::output_target(options.flash_file);
  }
  host::SimulatedDevice device(options);
  std::signal(SIGINT, [](int) { stop = true; });
  std::signal(SIGTERM, [](int) { stop = true; });
  if (arguments.usb) {
    const std::string name = "usb:" + arguments.serial_number;
    tell("on USB", options.flash_file, name);
    host::serve_simulated_device_on_usb(device, arguments.serial_number, stop);
    return;
  }
  const host::OwnedDescriptor listener = host::listen_at_socket(arguments.socket);
  tell("at " + arguments.socket, options.flash_file,
       arguments.socket == host::default_socket_path() ? "sim" : "socket:" + arguments.socket);
  try {
    host::serve_simulated_device(device, listener, stop);
  } catch (const host::Failure&) {
    host::remove_socket(arguments.socket);
    throw;
  }
  host::remove_socket(arguments.socket);
}

}  // namespace

void add_sim(CLI::App& app) {
  auto arguments = std::make_shared<SimArguments>();
  CLI::App* command = app.add_subcommand("sim", "Run a simulated board: the firmware with simulated drives");
  CLI::Option* socket = command->add_option("--socket", arguments->socket,
                                            "socket to listen on; default: the one that --device sim uses");
  CLI::Option* usb = command->add_flag(
      "--usb", arguments->usb, "make it a USB device of this computer instead (as root, after modprobe vhci-hcd)");
  usb->excludes(socket);
  command->add_option("--serial", arguments->serial_number, "serial number of the board on USB")
      ->capture_default_str()
      ->needs(usb);
  command->add_option("--axes", arguments->axes, "number of axes")
      ->check(CLI::Range(std::size_t{1}, hal::kMostAxes))
      ->capture_default_str();
  for (std::size_t axis = 0; axis < hal::kMostAxes; ++axis)
    add_input(*command, fmt::format("--{}", firmware::kAxisNames[axis]), arguments->models[axis],
              axis == 0 ? "model of the drive on axis x (axis-model/1); default: the paper's x axis"
                        : "the same for the next axis");
  CLI::Option* plant = command->add_option(
      "--plant", arguments->plant,
      "external plant program instead of the drives, in lockstep (axis-plant/1); --x, --y … are then data sheets");
  command->add_option("--patience", arguments->patience_s, "time-out for the plant's answers, s")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str()
      ->needs(plant);
  command
      ->add_flag(
          "--as-plant", arguments->as_plant,
          "no board: only the drives, as the plant of another controller (axis-plant/1 on standard input and output)")
      ->excludes(plant)
      ->excludes(usb)
      ->excludes(socket);
  command
      ->add_option(
          "--probe", arguments->surfaces,
          "connect a touch probe: its contact closes at this travel from the power-up position and beyond, AXIS=mm (m)")
      ->excludes(plant);
  command->add_option("--flash", arguments->flash, "file for the board's parameters; default: in ~/.local/state/axis");
  command->add_flag("--forget", arguments->forget, "keep no parameters");
  command->add_option("--seed", arguments->seed, "seed of the sensors' noise")->capture_default_str();
  command->add_option("--print-drive", arguments->printed,
                      "print the data sheet of this axis (x, y, …), for --drive of other commands, and end");
  CLI::Option* image = add_output(*command, "--write-image", arguments->image,
                                  "write an image for the simulated board to this file, to try `update` with, and end");
  command
      ->add_option("--image-version", arguments->image_version,
                   fmt::format("version of that image; '{}' makes one that does not start", host::kHangingVersion))
      ->capture_default_str()
      ->needs(image);
  command->footer(
      "Each axis has a home switch 25 mm from its power-up position and, if rotary, one index pulse per turn.\n"
      "Examples:\n"
      "  axistool sim &\n"
      "  axistool info --device sim\n"
      "  axistool sim --print-drive x > x-drive.toml\n"
      "  sudo axistool sim --usb --serial BENCH-1 &\n"
      "  axistool sim --x my-model.toml --forget --socket /tmp/board.socket\n"
      "  axistool sim --axes 1 --x my-model.toml --as-plant\n"
      "  axistool sim --axes 1 --x data-sheet.toml --plant 'python3 05-own-plant.py' --forget");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
