#include "host/parameters/parameter_page.hpp"

#include <fmt/format.h>

#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

const char* type_text(firmware::ParameterType type) {
  switch (type) {
    case firmware::ParameterType::whole:
      return "whole";
    case firmware::ParameterType::toggle:
      return "switch";
    case firmware::ParameterType::real:
      break;
  }
  return "real";
}

bool is_axis(const firmware::ParameterInfo& info) { return info.scope == firmware::ParameterScope::axis; }
bool needs_standstill(const firmware::ParameterInfo& info) {
  return info.change == firmware::ParameterChange::while_disabled;
}

}  // namespace

std::string parameter_page() {
  std::string page = fmt::format(
      "# Parameters\n\n"
      "Written by `axistool parameters --markdown` from `parameter_table.hpp`; schema hash {:#010x}.\n\n"
      "A name begins with its axis (`x.`, `y.`, `z.`, `a.`, as many as there are) unless it belongs to the board. "
      "Units in\n"
      "parentheses are those of a linear drive. *Live*: may change while a drive is enabled.\n",
      firmware::kSchemaHash);
  std::string_view group;
  for (const firmware::ParameterInfo& info : firmware::kParameters) {
    if (const std::string_view its_group = info.name.substr(0, info.name.find('.')); its_group != group) {
      group = its_group;
      page += fmt::format(
          "\n## {}{}\n\n| Name | Id | Type | Unit | Range | Initially | Live | What |\n"
          "|---|---|---|---|---|---|---|---|\n",
          is_axis(info) ? "AXIS." : "", group);
    }
    const std::string unit =
        info.unit == info.linear_unit ? std::string(info.unit) : fmt::format("{} ({})", info.unit, info.linear_unit);
    const bool is_switch = info.type == firmware::ParameterType::toggle;
    page += fmt::format(
        "| `{}` | {} | {} | {} | {} | {} | {} | {} |\n", info.name, info.id, type_text(info.type), unit,
        is_switch ? "" : fmt::format("{} to {}", value_text(info, info.minimum), value_text(info, info.maximum)),
        value_text(info, info.initial), needs_standstill(info) ? "" : "yes", info.doc);
  }
  return page;
}

nlohmann::json parameter_table_json() {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place) {
    const firmware::ParameterInfo& info = info_at(place);
    rows.push_back({{"name", full_name(place)},
                    {"key", firmware::key_at(place).code},
                    {"id", info.id},
                    {"type", type_text(info.type)},
                    {"unit", info.unit},
                    {"linear_unit", info.linear_unit},
                    {"minimum", info.minimum},
                    {"maximum", info.maximum},
                    {"initial", info.initial},
                    {"while_enabled", !needs_standstill(info)},
                    {"doc", info.doc}});
  }
  return {{"format", "axis-parameter-table/1"}, {"schema_hash", firmware::kSchemaHash}, {"parameters", rows}};
}

}  // namespace host
