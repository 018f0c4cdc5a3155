#include "host/axistool/device_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "host/axistool/json_output.hpp"
#include "host/exit_codes.hpp"
#include "host/external_plant/external_plant.hpp"
#include "host/link/open_device.hpp"
#include "host/model/model_file.hpp"
#include "host/simulated_board/simulated_link.hpp"

namespace axistool {

void add_device_options(CLI::App& command, DeviceArguments& arguments) {
  command
      .add_option("--device", arguments.device,
                  "board: usb:SERIAL, sim (started by `axistool sim`), socket:PATH, model:FILE (simulated within this "
                  "command), plant:DRIVE.toml:COMMAND (the same around a program); "
                  "default: the only one on USB")
      ->envname("AXIS_DEVICE");
  command.add_flag_callback(
      "--sim", [&arguments] { arguments.device = "sim"; }, "the same as --device sim");
  command
      .add_option("--patience", arguments.patience_s,
                  "seconds that the board may take to answer, more where it is emulated")
      ->envname("AXIS_PATIENCE")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str();
  add_json_option(command, arguments.json);
}

void add_change_options(CLI::App& command, DeviceArguments& arguments) {
  command.add_flag("--dry-run", arguments.dry_run, "say what would be done, and do nothing");
  command.add_flag("-y,--yes", arguments.yes, "do not ask");
}

namespace {

/// With this drive on every axis; it lives as long as the command.
std::unique_ptr<host::ReportLink> simulated_board(const std::string& model) {
  const host::SimulatedDrive drive{host::read_model(model)};
  return std::make_unique<host::SimulatedLink>(
      host::SimulatedDeviceOptions{std::vector<host::SimulatedDrive>(hal::kAxisCount, drive), "", 1});
}

/// A board of one axis around a program: "DRIVE.toml:COMMAND".
std::unique_ptr<host::ReportLink> board_around_program(const std::string& words, std::chrono::milliseconds patience) {
  const std::size_t colon = words.find(':');
  if (colon == std::string::npos)
    throw host::Failure(host::ExitCode::usage,
                        "--device plant:" + words + ": write plant:DRIVE.toml:COMMAND, data sheet and program");
  const sim::DriveDescription drive = host::data_sheet_alone(host::read_drive(words.substr(0, colon)));
  const auto plant =
      std::make_shared<host::ExternalPlant>(words.substr(colon + 1), 1, drive.data.sample_period_s, patience);
  return std::make_unique<host::SimulatedLink>(
      host::SimulatedDeviceOptions{{{drive, {}, host::ExternalPlant::axis(plant, 0)}}, "", 1});
}

}  // namespace

host::BoardClient open_board(const DeviceArguments& arguments) {
  const auto patience =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(arguments.patience_s));
  constexpr std::string_view kModel = "model:", kPlant = "plant:";
  if (arguments.device.starts_with(kModel))
    return host::BoardClient(simulated_board(arguments.device.substr(kModel.size())), patience);
  if (arguments.device.starts_with(kPlant))
    return host::BoardClient(board_around_program(arguments.device.substr(kPlant.size()), patience), patience);
  return host::BoardClient(host::open_device(arguments.device), patience);
}

bool talks(const DeviceArguments& arguments) { return arguments.json != "-"; }

void require_consent(const DeviceArguments& arguments, const std::string& question) {
  if (arguments.yes) return;
  std::string answer;
  if (::isatty(STDIN_FILENO) == 1) {
    fmt::print(stderr, "{} [y/N] ", question);
    std::getline(std::cin, answer);
  }
  if (answer == "y" || answer == "yes") return;
  throw host::Failure(host::ExitCode::refused, question + " Not done: answer y, or give --yes");
}

std::uint8_t axis_index(const std::string& name, std::size_t axes) {
  for (std::size_t axis = 0; axis < axes; ++axis)
    if (firmware::kAxisNames[axis] == name) return static_cast<std::uint8_t>(axis);
  throw host::Failure(host::ExitCode::usage,
                      fmt::format("the board has no axis '{}'; it has {}", name,
                                  fmt::join(firmware::kAxisNames.begin(), firmware::kAxisNames.begin() + axes, ", ")));
}

std::uint8_t axis_mask(const std::vector<std::string>& names, std::size_t axes) {
  unsigned mask = names.empty() ? (1u << axes) - 1 : 0;
  for (const std::string& name : names) mask |= 1u << axis_index(name, axes);
  return static_cast<std::uint8_t>(mask);
}

}  // namespace axistool
