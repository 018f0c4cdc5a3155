// axistool sim: a simulated board, to try everything without one.
#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/device/socket_board.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/model/model_file.hpp"

namespace axistool {

namespace {

struct SimArguments {
  std::string socket, flash, x, y;
  std::uint64_t seed = 1;
  bool forget = false;
};

std::atomic<bool> stop = false;

std::string default_flash_file() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state != nullptr && *state != '\0') return std::string(state) + "/axis/simulated-flash.bin";
  return std::string(home != nullptr ? home : "/tmp") + "/.local/state/axis/simulated-flash.bin";
}

sim::DriveDescription drive(const std::string& file, const char* axis) {
  return file.empty() ? host::paper_drive(axis).value() : host::read_model(file);
}

void run(SimArguments arguments) {
  if (arguments.socket.empty()) arguments.socket = host::default_socket_path();
  host::SimulatedDeviceOptions options{drive(arguments.x, "x"), drive(arguments.y, "y"), {}, arguments.seed};
  if (!arguments.forget) {
    options.flash_file = arguments.flash.empty() ? default_flash_file() : arguments.flash;
    if (const auto folder = std::filesystem::path(options.flash_file).parent_path(); !folder.empty())
      std::filesystem::create_directories(folder);
  }
  host::SimulatedDevice device(options);
  const host::OwnedDescriptor listener = host::listen_at_socket(arguments.socket);
  std::signal(SIGINT, [](int) { stop = true; });
  std::signal(SIGTERM, [](int) { stop = true; });
  fmt::print("simulated board at {}\nparameters {}\nuse it with --device {}; Ctrl-C ends it\n", arguments.socket,
             arguments.forget ? "are forgotten at the end" : "in " + options.flash_file,
             arguments.socket == host::default_socket_path() ? "sim" : "socket:" + arguments.socket);
  std::fflush(stdout);
  host::serve_simulated_device(device, listener, stop);
  std::filesystem::remove(arguments.socket);
}

}  // namespace

void add_sim(CLI::App& app) {
  auto arguments = std::make_shared<SimArguments>();
  CLI::App* command = app.add_subcommand("sim", "Run a simulated board: the firmware's program with drives behind it");
  command->add_option("--socket", arguments->socket, "where it listens; default: where --device sim looks");
  command->add_option("--x", arguments->x, "model of the drive on axis x (axis-model/1); default: the paper's x axis");
  command->add_option("--y", arguments->y, "likewise y");
  command->add_option("--flash", arguments->flash, "file that keeps its parameters; default: in ~/.local/state/axis");
  command->add_flag("--forget", arguments->forget, "keep no parameters");
  command->add_option("--seed", arguments->seed, "of the sensors' noise")->capture_default_str();
  command->footer(
      "Examples:\n"
      "  axistool sim &\n"
      "  axistool info --device sim\n"
      "  axistool sim --x my-model.toml --forget --socket /tmp/board.socket");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
