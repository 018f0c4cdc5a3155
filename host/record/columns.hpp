// The columns of `axis-record/1`, with channel and unit of each.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/record/record.hpp"

namespace host {

enum class ColumnUnit { as_is, mm, m };

struct KnownColumn {
  std::string_view name;
  std::vector<double> Record::*channel;
  ColumnUnit unit = ColumnUnit::as_is;
  std::optional<sim::DriveKind> implies;  ///< the only kind of drive that has such a column
};

inline constexpr KnownColumn kKnownColumns[] = {
    {"t_s", &Record::t_s, ColumnUnit::as_is, {}},
    {"u_V", &Record::u_V, ColumnUnit::as_is, {}},
    {"i_A", &Record::i_A, ColumnUnit::as_is, {}},
    {"x_mm", &Record::x, ColumnUnit::mm, {}},
    {"x_m", &Record::x, ColumnUnit::m, {}},
    {"x2_mm", &Record::x2, ColumnUnit::mm, {}},
    {"x2_m", &Record::x2, ColumnUnit::m, {}},
    {"w_rad_s", &Record::w, ColumnUnit::as_is, sim::DriveKind::rotary},
    {"v_m_s", &Record::w, ColumnUnit::m, sim::DriveKind::linear},
    {"v_mm_s", &Record::w, ColumnUnit::mm, sim::DriveKind::linear},
    {"x_ref_mm", &Record::x_ref, ColumnUnit::mm, {}},
    {"x_ref_m", &Record::x_ref, ColumnUnit::m, {}},
    {"w_ref_rad_s", &Record::w_ref, ColumnUnit::as_is, sim::DriveKind::rotary},
    {"v_ref_m_s", &Record::w_ref, ColumnUnit::m, sim::DriveKind::linear},
    {"v_ref_mm_s", &Record::w_ref, ColumnUnit::mm, sim::DriveKind::linear},
    {"temp_C", &Record::temp_C, ColumnUnit::as_is, {}},
};

/// All channels, in the order in which records are written.
inline constexpr std::vector<double> Record::*kChannelsInFileOrder[] = {
    &Record::t_s, &Record::u_V,   &Record::i_A,   &Record::x,     &Record::x2,
    &Record::w,   &Record::x_ref, &Record::w_ref, &Record::temp_C};

inline const KnownColumn* find_known_column(std::string_view name) {
  for (const KnownColumn& column : kKnownColumns)
    if (column.name == name) return &column;
  return nullptr;
}

/// Name of a channel in files with the units of the drive (rotary: mm, rad/s; linear: m, m/s).
std::string_view column_name(std::vector<double> Record::*channel, sim::DriveKind kind);

/// Name of a channel in the record's file; column_name() if the record does not come from a file.
std::string_view name_in_file(const Record& record, std::vector<double> Record::*channel);

/// Fault of a set of column names: a duplicate, two columns for one quantity, columns of different kinds of drive, or a
/// missing required column. Empty if there is no fault.
std::string fault_of_columns(std::span<const std::string_view> names);

/// Numbers under one of the format's column names, in the unit of that name.
struct NamedColumn {
  std::string_view name;
  std::vector<double> values;
};

/// Names the first two columns with the same varying numbers, which are one channel logged twice. Empty if there are
/// none.
std::string fault_of_copies(std::span<const NamedColumn> columns);

/// Puts columns into the channels of the record, in the units of the drive, and determines the kind of drive from the
/// speed column. The names must be free of faults.
void fill_channels(std::vector<NamedColumn> columns, Record& record);

}  // namespace host
