// axistool list: the connected boards.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/link/socket_link.hpp"
#include "host/link/usb_boards.hpp"

namespace axistool {

namespace {

bool simulated_board_listens() {
  try {
    host::connect_to_socket(host::default_socket_path());
    return true;
  } catch (const host::Failure&) {
    return false;
  }
}

void list_boards(const DeviceArguments& arguments) {
  nlohmann::json boards = nlohmann::json::array();
  const auto add = [&](const std::string& device, const std::string& product, const std::string& path) {
    if (arguments.device.empty() || arguments.device == device)
      boards.push_back({{"device", device}, {"product", product}, {"path", path}});
  };
  for (const host::UsbBoard& board : host::find_usb_boards())
    add("usb:" + board.serial_number, board.product, board.path);
  if (simulated_board_listens()) add("sim", "simulated board", host::default_socket_path());
  if (boards.empty()) end_with(host::ExitCode::no_such_device);
  if (!arguments.json.empty()) write_json({{"format", "axis-board-list/1"}, {"boards", boards}}, arguments.json);
  if (!talks(arguments)) return;
  for (const nlohmann::json& board : boards)
    fmt::print("{:<32} {:<20} {}\n", board["device"].get<std::string>(), board["product"].get<std::string>(),
               board["path"].get<std::string>());
  if (boards.empty())
    fmt::print("{}: plug one in, or start `axistool sim`\n", arguments.device.empty()
                                                                 ? "no board on USB, and no simulated one"
                                                                 : arguments.device + " was not found");
}

}  // namespace

void add_list(CLI::App& app) {
  auto arguments = std::make_shared<DeviceArguments>();
  CLI::App* command = app.add_subcommand("list", "List the boards that are plugged in, and the simulated one");
  command->add_option("--device", arguments->device, "list only this one: usb:SERIAL or sim");
  add_json_option(*command, arguments->json);
  command->footer(
      "Example:\n"
      "  axistool list --json -\n"
      "Exit code 3: no board found.");
  command->callback([arguments] { list_boards(*arguments); });
}

}  // namespace axistool
