#include "host/record/mat_library.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/shared_library.hpp"

namespace host {

MatLibrary load_mat_library(const std::string& file) {
  const SharedLibrary library(file);
  if (!library.is_loaded())
    throw Failure(ExitCode::bad_input,
                  fmt::format("MATLAB files are read by {}, which cannot be loaded: apt-get install {}\n({})", file,
                              AXIS_MATIO_PACKAGE, library.why_not()));
  MatLibrary functions;
  const auto find = [&](auto& function, const char* name) {
    if (!library.find(function, name))
      throw Failure(ExitCode::bad_input, fmt::format("{} has no function {}: apt-get install --reinstall {}", file,
                                                     name, AXIS_MATIO_PACKAGE));
  };
  find(functions.log_to, "Mat_LogInitFunc");
  find(functions.open, "Mat_Open");
  find(functions.close, "Mat_Close");
  find(functions.read_next_info, "Mat_VarReadNextInfo");
  find(functions.read_data, "Mat_VarReadDataAll");
  find(functions.free_variable, "Mat_VarFree");
  find(functions.field_count, "Mat_VarGetNumberOfFields");
  find(functions.field_names, "Mat_VarGetStructFieldnames");
  find(functions.field, "Mat_VarGetStructFieldByIndex");
  return functions;
}

const MatLibrary& mat_library() {
  static const MatLibrary library = load_mat_library(AXIS_MATIO_LIBRARY);
  return library;
}

}  // namespace host
