// axistool doctor: what is wrong with a board or the way to it, and what to do.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/device_check.hpp"
#include "host/link/hid_library.hpp"
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

void run(const DeviceArguments& arguments) {
  host::BoardClient board = open_board(arguments);  // rights and presence: its failures have their remedies
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
  const host::Terminal terminal = host::terminal_of(stdout);
  for (const host::DeviceCheck& check : checks) {
    fmt::print("{}  {:<18} {}\n", host::coloured(text_of(check.result), tone_of(check.result), terminal), check.what,
               check.found);
    if (!check.remedy.empty()) fmt::print("      {}\n", check.remedy);
  }
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto arguments = std::make_shared<DeviceArguments>();
  CLI::App* command = app.add_subcommand("doctor", "What is wrong with a board or the way to it, and what to do");
  add_device_options(*command, *arguments);
  command->footer(
      "Example:\n  axistool doctor\n"
      "Looks at USB rights, opening, firmware, saved parameters, reset cause, faults, exchange times, lost samples, "
      "loop "
      "timing.\n"
      "Exit codes: 1 a check failed; 3 no board; 4 no permission (with the rule that gives it).");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
