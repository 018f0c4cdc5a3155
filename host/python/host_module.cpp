// The module axistool._host: the library's functions, for use by the package. Results are JSON documents and files in
// the project's formats; the package converts them to types.
#include <glog/logging.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "host/exit_codes.hpp"
#include "host/import/import_record.hpp"
#include "host/python/bindings.hpp"
#include "host/python/listening.hpp"
#include "host/python/sources.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

/// Raises the Python exception of the failure's exit code, with the same message.
void raise(const host::Failure& failure) {
  const py::object error =
      py::module_::import("axistool.errors").attr("error_of")(static_cast<int>(failure.code), failure.what());
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

/// A log with all columns that contain numbers.
host::RecordColumns read_columns(const std::string& path) {
  host::Log log = host::read_log(path);
  host::RecordColumns result;
  result.header = log.header;
  for (host::LogColumn& column : log.columns) {
    if (!column.fault.empty()) throw host::Failure(host::ExitCode::bad_input, path + ": " + column.fault);
    if (column.name.empty()) column.name = "#" + std::to_string(result.columns.size() + 1);  // the name in mappings
    result.columns.emplace_back(column.name, std::move(column.values));
  }
  return result;
}

/// Imports a log as `axistool import` does.
host::RecordColumns import_columns(const std::string& path, const std::string& map, std::optional<double> resample_s,
                                   const std::string& drive, const std::vector<std::string>& unwrap) {
  host::ImportOptions options{map.empty() ? std::vector<host::Mapping>{} : host::parse_mappings(map), resample_s,
                              drive};
  for (const std::string& column : unwrap) options.unwrap.push_back(host::parse_unwrapping(column));
  return host::columns_of(host::import_record(host::read_log(path), options));
}

}  // namespace

void bind_records(py::module_& module) {
  module.def("read_columns", [](const std::string& path) {
    return to_python(result_of(py::none(), "read", [&](const auto&) { return read_columns(path); }));
  });
  module.def("import_record", [](const std::string& path, const std::string& map, const py::object& resample_s,
                                 const std::string& drive, const std::vector<std::string>& unwrap) {
    const auto period_s = resample_s.is_none() ? std::nullopt : std::optional(resample_s.cast<double>());
    return to_python(result_of(py::none(), "import",
                               [&](const auto&) { return import_columns(path, map, period_s, drive, unwrap); }));
  });
  module.def("checked", [](const py::object& given) {
    return to_python(host::columns_of(RecordSource(given, "the record").read()));
  });
}

}  // namespace axistool_python

PYBIND11_MODULE(_host, module) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres logs rejected steps
  pybind11::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const host::Failure& failure) {
      axistool_python::raise(failure);
    }
  });
  axistool_python::bind_records(module);
  axistool_python::bind_analysis(module);
  axistool_python::bind_logs(module);
  axistool_python::bind_studies(module);
  axistool_python::bind_boards(module);
}
