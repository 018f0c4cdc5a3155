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

std::vector<std::string> shipped_scenarios() {
  std::vector<std::string> names;
  std::error_code fault;
  for (const auto& entry : fs::directory_iterator(shipped_file("scenarios"), fault))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

std::string scenario_file(const std::string& name) {
  std::error_code fault;
  if (fs::exists(name, fault)) return name;
  const std::string stem = name.ends_with(".toml") ? name.substr(0, name.size() - 5) : name;
  const std::vector<std::string> shipped = shipped_scenarios();
  if (std::ranges::find(shipped, stem) != shipped.end()) return shipped_file("scenarios/" + stem + ".toml");
  const std::vector<std::string_view> known(shipped.begin(), shipped.end());
  throw Failure(ExitCode::usage, fmt::format("{}: no such file, and no shipped scenario is called so{}; those are: {}",
                                             name, did_you_mean(stem, known), fmt::join(shipped, ", ")));
}

}  // namespace host
