// The options of every command that uses a board.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "host/open_board.hpp"

namespace axistool {

struct DeviceArguments {
  std::string device, json;
  double patience_s = std::chrono::duration<double>(host::BoardClient::kPatience).count();
  bool dry_run = false, yes = false;
};

/// --device and --patience, also from the environment variables AXIS_DEVICE and AXIS_PATIENCE, and --json.
void add_device_options(CLI::App& command, DeviceArguments& arguments);
/// --dry-run and --yes, for commands that change something.
void add_change_options(CLI::App& command, DeviceArguments& arguments);

host::BoardClient open_board(const DeviceArguments& arguments);

/// False if standard output is reserved for JSON; then nothing else is printed there.
bool talks(const DeviceArguments& arguments);

/// Asks on a terminal unless consent is already `given`. Without a terminal only `option` gives consent. Throws
/// Failure(refused) without consent.
void require_consent(bool given, const std::string& question, std::string_view option);
/// The same; --yes gives consent.
void require_consent(const DeviceArguments& arguments, const std::string& question);

using host::axis_index;
/// Bit mask of the named axes; all axes if `names` is empty.
std::uint8_t axis_mask(const std::vector<std::string>& names, std::size_t axes);

}  // namespace axistool
