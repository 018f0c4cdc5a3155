// Lists other programs that have a board open.
#pragma once

#include <string>
#include <vector>

namespace host {

struct DeviceUser {
  int process = 0;
  std::string command;  ///< its command line, shortened
};

/// Processes other than this one that hold `file` open, as far as /proc lets this user see them.
std::vector<DeviceUser> users_of(const std::string& file);

/// A hint for error messages that lists these programs: "; process 4711 (axistool capture -o jog.csv) has it open too:
/// wait for it, or end it (kill 4711)"; empty if there are none.
std::string other_users(const std::string& file);

}  // namespace host
