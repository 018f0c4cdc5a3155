// Options that name files, and the checks of all commands' options after parsing, before anything runs.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace axistool {

enum class FileRole {
  input,
  device,  ///< an input if the text names a file: model:FILE, plant:FILE:COMMAND
  output,
  output_folder,
};

void note_role(const CLI::Option& option, FileRole role);

/// An option or positional for files that the command reads, which no output may overwrite. The only exception,
/// declared without this function, is a model that a command reads in order to write it again.
template <typename T>
CLI::Option* add_input(CLI::App& command, const std::string& name, T& destination, const std::string& help) {
  CLI::Option* const option = command.add_option(name, destination, help);
  note_role(*option, FileRole::input);
  return option;
}

/// An option for a file or, by its role, a folder to write; "-" is standard output.
CLI::Option* add_output(CLI::App& command, const std::string& name, std::string& destination, const std::string& help,
                        FileRole role = FileRole::output);

/// Checks all options: no output overwrites an input, all outputs differ and can be written, and numbers are finite
/// (option parsers accept "nan" in any range). Throws host::Failure.
void check_options(const CLI::App& program);

}  // namespace axistool
