// A background program for a test; its standard output is discarded or written to a file.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

class Child {
 public:
  /// `words`: program and arguments. `output`: what takes the standard output.
  explicit Child(std::vector<std::string> words, const std::string& output = "/dev/null") {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int taker = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    process_ = fork();
    if (process_ < 0) throw std::runtime_error("cannot start " + words.front());
    if (process_ == 0) {
      dup2(taker, STDOUT_FILENO);
      execvp(arguments[0], arguments.data());
      _exit(127);
    }
    close(taker);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { kill(); }

  /// Stops it until go_on() or its end.
  void pause() const { ::kill(process_, SIGSTOP); }
  void go_on() const { ::kill(process_, SIGCONT); }
  void signal(int number) const { ::kill(process_, number); }
  /// Waits for its end; returns its exit code, or minus the number of the signal that ended it.
  int wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  /// Sends `signal`; returns as wait() does. SIGTERM is an orderly end, SIGKILL like a pulled plug.
  int end(int signal) {
    if (process_ <= 0) return 0;
    ::kill(process_, signal);
    return wait();
  }
  void kill() { end(SIGKILL); }

 private:
  pid_t process_ = -1;
};
