// axistool sim in a process of its own, as a user has it in another window.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/host/axistool/run_axistool.hpp"

class SimulatedBoardProcess {
 public:
  /// `folder`, with its slash, holds socket and flash. `options`: more words for the command line.
  explicit SimulatedBoardProcess(const std::string& folder, std::vector<std::string> options = {})
      : socket_(folder + "board.socket") {
    std::vector<std::string> words = {AXISTOOL_PROGRAM, "sim", "--socket", socket_, "--flash", folder + "flash.bin"};
    words.insert(words.end(), options.begin(), options.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
      const int null = ::open("/dev/null", O_WRONLY);
      ::dup2(null, STDOUT_FILENO);
      ::execv(AXISTOOL_PROGRAM, arguments.data());
      ::_exit(127);
    }
    for (int i = 0; i < 500 && !std::filesystem::exists(socket_); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ~SimulatedBoardProcess() { end(SIGTERM); }
  SimulatedBoardProcess(const SimulatedBoardProcess&) = delete;
  SimulatedBoardProcess& operator=(const SimulatedBoardProcess&) = delete;

  /// SIGTERM: an orderly end. SIGKILL: the plug is pulled.
  void end(int signal) {
    if (process_ <= 0) return;
    ::kill(process_, signal);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }

  std::string address() const { return "socket:" + socket_; }
  std::string device() const { return " --device " + address() + " "; }
  ProgramRun run(const std::string& command, const std::string& streams = "2>&1") const {
    const std::size_t blank = command.find(' ');
    return run_axistool(command.substr(0, blank) + device() + (blank == std::string::npos ? "" : command.substr(blank)),
                        streams);
  }

 private:
  std::string socket_;
  pid_t process_ = -1;
};
