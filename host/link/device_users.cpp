#include "host/link/device_users.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace host {

namespace {

namespace fs = std::filesystem;

/// Process number of a folder in /proc; 0 if it is not a process.
int process_of(const fs::path& folder) {
  const std::string name = folder.filename().string();
  int number = 0;
  const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), number);
  return fault == std::errc() && end == name.data() + name.size() ? number : 0;
}

bool holds_open(const fs::path& process, const fs::path& file) {
  std::error_code fault;
  for (fs::directory_iterator open(process / "fd", fault), end; !fault && open != end; open.increment(fault)) {
    std::error_code unreadable;
    if (fs::read_symlink(open->path(), unreadable) == file) return true;
  }
  return false;
}

std::string command_of(const fs::path& process) {
  constexpr std::size_t kLongest = 80;
  std::ifstream in(process / "cmdline", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  std::ranges::replace(text, '\0', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return text.size() > kLongest ? text.substr(0, kLongest) + "…" : text;
}

}  // namespace

std::vector<DeviceUser> users_of(const std::string& file) {
  std::error_code fault;
  const fs::path wanted = fs::canonical(file, fault);
  std::vector<DeviceUser> users;
  if (fault) return users;
  for (fs::directory_iterator process("/proc", fault), end; !fault && process != end; process.increment(fault)) {
    const int number = process_of(process->path());
    if (number != 0 && number != ::getpid() && holds_open(process->path(), wanted))
      users.push_back({number, command_of(process->path())});
  }
  std::ranges::sort(users, {}, &DeviceUser::process);
  return users;
}

std::string other_users(const std::string& file) {
  const std::vector<DeviceUser> users = users_of(file);
  if (users.empty()) return "";
  std::vector<std::string> names;
  for (const DeviceUser& user : users) names.push_back(fmt::format("process {} ({})", user.process, user.command));
  return fmt::format("; {} {} it open too: wait for {}, or end {} (kill {})", fmt::join(names, ", "),
                     users.size() == 1 ? "has" : "have", users.size() == 1 ? "its end" : "their ends",
                     users.size() == 1 ? "it" : "them", users.front().process);
}

}  // namespace host
