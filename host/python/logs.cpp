// open, sheet, cut, shift: make records from a log and a data sheet.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "host/model/sheet_text.hpp"
#include "host/opening/opening.hpp"
#include "host/python/bindings.hpp"
#include "host/python/listening.hpp"
#include "host/python/sources.hpp"
#include "host/read_file.hpp"
#include "host/record/edit_record.hpp"
#include "host/record/read_record.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

/// Returns the document; each record's name, axis, columns and header; and the text of the mapping file.
py::tuple open_logs(const std::vector<std::string>& paths, const py::object& sheet, const std::string& map,
                    const std::string& hal, const std::string& drive, std::optional<double> torque_constant,
                    std::optional<double> period_s) {
  const auto sheet_file = sheet.is_none() ? std::nullopt : std::optional<ModelSource>(sheet);
  const host::Opening opening = result_of(py::none(), "open", [&](const auto&) {
    host::OpeningOptions options;
    if (sheet_file) options.hints.sheet = sheet_file->read_data_sheet().data;
    options.hints.torque_constant = torque_constant;
    options.hints.period_s = period_s;
    options.hints.drive = drive;
    options.hal_path = hal;
    host::take_map(options, map);
    return host::open_logs(paths, options);
  });
  py::list records;
  for (const host::OpenedRecord* one : opening.records())
    records.append(py::make_tuple(one->name, one->axis, to_python(host::columns_of(one->record))));
  return py::make_tuple(host::to_json(opening, {}).dump(), records, host::format_mapping(opening));
}

std::string sheet(const std::string& name, bool is_rotary, bool by_current, std::optional<double> motor_constant,
                  std::optional<double> lead_mm, std::optional<double> step_mm, std::optional<double> period_s) {
  host::SheetValues values;
  values.name = name;
  values.kind = is_rotary ? sim::DriveKind::rotary : sim::DriveKind::linear;
  values.by_current = by_current;
  values.motor_constant = motor_constant;
  values.lead_mm_per_turn = lead_mm;
  values.encoder_step_mm = step_mm;
  values.sample_period_s = period_s;
  return host::sheet_text(values);
}

/// `text`: text of a record in memory; if empty, reads the file at `path`.
py::tuple cut(const std::string& path, const std::string& text, double from_s, double to_s) {
  return to_python(result_of(py::none(), "cut", [&](const auto&) {
    const std::string whole = text.empty() ? host::read_file(path, host::kRecordSize) : text;
    return host::columns_of(host::cut_record(whole, path, from_s, to_s));
  }));
}

py::tuple shift(const py::object& given, const std::string& channel, double by_s) {
  const RecordSource source(given, "the record");
  return to_python(result_of(py::none(), "shift", [&](const auto&) {
    return host::columns_of(host::shift_channel(source.read(), channel, by_s));
  }));
}

}  // namespace

void bind_logs(py::module_& module) {
  module.def("open_logs", &open_logs);
  module.def("sheet", &sheet);
  module.def("cut", &cut);
  module.def("shift", &shift);
}

}  // namespace axistool_python
