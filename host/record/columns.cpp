#include "host/record/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace host {

namespace {

bool give(std::span<const std::string_view> names, std::vector<double> Record::*channel) {
  return std::ranges::any_of(names, [channel](std::string_view name) {
    const KnownColumn* known = find_known_column(name);
    return known != nullptr && known->channel == channel;
  });
}

std::string fault_of_pair(std::string_view first, std::string_view second) {
  if (first == second) return fmt::format("duplicated channel: two columns are called {}; keep one of them", first);
  const KnownColumn *one = find_known_column(first), *other = find_known_column(second);
  if (one == nullptr || other == nullptr) return {};
  if (one->channel == other->channel)
    return fmt::format("columns {} and {} hold the same quantity; keep one of them, or rename the other", first,
                       second);
  if (one->implies && other->implies && *one->implies != *other->implies)
    return fmt::format(
        "columns {} and {} belong to different kinds of drive (rad: rotary, m: linear); keep the one that fits, or "
        "rename the other",
        first, second);
  return {};
}

std::string_view missing_among(std::span<const std::string_view> names) {
  if (!give(names, &Record::t_s)) return "t_s (time in seconds)";
  // If there is no command or current, a reference suffices, for the tracking error.
  const bool has_reference = give(names, &Record::x_ref) || give(names, &Record::w_ref);
  if (!give(names, &Record::u_V) && !give(names, &Record::i_A) && !has_reference)
    return "u_V (command in volts) or i_A (motor current)";
  if (!give(names, &Record::x) && !give(names, &Record::w))
    return "a position (x_mm or x_m) or a speed (w_rad_s, v_m_s or v_mm_s)";
  return {};
}

bool varies(const std::vector<double>& values) {
  return std::ranges::adjacent_find(values, std::not_equal_to<>()) != values.end();
}

}  // namespace

std::string_view column_name(std::vector<double> Record::*channel, sim::DriveKind kind) {
  const ColumnUnit own = kind == sim::DriveKind::rotary ? ColumnUnit::mm : ColumnUnit::m;
  for (const KnownColumn& column : kKnownColumns) {
    const bool fits = !column.implies || *column.implies == kind;
    if (column.channel == channel && fits && (column.unit == ColumnUnit::as_is || column.unit == own))
      return column.name;
  }
  return {};
}

std::string_view name_in_file(const Record& record, std::vector<double> Record::*channel) {
  for (const std::string& name : record.columns)
    if (const KnownColumn* known = find_known_column(name); known != nullptr && known->channel == channel) return name;
  return column_name(channel, record.kind);
}

std::string fault_of_columns(std::span<const std::string_view> names) {
  for (std::size_t k = 0; k < names.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (std::string fault = fault_of_pair(names[j], names[k]); !fault.empty()) return fault;
  const std::string_view missing = missing_among(names);
  if (missing.empty()) return {};
  return fmt::format(
      "missing column: {}; there is {}. Rename the column, or convert its unit with axistool import --map (for example "
      "t_s=t_ms*0.001)",
      missing, fmt::join(names, ", "));
}

std::string fault_of_copies(std::span<const NamedColumn> columns) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (columns[j].values == columns[k].values && varies(columns[k].values))
        return fmt::format(
            "duplicated channel: columns {} and {} hold the same numbers in every row; log each quantity separately, "
            "or remove the copy",
            columns[j].name, columns[k].name);
  return {};
}

void fill_channels(std::vector<NamedColumn> columns, Record& record) {
  record.kind_is_presumed = true;
  for (const NamedColumn& column : columns) {
    const KnownColumn& known = *find_known_column(column.name);
    if (known.implies) {
      record.kind = *known.implies;
      record.kind_is_presumed = false;
    } else if (known.channel == &Record::x && record.kind_is_presumed) {
      record.kind = known.unit == ColumnUnit::m ? sim::DriveKind::linear : sim::DriveKind::rotary;
    }
  }
  const ColumnUnit own = record.kind == sim::DriveKind::rotary ? ColumnUnit::mm : ColumnUnit::m;
  for (NamedColumn& column : columns) {
    const KnownColumn& known = *find_known_column(column.name);
    record.columns.emplace_back(column.name);
    if (known.unit != ColumnUnit::as_is && known.unit != own)
      for (double& value : column.values) value = own == ColumnUnit::mm ? value * 1000.0 : value / 1000.0;
    record.*known.channel = std::move(column.values);
  }
}

}  // namespace host
