// matio, which reads MATLAB files.
#pragma once

#include <matio.h>

#include "host/import/reader_library.hpp"

namespace host {

/// The functions of matio for reading.
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

/// The library kMatio. Throws as ReaderLibrary does.
const MatLibrary& mat_library();

/// The library of this name.
MatLibrary load_mat_library(const LibraryName& name);

}  // namespace host
