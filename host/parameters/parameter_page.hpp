// The documentation of the parameters, generated from their table.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace host {

/// A Markdown page with one table for each group: firmware/app/parameters/README.md.
std::string parameter_page();

/// The same as data: format "axis-parameter-table/1".
nlohmann::json parameter_table_json();

}  // namespace host
