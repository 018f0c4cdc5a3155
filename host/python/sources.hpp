// Records and models from Python: a path, or data in memory.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <variant>
#include <vector>

#include "host/model/model_file.hpp"
#include "host/record/record_columns.hpp"

namespace axistool_python {

struct Path {
  std::string text;
};

/// A record, read in the worker thread after the conversion from Python.
class RecordSource {
 public:
  /// A path (str), or a tuple of columns (dict of NumPy arrays by their names) and header (dict of str). `name`: name
  /// of data in memory, for messages.
  RecordSource(const pybind11::handle& given, std::string name);
  host::Record read() const;
  /// The path; for data in memory, its name for messages.
  const std::string& name() const;

 private:
  std::string name_;
  std::variant<Path, host::RecordColumns> given_;
};

/// Converts a sequence of records.
std::vector<RecordSource> record_sources(const pybind11::sequence& given, const std::string& role);
/// The names, separated by commas.
std::string names_of(const std::vector<RecordSource>& sources);
std::vector<host::Record> read_all(const std::vector<RecordSource>& sources);

/// Columns as NumPy arrays, and the header.
pybind11::tuple to_python(const host::RecordColumns& record);

class ModelSource {
 public:
  /// A path (str), or a tuple with the model's text.
  explicit ModelSource(const pybind11::handle& given);
  sim::DriveDescription read(host::Bounds bounds = host::Bounds::enforced) const;
  sim::DriveDescription read_data_sheet() const;
  const std::string& name() const { return name_; }

 private:
  std::string name_, text_;
  bool is_file_ = false;
};

}  // namespace axistool_python
