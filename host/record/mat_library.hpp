// matio, loaded when the first MATLAB file is read: it brings some forty further libraries with it, which no other
// command of axistool should wait for.
#pragma once

#include <matio.h>

#include <string>

namespace host {

/// The functions of matio that read.
struct MatLibrary {
  decltype(&Mat_LogInitFunc) log_to = nullptr;
  decltype(&Mat_Open) open = nullptr;
  decltype(&Mat_Close) close = nullptr;
  decltype(&Mat_VarReadNextInfo) read_next_info = nullptr;
  decltype(&Mat_VarReadDataAll) read_data = nullptr;
  decltype(&Mat_VarFree) free_variable = nullptr;
  decltype(&Mat_VarGetNumberOfFields) field_count = nullptr;
  decltype(&Mat_VarGetStructFieldnames) field_names = nullptr;
  decltype(&Mat_VarGetStructFieldByIndex) field = nullptr;
};

/// That of which the headers were used to build this program; stays loaded until the program ends. Throws Failure
/// (bad_input) when it is not installed.
const MatLibrary& mat_library();

/// The library named `file`. Throws Failure (bad_input) when it is not installed, or is not matio.
MatLibrary load_mat_library(const std::string& file);

}  // namespace host
