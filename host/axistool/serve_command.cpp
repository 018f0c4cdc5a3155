// axistool serve: the workbench, a page in the browser with the functions of the commands.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/own_folder.hpp"
#include "host/workbench/server.hpp"

extern char** environ;

namespace axistool {

namespace {

struct ServeArguments {
  std::string folder = ".";
  int port = 0;
  bool no_browser = false;
  host::workbench::LiveDevice board;
};

/// Opens the page through a private file that redirects to it, because the address contains the token and all users can
/// see command lines. The destructor removes the file.
class BrowserStart {
 public:
  explicit BrowserStart(const std::string& url) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
    file_ = fmt::format("{}/axistool-{}.html", host::own_folder("XDG_RUNTIME_DIR", ".local/state/axis"), ::getpid());
    const mode_t before = ::umask(077);
    host::write_file_atomically(file_, fmt::format("<meta http-equiv=\"refresh\" content=\"0;url={}\">\n", url));
    ::umask(before);
    char* words[] = {const_cast<char*>("xdg-open"), file_.data(), nullptr};
    pid_t child = 0;
    ::posix_spawnp(&child, words[0], nullptr, nullptr, words, environ);
  }
  BrowserStart(const BrowserStart&) = delete;
  BrowserStart& operator=(const BrowserStart&) = delete;
  ~BrowserStart() {
    std::error_code ignored;
    if (!file_.empty()) std::filesystem::remove(file_, ignored);
  }

 private:
  std::string file_;
};

void run(const ServeArguments& arguments) {
  std::error_code failed;
  std::filesystem::current_path(arguments.folder, failed);
  if (failed)
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: {}; name a folder", arguments.folder, failed.message()));
  host::workbench::Server server(arguments.port, arguments.board);
  catch_interrupts();
  std::jthread answering([&server] { server.run(); });
  host::write_standard_output(server.url() + "\n");
  {
    const std::unique_ptr<BrowserStart> browser =
        arguments.no_browser ? nullptr : std::make_unique<BrowserStart>(server.url());
    while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  release_interrupts();  // a second Ctrl-C ends the program at once
  server.stop();
}

}  // namespace

void add_serve(CLI::App& app) {
  auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command =
      app.add_subcommand("serve", "the workbench: compare, diagnose and add effects in the browser, on a folder");
  command->add_option("DIR", arguments->folder, "folder of models and records")->capture_default_str();
  constexpr int kLastPort = 65535;
  command->add_option("--port", arguments->port, "port on 127.0.0.1; 0 picks a free one")
      ->capture_default_str()
      ->check(CLI::Range(0, kLastPort));
  CLI::Option* const device = command->add_option(
      "--device", arguments->board.device,
      "board for the page's Live view: usb:SERIAL, sim (started by `axistool sim`), socket:PATH; default: none");
  note_role(*device, FileRole::device);
  command->add_flag_callback(
      "--sim", [arguments] { arguments->board.device = "sim"; }, "the same as --device sim");
  command->add_option("--patience", arguments->board.patience_s, "time-out for the board's answers, s")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str();
  command->add_flag("--no-browser", arguments->no_browser, "print the address only");
  command->footer(
      "Examples:\n"
      "  axistool serve\n"
      "  axistool serve measurements --port 8080 --no-browser\n"
      "  axistool serve --sim\n"
      "Prints its address when it is ready; Ctrl-C ends it. It answers only this computer, and only requests with the\n"
      "token in the address. It reads and writes nothing outside the folder. Results of jobs are in its subfolder\n"
      "\"workbench\"; extended models are beside their original. Every figure is the one that the command prints, and "
      "the\n"
      "page shows the command. With a board, one page at a time commands its axes, and they stop without it.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
