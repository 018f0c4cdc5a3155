// Manual pages, from the same text as --help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace axistool {

/// axistool(1) for the program itself, axistool-NAME(1) for a command, in man(7)'s macros.
std::string man_page(const CLI::App& app, const CLI::App& command);

}  // namespace axistool
