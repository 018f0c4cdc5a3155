// axistool sim in a separate process, as in another terminal window.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/child.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/wait_until.hpp"

class SimulatedBoardProcess {
 public:
  /// `folder`, with trailing slash: for socket and flash file. `options`: further command-line arguments.
  explicit SimulatedBoardProcess(const std::string& folder, const std::vector<std::string>& options = {})
      : socket_(folder + "board.socket"), process_(words(folder, options)) {
    wait_until([this] { return std::filesystem::exists(socket_); });
  }
  ~SimulatedBoardProcess() { end(SIGTERM); }
  SimulatedBoardProcess(const SimulatedBoardProcess&) = delete;
  SimulatedBoardProcess& operator=(const SimulatedBoardProcess&) = delete;

  /// SIGTERM: an orderly end. SIGKILL: as if the cable were unplugged.
  void end(int signal) { process_.end(signal); }

  std::string address() const { return "socket:" + socket_; }
  std::string device() const { return " --device " + address() + " "; }
  ProgramRun run(const std::string& command, const std::string& streams = "2>&1") const {
    return run_axistool(meant(command), streams);
  }
  /// The same in the background; `output`: file for its standard output.
  Child start(const std::string& command, const std::string& output = "/dev/null") const {
    return Child({"/bin/sh", "-c", "exec \"" AXISTOOL_PROGRAM "\" " + meant(command) + " 2>/dev/null"}, output);
  }
  /// Whether the board reports that an axis moves.
  bool moves() const {
    constexpr double kSlow_mm_s = 1.0;
    const auto seen = nlohmann::json::parse(run("info --json -", "2>/dev/null").output, nullptr, false);
    if (!seen.is_object()) return false;
    return std::ranges::any_of(
        seen["axes"], [](const nlohmann::json& axis) { return std::abs(axis["velocity"].get<double>()) > kSlow_mm_s; });
  }

 private:
  std::vector<std::string> words(const std::string& folder, const std::vector<std::string>& options) const {
    std::vector<std::string> all = {AXISTOOL_PROGRAM, "sim", "--socket", socket_, "--flash", folder + "flash.bin"};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }
  std::string meant(const std::string& command) const {
    const std::size_t blank = command.find(' ');
    return command.substr(0, blank) + device() + (blank == std::string::npos ? "" : command.substr(blank));
  }

  std::string socket_;
  Child process_;
};
