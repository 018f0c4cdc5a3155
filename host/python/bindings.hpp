// The parts of the module axistool._host.
#pragma once

#include <pybind11/pybind11.h>

namespace axistool_python {

void bind_records(pybind11::module_& module);
void bind_analysis(pybind11::module_& module);
void bind_logs(pybind11::module_& module);
void bind_studies(pybind11::module_& module);
void bind_boards(pybind11::module_& module);

}  // namespace axistool_python
