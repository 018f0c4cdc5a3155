// axistool doctor: checks a board and its connection, with remedies.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/device_check.hpp"
#include "host/exit_codes.hpp"
#include "host/link/hid_library.hpp"
#include "host/link/udev_rule.hpp"
#include "host/link/usb_boards.hpp"
#include "host/report/terminal.hpp"

namespace axistool {

namespace {

const char* text_of(host::CheckResult result) {
  return result == host::CheckResult::good ? "good" : result == host::CheckResult::attention ? "look" : "bad";
}

host::Tone tone_of(host::CheckResult result) {
  return result == host::CheckResult::good        ? host::Tone::good
         : result == host::CheckResult::attention ? host::Tone::attention
                                                  : host::Tone::bad;
}

void print(const std::vector<host::DeviceCheck>& checks, std::FILE* where) {
  const host::Terminal terminal = host::terminal_of(where);
  for (const host::DeviceCheck& check : checks) {
    fmt::print(where, "{}  {:<18} {}\n", host::coloured(text_of(check.result), tone_of(check.result), terminal),
               check.what, check.found);
    if (!check.remedy.empty()) fmt::print(where, "      {}\n", check.remedy);
  }
}

/// If no board answers: checks the connection step by step.
void tell_the_way(const DeviceArguments& arguments) {
  if (!arguments.device.empty() && !arguments.device.starts_with("usb")) return;
  std::vector<host::DeviceCheck> checks;
  const auto add = [&](bool is_good, std::string what, std::string found, std::string remedy) {
    checks.push_back({is_good ? host::CheckResult::good : host::CheckResult::attention, std::move(what),
                      std::move(found), is_good ? "" : std::move(remedy)});
  };
  const std::size_t boards = host::find_usb_boards().size();
  add(boards > 0, "boards on USB", fmt::format("{}", boards),
      "power: is the board's own supply on, and its light? cable: use a data cable, directly to the computer; "
      "bootloader: pull BOOT0 low, then reset; `lsusb` shows whether the computer sees a new device");
  const bool has_rule = std::filesystem::exists(host::kUdevRuleFile);
  add(has_rule, "udev rule", has_rule ? host::kUdevRuleFile : "not installed",
      "sudo axistool udev-rule --install lets users open a board");
  add(false, "without a board", "a simulated one", "axistool sim, in another window; then --device sim");
  print(checks, stderr);
}

void run(const DeviceArguments& arguments) {
  std::optional<host::BoardClient> opened;
  try {
    opened.emplace(open_board(arguments));  // failures (no rights, no board) carry their own remedies
  } catch (const host::Failure& failure) {
    if (failure.code == host::ExitCode::no_such_device) tell_the_way(arguments);
    throw;
  }
  host::BoardClient& board = *opened;
  std::vector<host::DeviceCheck> checks = host::check_device(board);
  if (board.name().starts_with("usb:") && host::hid_library().backend == host::HidBackend::hidraw)
    checks.insert(checks.begin(), host::check_opening());
  const bool any_bad =
      std::ranges::any_of(checks, [](const auto& check) { return check.result == host::CheckResult::bad; });
  if (any_bad) end_with(host::ExitCode::answer_is_no);
  if (!arguments.json.empty()) {
    nlohmann::json rows = nlohmann::json::array();
    for (const host::DeviceCheck& check : checks)
      rows.push_back(
          {{"check", check.what}, {"result", text_of(check.result)}, {"found", check.found}, {"remedy", check.remedy}});
    write_json({{"format", "axis-doctor/1"}, {"device", board.name()}, {"checks", rows}}, arguments.json);
  }
  if (!talks(arguments)) return;
  print(checks, stdout);
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto arguments = std::make_shared<DeviceArguments>();
  CLI::App* command =
      app.add_subcommand("doctor", "Check the board and its connection; give the remedy for each fault");
  add_device_options(*command, *arguments);
  command->footer(
      "Example:\n"
      "  axistool doctor\n"
      "Checks USB rights, opening, firmware, saved parameters, reset cause, faults, exchange times, lost samples, loop "
      "timing.\n"
      "Exit codes: 1 a check failed; 3 no board; 4 no permission (with the rule that gives it).");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
