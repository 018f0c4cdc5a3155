// The option --json, the same in every command.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"

namespace axistool {

inline void add_json_option(CLI::App& command, std::string& destination) {
  add_output(command, "--json", destination, "write the result as JSON to this file; - prints only JSON");
}

/// `destination`: "-" for standard output, otherwise a file, which is replaced as a whole.
inline void write_json(const nlohmann::json& document, const std::string& destination) {
  const std::string text = document.dump(2) + "\n";
  if (destination == "-") {
    host::write_standard_output(text);
  } else {
    host::write_file_atomically(destination, text);
  }
}

}  // namespace axistool
