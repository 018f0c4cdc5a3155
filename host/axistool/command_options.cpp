#include "host/axistool/command_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "host/exit_codes.hpp"
#include "host/output_target.hpp"

namespace axistool {

namespace {

std::map<const CLI::Option*, FileRole>& roles() {
  static std::map<const CLI::Option*, FileRole> noted;
  return noted;
}

void require_finite(const CLI::Option& option) {
  if (!option.get_type_name().starts_with("FLOAT")) return;
  for (const std::string& text : option.results())
    if (!std::isfinite(std::strtod(text.c_str(), nullptr)))
      throw host::Failure(host::ExitCode::usage,
                          fmt::format("{}: {}: expected a finite number", option.get_name(), text));
}

/// `argument`: "jog.csv", or "x=model.toml" if the option assigns files to axes.
void protect(const std::string& argument) {
  host::protect_input(argument);
  if (const std::size_t equals = argument.find('='); equals != std::string::npos)
    host::protect_input(argument.substr(equals + 1));
}

void protect_in_device(const std::string& words) {
  for (const std::string_view prefix : {"model:", "plant:"})
    if (words.starts_with(prefix)) {
      const std::string file = words.substr(prefix.size());
      host::protect_input(file);
      host::protect_input(file.substr(0, file.find(':')));
    }
}

void check_outputs(const CLI::App& command) {
  std::map<std::string, std::string> taken;  // file -> the option that writes it
  for (const CLI::Option* option : command.get_options()) {
    const auto found = roles().find(option);
    if (found == roles().end() || found->second < FileRole::output) continue;
    for (const std::string& name : option->results()) {
      if (name == "-") continue;
      if (found->second == FileRole::output_folder) {
        host::require_output_folder(name);
        continue;
      }
      const auto [other, is_new] =
          taken.emplace(std::filesystem::weakly_canonical(host::output_target(name)).string(), option->get_name());
      if (!is_new)
        throw host::Failure(host::ExitCode::usage,
                            fmt::format("{}: {} and {} would both write this file; give two names", name, other->second,
                                        option->get_name()));
    }
  }
}

}  // namespace

void note_role(const CLI::Option& option, FileRole role) { roles()[&option] = role; }

CLI::Option* add_output(CLI::App& command, const std::string& name, std::string& destination, const std::string& help,
                        FileRole role) {
  CLI::Option* const option = command.add_option(name, destination, help);
  note_role(*option, role);
  return option;
}

void check_options(const CLI::App& program) {
  for (const CLI::App* command : program.get_subcommands()) {
    for (const CLI::Option* option : command->get_options()) {
      require_finite(*option);
      const auto found = roles().find(option);
      if (found == roles().end() || found->second >= FileRole::output) continue;
      for (const std::string& argument : option->results())
        found->second == FileRole::device ? protect_in_device(argument) : protect(argument);
    }
    check_outputs(*command);
  }
}

}  // namespace axistool
