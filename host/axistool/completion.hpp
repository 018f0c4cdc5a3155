// Candidates for the last word of a command line, for shell completion.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace axistool {

struct Completion {
  std::string word;
  std::string help;  ///< a line; may be empty
};

struct Completions {
  std::vector<Completion> words;
  /// Endings of files that are also candidates, without their dots; "*" stands for any file. Empty: no files.
  std::vector<std::string> files;
};

/// `words`: the words after the program's name; the last one, possibly empty, is incomplete.
Completions complete(const CLI::App& app, const std::vector<std::string>& words);

/// The script for bash, zsh or fish, which calls `axistool complete`.
std::string completion_script(const std::string& shell);

}  // namespace axistool
