// Parameters and tables of pitch errors in flash: two slots, one of which always holds a complete set.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <span>

#include "firmware/app/crc32.hpp"
#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/store/stored_set.hpp"
#include "firmware/app/store/stored_tables.hpp"
#include "hal/flash.hpp"

namespace firmware {

/// Result of start-up. Numbers are permanent. Drives may run with empty (then no axis is fitted), loaded and migrated.
enum class StoreState : std::uint8_t {
  empty = 0,       ///< nothing was ever saved: initial values
  loaded = 1,      ///< the newest set, unchanged
  migrated = 2,    ///< saved with another table, but this table has every value
  incomplete = 3,  ///< some values do not fit this table; they stay readable until the next save
  damaged = 4,     ///< the newest set is damaged
};

enum class SaveResult : std::uint8_t { saved = 0, flash_failed = 1, not_verified = 2 };

struct StoreReport {
  StoreState state = StoreState::empty;
  std::uint32_t sequence = 0;     ///< of the set in use; 0 without one
  std::uint32_t schema_hash = 0;  ///< of the table with which it was saved
  std::uint32_t erases = 0;       ///< of both sectors together; each endures 10,000 (STM32F405 datasheet, table 42)
  std::uint16_t not_migrated = 0;
};

/// A save erases the slot that does not hold the newest set, writes tables, entries and header there, reads them back,
/// and then programs the mark that makes them valid. Last, it marks the older set as superseded. After a power cut at
/// any time, the newest valid set is therefore the old or the new one. A superseded set without a successor shows
/// damage that a power cut cannot cause; it is never used in place of the set that was saved last.
template <hal::Flash Flash>
class ParameterStore {
 public:
  explicit constexpr ParameterStore(Flash& flash) : flash_(flash) {}

  /// Call it once at start-up. Copies the stored values to `values`; if damaged or empty, does not change them.
  StoreReport load(ParameterValues& values) {
    examine();
    report_ = {};
    report_.erases = most_erases();
    if (!newest_) {
      report_.state = is_untouched() ? StoreState::empty : StoreState::damaged;
      return report_;
    }
    const Slot& slot = slots_[*newest_];
    report_.sequence = slot.header.sequence;
    report_.schema_hash = slot.header.schema_hash;
    if (slot.marks.superseded != kNotProgrammed) {
      report_.state = StoreState::damaged;
      return report_;
    }
    supersede_other();
    take_over_entries(values);
    const bool same_table = slot.header.schema_hash == kSchemaHash;
    report_.state = report_.not_migrated != 0 ? StoreState::incomplete
                    : same_table              ? StoreState::loaded
                                              : StoreState::migrated;
    return report_;
  }

  /// Stalls the processor for the duration of an erase, so call it only while no drive is enabled, and with a watchdog
  /// that allows this time. Unless it returns saved, the store keeps its former contents.
  SaveResult save(const ParameterValues& values) {
    if (!begin_set()) return SaveResult::flash_failed;
    return finish_set(values, kNoAxis);
  }

  /// Writes a table part by part into the slot that the next save would use. finish_table() makes it part of the store,
  /// together with the parameters. Until then the store keeps its former contents; a save in between discards the
  /// table. `values`: as many as will be saved with it.
  SaveResult begin_table(std::size_t values, std::uint16_t axis, std::uint16_t points, std::uint32_t resolution_bits) {
    const std::size_t size = tables_offset(values) + sizeof staged_ + points * sizeof(PitchPoint);
    if (size > flash_.sector_size() || !begin_set()) return SaveResult::flash_failed;
    staged_ = {kTableMagic, axis, points, resolution_bits, 0};
    staged_at_ = tables_offset(values);
    is_staging_ = true;
    return SaveResult::saved;
  }
  bool is_staging_table() const { return is_staging_; }
  const StoredTableHead& staged_table() const { return staged_; }
  std::size_t staged_points() const { return staged_count_; }

  /// The next points. False if there are too many, if one may not follow the one before, or if the flash fails.
  bool add_point(const PitchPoint& point) {
    if (!is_staging_ || staged_count_ == staged_.points || !is_valid(point)) return false;
    if (staged_count_ > 0 && !may_follow(last_point_, point)) return false;
    const std::size_t offset = staged_at_ + sizeof staged_ + staged_count_ * sizeof point;
    if (!program(target(), offset, point)) return false;
    last_point_ = point;
    ++staged_count_;
    return true;
  }

  /// `crc`: of all points that the host sent. A table without points removes the axis's table.
  SaveResult finish_table(const ParameterValues& values, std::uint32_t crc) {
    if (!is_staging_ || staged_count_ != staged_.points) return SaveResult::not_verified;
    const std::size_t size = staged_count_ * sizeof(PitchPoint);
    const auto points = flash_.view(target()).subspan(staged_at_ + sizeof staged_, size);
    if (crc32(points) != crc) return SaveResult::not_verified;
    staged_.crc = crc_of_table(staged_, points);
    if (staged_.points != 0 && !program(target(), staged_at_, staged_)) return SaveResult::flash_failed;
    return finish_set(values, staged_.axis);
  }

  const StoreReport& report() const { return report_; }

  /// Table of the newest valid set; without points if the axis has none. It lies in flash and stays valid until the
  /// second save from now.
  StoredTable table(std::size_t axis) const {
    StoredTable found;
    for_each_table([&](const StoredTable& one) { found = one; }, axis);
    return found;
  }

  /// The entries of the newest valid set in their flash layout, for a backup that also keeps entries unknown to this
  /// table.
  std::size_t entry_count() const { return newest_ ? slots_[*newest_].header.length / sizeof(StoredEntry) : 0; }
  std::optional<StoredEntry> entry(std::size_t index) {
    if (index >= entry_count()) return std::nullopt;
    return read_at<StoredEntry>(*newest_, kEntriesOffset + index * sizeof(StoredEntry));
  }

 private:
  static constexpr std::size_t kSlots = 2;
  static constexpr std::size_t kNoAxis = ~std::size_t{0};

  static constexpr std::size_t tables_offset(std::size_t values) {
    return kEntriesOffset + values * sizeof(StoredEntry);
  }

  std::size_t target() const { return newest_ ? 1 - *newest_ : 0; }

  bool begin_set() {
    examine();
    is_staging_ = false;
    staged_count_ = 0;
    return flash_.erase(target()) == hal::FlashResult::ok;
  }

  /// `replaced`: the axis whose table is staged.
  SaveResult finish_set(const ParameterValues& values, std::size_t replaced) {
    is_staging_ = false;
    const std::size_t target = this->target();
    if (!copy_tables(target, tables_offset(values.size()), replaced)) return SaveResult::flash_failed;
    StoredHeader header{kStoreMagic,
                        kSchemaHash,
                        highest_sequence() + 1,
                        static_cast<std::uint32_t>(values.size() * sizeof(StoredEntry)),
                        most_erases() + 1,
                        0};
    Crc32 crc;
    crc.add(bytes_of(header).first(offsetof(StoredHeader, crc)));
    for (std::size_t place = 0; place < values.size(); ++place) {
      const StoredEntry entry{key_at(place).code, 0, std::bit_cast<std::uint32_t>(values.at(place))};
      crc.add(bytes_of(entry));
      if (!program(target, kEntriesOffset + place * sizeof entry, entry)) return SaveResult::flash_failed;
    }
    header.crc = crc.value();
    if (!program(target, 0, header)) return SaveResult::flash_failed;
    if (read_back_differs(target, header, values)) return SaveResult::not_verified;
    if (!program(target, kMarksOffset + offsetof(StoredMarks, valid), kValidMark)) return SaveResult::flash_failed;
    examine();
    if (newest_ != target) return SaveResult::not_verified;
    supersede_other();
    report_ = {StoreState::loaded, header.sequence, header.schema_hash, header.erases, 0};
    return SaveResult::saved;
  }

  /// Copies the tables of the newest set to the place after the staged table.
  bool copy_tables(std::size_t target, std::size_t offset, std::size_t replaced) {
    if (replaced != kNoAxis && staged_.points != 0) offset += sizeof staged_ + staged_.points * sizeof(PitchPoint);
    bool all_copied = true;
    for_each_table([&](const StoredTable& one) {
      if (one.head.axis == replaced || !all_copied) return;
      all_copied = flash_.program(target, offset, one.bytes) == hal::FlashResult::ok &&
                   std::ranges::equal(flash_.view(target).subspan(offset, one.bytes.size()), one.bytes);
      offset += one.bytes.size();
    });
    return all_copied;
  }

  /// The newest set, unless it has been superseded.
  template <typename Visit>
  void for_each_table(Visit visit, std::size_t axis = kEveryAxis) const {
    if (!newest_ || slots_[*newest_].marks.superseded != kNotProgrammed) return;
    const std::size_t length = slots_[*newest_].header.length;
    firmware::for_each_table(flash_.view(*newest_), kEntriesOffset + length, visit, axis);
  }

  struct Slot {
    StoredHeader header{};
    StoredMarks marks{};
    bool whole = false;  ///< header, entries and tables agree with their checksums
    bool valid() const { return whole && marks.valid == kValidMark; }
  };

  template <typename T>
  static std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
  }

  template <typename T>
  T read_at(std::size_t slot, std::size_t offset) const {
    T value{};
    flash_.read(slot, offset, std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }

  template <typename T>
  bool program(std::size_t slot, std::size_t offset, const T& value) {
    return flash_.program(slot, offset, bytes_of(value)) == hal::FlashResult::ok;
  }

  void examine() {
    newest_.reset();
    for (std::size_t i = 0; i < kSlots; ++i) {
      Slot& slot = slots_[i];
      slot = {read_at<StoredHeader>(i, 0), read_at<StoredMarks>(i, kMarksOffset), false};
      slot.whole =
          has_right_length(slot.header) && crc_of(i) == slot.header.crc &&
          firmware::for_each_table(flash_.view(i), kEntriesOffset + slot.header.length, [](const StoredTable&) {});
      if (slot.valid() && (!newest_ || slot.header.sequence > slots_[*newest_].header.sequence)) newest_ = i;
    }
  }

  bool has_right_length(const StoredHeader& header) const {
    return header.magic == kStoreMagic && header.length % sizeof(StoredEntry) == 0 &&
           header.length <= flash_.sector_size() - kEntriesOffset;
  }

  std::uint32_t crc_of(std::size_t slot) const {
    Crc32 crc;
    crc.add(bytes_of(slots_[slot].header).first(offsetof(StoredHeader, crc)));
    for (std::size_t offset = 0; offset < slots_[slot].header.length; offset += sizeof(StoredEntry))
      crc.add(bytes_of(read_at<StoredEntry>(slot, kEntriesOffset + offset)));
    return crc.value();
  }

  /// No set was ever valid: each slot is blank, or the first save was interrupted.
  bool is_untouched() const {
    return std::ranges::none_of(slots_, [](const Slot& slot) {
      return slot.marks.valid == kValidMark || slot.marks.superseded != kNotProgrammed;
    });
  }

  std::uint32_t highest_sequence() const { return highest(&StoredHeader::sequence); }
  std::uint32_t most_erases() const { return highest(&StoredHeader::erases); }
  /// Considers only slots with an intact header.
  std::uint32_t highest(std::uint32_t StoredHeader::*field) const {
    std::uint32_t most = 0;
    for (const Slot& slot : slots_)
      if (slot.whole) most = std::max(most, slot.header.*field);
    return most;
  }

  bool read_back_differs(std::size_t slot, const StoredHeader& header, const ParameterValues& values) const {
    if (!std::ranges::equal(bytes_of(read_at<StoredHeader>(slot, 0)), bytes_of(header))) return true;
    for (std::size_t place = 0; place < values.size(); ++place) {
      const auto entry = read_at<StoredEntry>(slot, kEntriesOffset + place * sizeof(StoredEntry));
      if (entry.key != key_at(place).code || entry.value_bits != std::bit_cast<std::uint32_t>(values.at(place)))
        return true;
    }
    return false;
  }

  void supersede_other() {
    const std::size_t other = 1 - *newest_;
    if (!slots_[other].valid() || slots_[other].marks.superseded != kNotProgrammed) return;
    program(other, kMarksOffset + offsetof(StoredMarks, superseded), std::uint32_t{0});
  }

  void take_over_entries(ParameterValues& values) {
    for (std::size_t i = 0; i < entry_count(); ++i) {
      const StoredEntry stored = *entry(i);
      const auto place = values.place_of({stored.key});
      const auto value = std::bit_cast<float>(stored.value_bits);
      if (place && check_value(rule_at(*place), value) == ValueRefusal::none)
        values.set(*place, value);
      else
        ++report_.not_migrated;
    }
  }

  Flash& flash_;
  std::array<Slot, kSlots> slots_{};
  std::optional<std::size_t> newest_;
  StoreReport report_{};
  StoredTableHead staged_{};
  PitchPoint last_point_{};
  std::size_t staged_at_ = 0, staged_count_ = 0;
  bool is_staging_ = false;
};

}  // namespace firmware
