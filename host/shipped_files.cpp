#include "host/shipped_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"

namespace host {

namespace fs = std::filesystem;

std::string shipped_file(const std::string& name) {
  const char* given = std::getenv("AXISTOOL_SHARE");
  if (given != nullptr && *given != '\0') return (fs::path(given) / name).string();
  std::error_code fault;
  const fs::path program = fs::read_symlink("/proc/self/exe", fault);
  return (program.parent_path().parent_path() / "share" / "axistool" / name).string();
}

namespace {

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code fault;
  for (const auto& entry : fs::directory_iterator(shipped_file(folder), fault))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

/// `what`: "scenario".
std::string file_or_shipped(const std::string& name, const std::string& folder, const std::string& what) {
  std::error_code fault;
  if (fs::exists(name, fault) && !fs::is_directory(name, fault)) return name;
  const std::string stem = name.ends_with(".toml") ? name.substr(0, name.size() - 5) : name;
  const std::vector<std::string> shipped = names_in(folder);
  if (std::ranges::find(shipped, stem) != shipped.end()) return shipped_file(folder + "/" + stem + ".toml");
  const std::vector<std::string_view> known(shipped.begin(), shipped.end());
  throw Failure(ExitCode::usage, fmt::format("{}: no such file, and no shipped {} of this name{}; shipped: {}", name,
                                             what, did_you_mean(stem, known), fmt::join(shipped, ", ")));
}

}  // namespace

std::vector<std::string> shipped_scenarios() { return names_in("scenarios"); }

std::string scenario_file(const std::string& name) { return file_or_shipped(name, "scenarios", "scenario"); }

std::vector<std::string> shipped_machines() { return names_in("machines"); }

std::string shipped_machines_text() { return fmt::format("{}", fmt::join(shipped_machines(), ", ")); }

std::string machine_file(const std::string& name) { return file_or_shipped(name, "machines", "machine"); }

}  // namespace host
