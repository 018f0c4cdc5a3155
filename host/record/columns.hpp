// The columns that `axis-record/1` knows: which channel each fills, and in which unit.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "host/record/record.hpp"

namespace host {

enum class ColumnUnit { as_is, mm, m };

struct KnownColumn {
  std::string_view name;
  std::vector<double> Record::*channel;
  ColumnUnit unit = ColumnUnit::as_is;
  std::optional<sim::DriveKind> implies;  ///< the kind of drive that alone has such a column
};

inline constexpr KnownColumn kKnownColumns[] = {
    {"t_s", &Record::t_s, ColumnUnit::as_is, {}},
    {"u_V", &Record::u_V, ColumnUnit::as_is, {}},
    {"i_A", &Record::i_A, ColumnUnit::as_is, {}},
    {"x_mm", &Record::x, ColumnUnit::mm, {}},
    {"x_m", &Record::x, ColumnUnit::m, {}},
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

inline const KnownColumn* find_known_column(std::string_view name) {
  for (const KnownColumn& column : kKnownColumns)
    if (column.name == name) return &column;
  return nullptr;
}

/// What a channel is called in files that hold the drive's own units (rotary: mm, rad/s; linear: m, m/s).
inline std::string_view column_name(std::vector<double> Record::*channel, sim::DriveKind kind) {
  const ColumnUnit travel = kind == sim::DriveKind::rotary ? ColumnUnit::mm : ColumnUnit::m;
  for (const KnownColumn& column : kKnownColumns)
    if (column.channel == channel && (column.implies ? *column.implies == kind : true) &&
        (column.unit == ColumnUnit::as_is || column.unit == travel))
      return column.name;
  return {};
}

}  // namespace host
