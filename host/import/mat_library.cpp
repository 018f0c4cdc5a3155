#include "host/import/mat_library.hpp"

namespace host {

MatLibrary load_mat_library(const LibraryName& name) {
  const ReaderLibrary library("MATLAB files", name);
  MatLibrary functions;
  library.find(functions.log_to, "Mat_LogInitFunc");
  library.find(functions.open, "Mat_Open");
  library.find(functions.close, "Mat_Close");
  library.find(functions.read_next_info, "Mat_VarReadNextInfo");
  library.find(functions.read_data, "Mat_VarReadDataAll");
  library.find(functions.free_variable, "Mat_VarFree");
  library.find(functions.field_count, "Mat_VarGetNumberOfFields");
  library.find(functions.field_names, "Mat_VarGetStructFieldnames");
  library.find(functions.field, "Mat_VarGetStructFieldByIndex");
  return functions;
}

const MatLibrary& mat_library() {
  static const MatLibrary library = load_mat_library(kMatio);
  return library;
}

}  // namespace host
