#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>

#include "host/exit_codes.hpp"
#include "host/import/confined_reader.hpp"
#include "host/import/log_file.hpp"
#include "host/import/mat_library.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

struct CloseMat {
  void operator()(mat_t* file) const { mat_library().close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { mat_library().free_variable(variable); }
};

std::string_view class_name(const matvar_t& variable) {
  if (variable.isLogical != 0) return "logical";
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return "double";
    case MAT_C_SINGLE:
      return "single";
    case MAT_C_INT8:
      return "int8";
    case MAT_C_UINT8:
      return "uint8";
    case MAT_C_INT16:
      return "int16";
    case MAT_C_UINT16:
      return "uint16";
    case MAT_C_INT32:
      return "int32";
    case MAT_C_UINT32:
      return "uint32";
    case MAT_C_INT64:
      return "int64";
    case MAT_C_UINT64:
      return "uint64";
    case MAT_C_STRUCT:
      return "struct";
    case MAT_C_CELL:
      return "cell";
    case MAT_C_CHAR:
      return "char";
    case MAT_C_SPARSE:
      return "sparse";
    default:
      return "of a class that holds no numbers";
  }
}

std::string size_of(const matvar_t& variable) {
  std::string text;
  for (int k = 0; k < variable.rank; ++k) text += fmt::format("{}{}", k == 0 ? "" : " x ", variable.dims[k]);
  return text;
}

/// A part of an array in the library's memory: every `stride`-th element from `first` on, `count` in all.
struct ValueRange {
  std::size_t first, count, stride;
};

template <typename T>
std::vector<double> as_doubles(const void* data, const ValueRange& stretch) {
  const T* at = static_cast<const T*>(data) + stretch.first;
  std::vector<double> values(stretch.count);
  for (std::size_t k = 0; k < stretch.count; ++k) values[k] = static_cast<double>(at[k * stretch.stride]);
  return values;
}

/// The numbers; empty if the array contains no real numbers. Every element is converted to a double before any
/// computation, so that integers neither wrap nor saturate.
std::vector<double> numbers_of(const matvar_t& variable, const ValueRange& stretch) {
  if (variable.isComplex != 0 || variable.data == nullptr) return {};
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return as_doubles<double>(variable.data, stretch);
    case MAT_C_SINGLE:
      return as_doubles<float>(variable.data, stretch);
    case MAT_C_INT8:
      return as_doubles<std::int8_t>(variable.data, stretch);
    case MAT_C_UINT8:
      return as_doubles<std::uint8_t>(variable.data, stretch);
    case MAT_C_INT16:
      return as_doubles<std::int16_t>(variable.data, stretch);
    case MAT_C_UINT16:
      return as_doubles<std::uint16_t>(variable.data, stretch);
    case MAT_C_INT32:
      return as_doubles<std::int32_t>(variable.data, stretch);
    case MAT_C_UINT32:
      return as_doubles<std::uint32_t>(variable.data, stretch);
    case MAT_C_INT64:
      return as_doubles<std::int64_t>(variable.data, stretch);
    case MAT_C_UINT64:
      return as_doubles<std::uint64_t>(variable.data, stretch);
    default:
      return {};
  }
}

std::size_t element_count(const matvar_t& variable) {
  std::size_t count = 1;
  for (int k = 0; k < variable.rank; ++k) count *= variable.dims[k];
  return count;
}

void append_array(const matvar_t& variable, const std::string& name, const std::string& kind, Log& log) {
  const std::size_t count = element_count(variable);
  const std::size_t bytes = variable.data_size > 0 ? variable.nbytes / static_cast<std::size_t>(variable.data_size) : 0;
  const bool is_readable = variable.rank == 2 && bytes >= count && count > 0;
  if (!is_readable || numbers_of(variable, {0, 1, 1}).empty()) {
    log.columns.push_back({name, kind, {}, fmt::format("'{}' ({}) holds no real numbers; name another", name, kind)});
    return;
  }
  const std::size_t rows = variable.dims[0], columns = variable.dims[1];
  if (rows == 1 || columns == 1) {
    log.columns.push_back({name, kind, numbers_of(variable, {0, count, 1}), {}});
    return;
  }
  const bool samples_run_down = rows >= columns;
  const std::size_t channels = samples_run_down ? columns : rows;
  for (std::size_t c = 0; c < channels; ++c)
    log.columns.push_back(
        {fmt::format("{}({})", name, c + 1),
         fmt::format("{} of {}", samples_run_down ? "column" : "row", kind),
         numbers_of(variable, samples_run_down ? ValueRange{c * rows, rows, 1} : ValueRange{c, columns, rows}),
         {}});
}

constexpr int kDeepestStruct = 8;

/// The number of values that a variable announces. A compressed file may announce more than fits into memory.
double announced_numbers(const matvar_t& variable, int depth) {
  double count = 1.0;
  for (int k = 0; k < variable.rank; ++k) count *= static_cast<double>(variable.dims[k]);
  if (variable.class_type != MAT_C_STRUCT && variable.class_type != MAT_C_CELL) return count;
  if (count > static_cast<double>(kMostLogNumbers) || depth > kDeepestStruct || variable.data == nullptr) return count;
  const std::size_t parts = variable.nbytes / sizeof(matvar_t*);
  for (std::size_t k = 0; k < parts; ++k)
    if (const matvar_t* part = static_cast<matvar_t* const*>(variable.data)[k])
      count += announced_numbers(*part, depth + 1);
  return count;
}

void append_variable(matvar_t& variable, const std::string& name, int depth, Log& log) {
  const std::string kind =
      fmt::format("{}{}, {}", variable.isComplex != 0 ? "complex " : "", class_name(variable), size_of(variable));
  if (variable.class_type != MAT_C_STRUCT || element_count(variable) != 1 || depth >= kDeepestStruct) {
    append_array(variable, name, kind, log);
    return;
  }
  const unsigned fields = mat_library().field_count(&variable);
  char* const* names = mat_library().field_names(&variable);
  for (unsigned k = 0; k < fields; ++k)
    if (matvar_t* field = mat_library().field(&variable, k, 0))
      append_variable(*field, fmt::format("{}.{}", name, names[k]), depth + 1, log);
}

/// Whether a level 5 file (MAT-File Format, chapter 1: the tag of an element gives its size) ends within a variable.
/// The library would fill the rest of the variable with undefined values.
bool ends_within_variable(const std::string& path) {
  constexpr std::size_t kHead = 128, kMark = 126, kTag = 8;
  std::ifstream file(path, std::ios::binary);
  std::array<char, kHead> head{};
  const bool is_big = file.read(head.data(), kHead) && std::string_view(head.data() + kMark, 2) == "MI";
  if (!is_big && std::string_view(head.data() + kMark, 2) != "IM") return false;  // not a level 5 file
  if (head[is_big ? 124 : 125] != 1) return false;
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(path));
  for (std::size_t at = kHead; at < size;) {
    std::array<unsigned char, kTag> tag{};
    file.seekg(static_cast<std::streamoff>(at));
    if (!file.read(reinterpret_cast<char*>(tag.data()), kTag)) return true;
    if (is_big) std::reverse(tag.begin() + 4, tag.end());
    at += kTag + tag[4] + (std::size_t{tag[5]} << 8U) + (std::size_t{tag[6]} << 16U) + (std::size_t{tag[7]} << 24U);
    if (at > size) return true;
  }
  return false;
}

Log read_by_matio(const std::string& path) {
  const MatLibrary& matio = mat_library();
  if (ends_within_variable(path))
    throw Failure(ExitCode::bad_input, fmt::format("{}: cut off within a variable; save it again", path));
  matio.log_to("axistool", [](int, char*) {});  // failures are reported by exceptions
  const std::unique_ptr<mat_t, CloseMat> file(matio.open(path.c_str(), MAT_ACC_RDONLY));
  if (!file)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: not a MATLAB file that can be read; save it again with save -v7 or -v7.3", path));
  Log log;
  log.path = path;
  log.layout = "mat";
  double announced = 0.0;
  while (const std::unique_ptr<matvar_t, FreeVariable> variable{matio.read_next_info(file.get())}) {
    const std::string name = variable->name != nullptr ? variable->name : "";
    announced += announced_numbers(*variable, 0);
    if (!(announced <= static_cast<double>(kMostLogNumbers)))
      throw Failure(ExitCode::bad_input, fmt::format("{}: with '{}' it unpacks to more than {} numbers, the most that "
                                                     "a log may have; save fewer variables or rows",
                                                     path, name, kMostLogNumbers));
    if (matio.read_data(file.get(), variable.get()) == 0) append_variable(*variable, name, 0, log);
  }
  if (log.columns.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: the file holds no variables, or is cut off; save it again", path));
  return log;
}

}  // namespace

Log read_mat(const std::string& path) {
  mat_library();
  return read_confined(path, kMatio.file, read_by_matio);
}

}  // namespace host
