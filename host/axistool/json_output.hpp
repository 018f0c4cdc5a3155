// The option --json, the same in every command.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "host/atomic_file.hpp"

namespace axistool {

inline void add_json_option(CLI::App& command, std::string& destination) {
  command.add_option("--json", destination, "write the result as JSON to this file; - is standard output, alone");
}

/// "-" prints the one document on standard output; anything else is a file, replaced as a whole.
inline void write_json(const nlohmann::json& document, const std::string& destination) {
  const std::string text = document.dump(2) + "\n";
  if (destination == "-") {
    std::fputs(text.c_str(), stdout);
  } else {
    host::write_file_atomically(destination, text);
  }
}

}  // namespace axistool
