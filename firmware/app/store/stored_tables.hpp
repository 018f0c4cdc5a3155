// The tables of pitch errors in a slot of the parameter store, one after the other, after the slot's parameters.
#pragma once

#include <array>
#include <cstring>
#include <span>

#include "firmware/app/crc32.hpp"
#include "firmware/core/compensation/pitch_table.hpp"

namespace firmware {

/// Header before a table's points. Little-endian.
struct StoredTableHead {
  std::uint32_t magic = 0;
  std::uint16_t axis = 0;
  std::uint16_t points = 0;
  std::uint32_t resolution_bits = 0;  ///< drive.encoder_resolution, whose counts the table is in; single precision
  std::uint32_t crc = 0;              ///< CRC-32 of the three words above and the points
};
static_assert(sizeof(StoredTableHead) == 16 && std::is_trivially_copyable_v<StoredTableHead>);

inline constexpr std::uint32_t kTableMagic = 0x54505841;  // "AXPT"

inline std::uint32_t crc_of_table(const StoredTableHead& head, std::span<const std::byte> points) {
  Crc32 crc;
  crc.add(std::as_bytes(std::span(&head, 1)).first(offsetof(StoredTableHead, crc))).add(points);
  return crc.value();
}

struct StoredTable {
  StoredTableHead head{};
  PitchTable points;                 ///< where they are stored
  std::span<const std::byte> bytes;  ///< head and points
};

inline constexpr std::size_t kEveryAxis = ~std::size_t{0};

/// Calls `visit` for each table from `first` on in a slot's bytes, or for one axis's table. False if a table is
/// damaged.
template <typename Visit>
bool for_each_table(std::span<const std::byte> slot, std::size_t first, Visit visit, std::size_t axis = kEveryAxis) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  for (std::size_t offset = first; offset + sizeof(StoredTableHead) <= slot.size();) {
    StoredTable table;
    std::memcpy(&table.head, slot.data() + offset, sizeof table.head);
    if (table.head.magic == kNone) break;
    const std::size_t size = sizeof table.head + table.head.points * sizeof(PitchPoint);
    if (table.head.magic != kTableMagic || table.head.points > kMostPitchPoints || offset + size > slot.size())
      return false;
    table.bytes = slot.subspan(offset, size);
    const auto points = table.bytes.subspan(sizeof table.head);
    offset += size;
    if (axis != kEveryAxis && axis != table.head.axis) continue;
    if (crc_of_table(table.head, points) != table.head.crc) return false;
    table.points = {reinterpret_cast<const PitchPoint*>(points.data()), table.head.points};
    visit(table);
  }
  return true;
}

}  // namespace firmware
