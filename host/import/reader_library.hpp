// Libraries that read one kind of log. Each is loaded when the first such file is read, because they depend on some
// forty further libraries, which other commands do not need.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/shared_library.hpp"

namespace host {

/// File name for the dynamic linker, with the version whose headers were used for this program, and its Debian package.
struct LibraryName {
  std::string file, package;
};
extern const LibraryName kMatio, kHdf5, kSqlite, kLz4, kZstd;

/// The library stays loaded until the program ends. Throws Failure(bad_input) if it is not installed or lacks a
/// function.
class ReaderLibrary {
 public:
  /// `what`: the files that the library reads, for messages: "MATLAB files".
  ReaderLibrary(std::string_view what, const LibraryName& name) : library_(name.file), name_(name) {
    if (!library_.is_loaded())
      throw Failure(ExitCode::bad_input,
                    fmt::format("{} are read by {}, which cannot be loaded: apt-get install {}\n({})", what, name.file,
                                name.package, library_.why_not()));
  }

  template <typename Symbol>
  void find(Symbol*& symbol, const char* name) const {
    if (!library_.find(symbol, name))
      throw Failure(ExitCode::bad_input, fmt::format("{} has no function {}: apt-get install --reinstall {}",
                                                     name_.file, name, name_.package));
  }

 private:
  SharedLibrary library_;
  LibraryName name_;
};

}  // namespace host
