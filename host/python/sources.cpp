#include "host/python/sources.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "host/record/read_record.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

host::RecordColumns columns_from(const py::tuple& given) {
  host::RecordColumns result;
  for (const auto& [name, values] : given[0].cast<py::dict>()) {
    const auto array = Values::ensure(values);
    if (!array) throw py::error_already_set();
    result.columns.emplace_back(name.cast<std::string>(),
                                std::vector<double>(array.data(), array.data() + array.size()));
  }
  for (const auto& [key, value] : given[1].cast<py::dict>())
    result.header.emplace(key.cast<std::string>(), value.cast<std::string>());
  return result;
}

}  // namespace

RecordSource::RecordSource(const py::handle& given, std::string name) : name_(std::move(name)) {
  if (py::isinstance<py::str>(given))
    given_ = Path{given.cast<std::string>()};
  else
    given_ = columns_from(given.cast<py::tuple>());
}

host::Record RecordSource::read() const {
  if (const Path* path = std::get_if<Path>(&given_)) return host::read_record(path->text);
  return host::record_of(std::get<host::RecordColumns>(given_), name_);
}

const std::string& RecordSource::name() const {
  const Path* path = std::get_if<Path>(&given_);
  return path != nullptr ? path->text : name_;
}

std::vector<RecordSource> record_sources(const py::sequence& given, const std::string& role) {
  std::vector<RecordSource> sources;
  for (const py::handle& one : given) sources.emplace_back(one, fmt::format("{} {}", role, sources.size() + 1));
  return sources;
}

std::string names_of(const std::vector<RecordSource>& sources) {
  std::string names;
  for (const RecordSource& source : sources) names += (names.empty() ? "" : ", ") + source.name();
  return names;
}

std::vector<host::Record> read_all(const std::vector<RecordSource>& sources) {
  std::vector<host::Record> records;
  for (const RecordSource& source : sources) records.push_back(source.read());
  return records;
}

py::tuple to_python(const host::RecordColumns& record) {
  py::dict columns, header;
  for (const auto& [name, values] : record.columns)
    columns[py::str(name)] = py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
  for (const auto& [key, value] : record.header) header[py::str(key)] = value;
  return py::make_tuple(columns, header);
}

ModelSource::ModelSource(const py::handle& given) : name_("the model"), is_file_(py::isinstance<py::str>(given)) {
  if (is_file_)
    name_ = given.cast<std::string>();
  else
    text_ = given.cast<py::tuple>()[0].cast<std::string>();
}

sim::DriveDescription ModelSource::read(host::Bounds bounds) const {
  return is_file_ ? host::read_model(name_, bounds) : host::parse_model(text_, name_, bounds);
}

sim::DriveDescription ModelSource::read_data_sheet() const {
  return is_file_ ? host::read_drive(name_) : host::parse_drive(text_, name_);
}

}  // namespace axistool_python
