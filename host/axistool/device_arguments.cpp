#include "host/axistool/device_arguments.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "host/axistool/json_output.hpp"
#include "host/exit_codes.hpp"
#include "host/open_board.hpp"

namespace axistool {

void add_device_options(CLI::App& command, DeviceArguments& arguments) {
  CLI::Option* const device = command
                                  .add_option("--device", arguments.device,
                                              "board: usb:SERIAL, sim (started by `axistool sim`), socket:PATH, "
                                              "model:FILE (simulated within this command), plant:DRIVE.toml:COMMAND "
                                              "(the same with an external plant program); default: the only one on USB")
                                  ->envname("AXIS_DEVICE");
  note_role(*device, FileRole::device);
  command.add_flag_callback(
      "--sim", [&arguments] { arguments.device = "sim"; }, "the same as --device sim");
  command
      .add_option("--patience", arguments.patience_s,
                  "time-out for the board's answers, s; give more if it is emulated")
      ->envname("AXIS_PATIENCE")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str();
  add_json_option(command, arguments.json);
}

void add_change_options(CLI::App& command, DeviceArguments& arguments) {
  command.add_flag("--dry-run", arguments.dry_run, "print what would be done, and do nothing");
  command.add_flag("-y,--yes", arguments.yes, "do not ask");
}

host::BoardClient open_board(const DeviceArguments& arguments) {
  return host::open_board(arguments.device, std::chrono::duration<double>(arguments.patience_s));
}

bool talks(const DeviceArguments& arguments) { return arguments.json != "-"; }

void require_consent(bool given, const std::string& question, std::string_view option) {
  if (given) return;
  std::string answer;
  if (::isatty(STDIN_FILENO) == 1) {
    fmt::print(stderr, "{} [y/N] ", question);
    std::getline(std::cin, answer);
  }
  if (answer == "y" || answer == "yes") return;
  throw host::Failure(host::ExitCode::refused, fmt::format("{} Not done: answer y, or give {}", question, option));
}

void require_consent(const DeviceArguments& arguments, const std::string& question) {
  require_consent(arguments.yes, question, "--yes");
}

std::uint8_t axis_mask(const std::vector<std::string>& names, std::size_t axes) {
  unsigned mask = names.empty() ? (1u << axes) - 1 : 0;
  for (const std::string& name : names) mask |= 1u << axis_index(name, axes);
  return static_cast<std::uint8_t>(mask);
}

}  // namespace axistool
