// axistool faults, clear-faults: shows a board's faults and clears them.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>

#include "firmware/core/supervision/fault_table.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/board_report.hpp"
#include "host/device/fault_log.hpp"
#include "host/device/fault_record.hpp"

namespace axistool {

namespace {

struct FaultArguments : DeviceArguments {
  std::string record;
  bool linear = false;
};

nlohmann::json faults_json(const host::BoardState& status) {
  nlohmann::json axes = nlohmann::json::array();
  for (std::size_t axis = 0; axis < status.axis.size(); ++axis) {
    const auto& fault = firmware::fault_info(static_cast<firmware::AxisFault>(status.axis[axis].fault));
    axes.push_back({{"axis", firmware::kAxisNames[axis]},
                    {"state", host::state_text(status.axis[axis])},
                    {"fault", fault.name},
                    {"number", status.axis[axis].fault},
                    {"cause", fault.cause},
                    {"remedy", fault.remedy},
                    {"second_fault",
                     firmware::fault_info(static_cast<firmware::AxisFault>(status.axis[axis].second_fault)).name}});
  }
  return {{"format", "axis-faults/1"},
          {"axes", axes},
          {"store", host::store_text(status.store_state)},
          {"reset_cause", host::reset_text(status.reset_cause)}};
}

bool has_fault(const host::BoardState& status) {
  bool any = host::store_problem(status).has_value();
  for (const firmware::AxisStatus& axis : status.axis) any = any || axis.fault != 0;
  return any;
}

void print_faults(const host::BoardState& status) {
  for (std::size_t axis = 0; axis < status.axis.size(); ++axis) {
    const auto& fault = firmware::fault_info(static_cast<firmware::AxisFault>(status.axis[axis].fault));
    fmt::print("{}: {}, {}\n", firmware::kAxisNames[axis], host::state_text(status.axis[axis]),
               status.axis[axis].fault == 0 ? "no fault" : host::fault_text(status.axis[axis]));
    if (status.axis[axis].fault != 0) fmt::print("   cause:  {}\n   remedy: {}\n", fault.cause, fault.remedy);
  }
  if (const auto problem = host::store_problem(status)) fmt::print("store: {}\n", *problem);
  fmt::print("last reset: {}\n", host::reset_text(status.reset_cause));
}

void tell(const FaultArguments& arguments, const host::BoardState& status) {
  if (has_fault(status)) end_with(host::ExitCode::device_fault);
  if (!arguments.json.empty()) write_json(faults_json(status), arguments.json);
  if (talks(arguments)) print_faults(status);
}

void tell_all(const FaultArguments& arguments, host::BoardClient& board, const host::BoardState& status) {
  if (has_fault(status)) end_with(host::ExitCode::device_fault);
  const host::FaultLog log = board.fault_log();
  std::optional<firmware::ParameterValues> values;
  if (board.identify().schema_hash == firmware::kSchemaHash) values = board.read_values();
  const firmware::ParameterValues* known = values ? &*values : nullptr;
  if (!arguments.json.empty()) {
    nlohmann::json document = faults_json(status);
    document.update({{"run_h", log.run_h}, {"log", host::fault_log_json(log, known)}});
    write_json(document, arguments.json);
  }
  if (!talks(arguments)) return;
  fmt::print("{}the board has run for {:.2f} h\n", host::fault_log_text(log, known), log.run_h);
  print_faults(status);
}

void faults(const FaultArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const host::BoardState status = board.status();
  tell_all(arguments, board, status);
  if (arguments.record.empty()) return;
  board.require_same_table();
  const sim::DriveKind kind = arguments.linear ? sim::DriveKind::linear : sim::DriveKind::rotary;
  for (std::uint8_t axis = 0; axis < status.axis.size(); ++axis) {
    if (status.axis[axis].fault == 0) continue;
    const auto record = host::read_fault_record(board, axis, kind);
    if (!record) continue;
    host::write_record(*record, arguments.record);
    if (talks(arguments))
      fmt::print("the last {:.0f} ms of {} before its fault: {}\n", 1e3 * record->t_s.back(),
                 firmware::kAxisNames[axis], arguments.record);
    return;
  }
}

void clear_faults(const FaultArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  if (!arguments.dry_run) board.clear_faults();
  board.wait(std::chrono::milliseconds(arguments.dry_run ? 0 : 300));  // time for the self-test after clearing
  tell(arguments, board.status());
}

}  // namespace

void add_faults(CLI::App& app) {
  auto arguments = std::make_shared<FaultArguments>();
  CLI::App* command =
      app.add_subcommand("faults", "Show a board's last 64 faults, with cause and remedy of those active now");
  add_output(*command, "--record", arguments->record,
             "write the samples that the axis kept from before its fault to this file");
  command->add_flag("--linear", arguments->linear, "the drive is linear: m and m/s");
  add_device_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool faults\n"
      "  axistool faults --record last.csv\n"
      "The log survives power-off. Each line gives the board's running time and the axis's state and position; --json "
      "gives everything.\n"
      "Exit code 6: a fault is active.");
  command->callback([arguments] { faults(*arguments); });
}

void add_clear_faults(CLI::App& app) {
  auto arguments = std::make_shared<FaultArguments>();
  CLI::App* command = app.add_subcommand("clear-faults", "Clear a board's faults and repeat its self-test");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer("Example:\n  axistool clear-faults\nExit code 6: a fault has come back.");
  command->callback([arguments] { clear_faults(*arguments); });
}

}  // namespace axistool
