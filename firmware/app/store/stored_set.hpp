// Layout of one slot of the parameter store in flash.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace firmware {

/// A parameter and its value, by key (parameter_values.hpp), so that another table can still read it.
struct StoredEntry {
  std::uint16_t key = 0;
  std::uint16_t reserved = 0;
  std::uint32_t value_bits = 0;  ///< single precision
};
static_assert(sizeof(StoredEntry) == 8 && std::is_trivially_copyable_v<StoredEntry>);

/// Header before the entries. Little-endian words, written in this order after the entries.
struct StoredHeader {
  std::uint32_t magic = 0;
  std::uint32_t schema_hash = 0;
  std::uint32_t sequence = 0;  ///< one more than that of the set it replaces
  std::uint32_t length = 0;    ///< bytes of entries
  std::uint32_t erases = 0;    ///< of both slots together, so far
  std::uint32_t crc = 0;       ///< CRC-32 of the five words above and the entries
};
static_assert(sizeof(StoredHeader) == 24 && std::is_trivially_copyable_v<StoredHeader>);
static_assert(std::endian::native == std::endian::little);

/// Words after the header that a save programs one by one, after everything else has been read back.
struct StoredMarks {
  std::uint32_t valid = 0;       ///< kValidMark once header and entries have been verified
  std::uint32_t superseded = 0;  ///< differs from kNotProgrammed once the next set is valid
};
static_assert(sizeof(StoredMarks) == 8 && std::is_trivially_copyable_v<StoredMarks>);

inline constexpr std::uint32_t kStoreMagic = 0x53505841;  // "AXPS"
inline constexpr std::uint32_t kNotProgrammed = 0xFFFFFFFF;
/// Has ones and zeros throughout the word, so that a partly programmed mark does not count.
inline constexpr std::uint32_t kValidMark = 0x5AC33CA5;
inline constexpr std::size_t kMarksOffset = sizeof(StoredHeader);
inline constexpr std::size_t kEntriesOffset = kMarksOffset + sizeof(StoredMarks);

}  // namespace firmware
