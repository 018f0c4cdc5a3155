// The last faults of a board in flash, with its running time: two sectors, one of which always holds all entries.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "firmware/app/crc32.hpp"
#include "firmware/app/protocol/fault_log_messages.hpp"
#include "hal/flash.hpp"

namespace firmware {

/// Entries are appended to one sector. When it is full, the newest faults are copied to the other one, whose head is
/// written last and makes it the sector in use. A power cut at any time loses no earlier entry, and the entry being
/// written is complete or absent. An entry without an event only gives the running time.
template <hal::Flash Flash>
class FaultLog {
 public:
  static constexpr std::size_t kFirstSector = 2;  ///< of the flash: the parameter store uses the sectors before

  explicit constexpr FaultLog(Flash& flash) : flash_(flash) {}

  /// Call it once, at start-up. Erases if the chip has no log yet, and if the sector in use is nearly full, so that
  /// erases while the board runs are rare.
  void load() {
    kept_ = 0;
    head_ = {};
    next_ = entries();
    for (std::size_t sector = 0; sector < 2; ++sector) {
      const auto head = read_at<Head>(sector, 0);
      if (head.crc != crc_of(head) || head.magic != kMagic || head.generation <= head_.generation) continue;
      head_ = head;
      sector_ = sector;
      next_ = 1;
    }
    for (std::size_t place = next_; place < entries(); ++place) {
      const auto stored = read_at<Stored>(sector_, place * sizeof(Stored));
      if (is_blank(stored)) continue;
      next_ = place + 1;
      if (stored.crc == crc_of(stored)) note(place, stored.entry);
    }
    if (next_ > entries() / 4 * 3) begin_sector();
  }

  /// Stalls the processor as ParameterStore::save does. False if the flash fails.
  bool add(LoggedFault entry) {
    entry.number = entry.is_event() ? number_ + 1 : number_;
    if (!put_next(sector_, next_, entry) && !(begin_sector() && put_next(sector_, next_, entry))) return false;
    note(next_ - 1, entry);
    return true;
  }

  /// Number of entries, at most kLoggedFaults.
  std::size_t size() const { return std::min(kept_, kLoggedFaults); }
  /// `age` 0 is the newest. Empty beyond the oldest, and for a damaged entry.
  std::optional<LoggedFault> entry(std::size_t age) {
    if (age >= size()) return std::nullopt;
    const auto stored = read_at<Stored>(sector_, places_[(kept_ - 1 - age) % kLoggedFaults] * sizeof(Stored));
    return stored.crc == crc_of(stored) ? std::optional(stored.entry) : std::nullopt;
  }
  /// Running time in the newest entry.
  std::uint32_t run_s() const { return run_s_; }

 private:
  struct Stored {
    LoggedFault entry{};
    std::uint32_t crc = 0;
  };
  static_assert(sizeof(Stored) == 32);
  /// Stored in place of the first entry of a sector; the sector with the higher generation is in use.
  struct Head {
    std::uint32_t magic = 0, generation = 0, crc = 0;
  };
  static constexpr std::uint32_t kMagic = 0x4C465841;  // "AXFL"

  std::size_t entries() const { return flash_.sector_size() / sizeof(Stored); }

  template <typename T>
  T read_at(std::size_t sector, std::size_t offset) {
    T value{};
    flash_.read(kFirstSector + sector, offset, std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }

  template <typename T>
  static std::uint32_t crc_of(const T& value) {
    return crc32(std::as_bytes(std::span(&value, 1)).first(offsetof(T, crc)));
  }

  static bool is_blank(const Stored& stored) {
    return std::ranges::all_of(std::as_bytes(std::span(&stored, 1)), [](std::byte b) { return b == std::byte{0xFF}; });
  }

  /// Programs it and reads it back.
  bool put(std::size_t sector, std::size_t place, const LoggedFault& entry) {
    Stored stored{entry};
    stored.crc = crc_of(stored);
    const auto bytes = std::as_bytes(std::span(&stored, 1));
    if (flash_.program(kFirstSector + sector, place * sizeof stored, bytes) != hal::FlashResult::ok) return false;
    const auto back = read_at<Stored>(sector, place * sizeof stored);
    return std::ranges::equal(bytes, std::as_bytes(std::span(&back, 1)));
  }

  /// Writes to the next place that reads back correctly, and sets `next` to the place after it.
  bool put_next(std::size_t sector, std::size_t& next, const LoggedFault& entry) {
    while (next < entries())
      if (put(sector, next++, entry)) return true;
    return false;
  }

  void note(std::size_t place, const LoggedFault& entry) {
    run_s_ = entry.run_s;
    number_ = entry.number;
    if (entry.is_event()) places_[kept_++ % kLoggedFaults] = static_cast<std::uint16_t>(place);
  }

  /// Copies the kept faults to the other sector, which takes over.
  bool begin_sector() {
    const std::size_t target = 1 - sector_;
    if (flash_.erase(kFirstSector + target) != hal::FlashResult::ok) return false;
    std::array<std::uint16_t, kLoggedFaults> places{};
    std::size_t next = 1, copied = 0;
    for (std::size_t age = size(); age-- > 0;) {
      const auto one = entry(age);
      if (!one) continue;
      if (!put_next(target, next, *one)) return false;
      places[copied++] = static_cast<std::uint16_t>(next - 1);
    }
    LoggedFault time_alone;
    time_alone.number = number_;
    time_alone.run_s = run_s_;
    Head head{kMagic, head_.generation + 1, 0};
    head.crc = crc_of(head);
    const auto bytes = std::as_bytes(std::span(&head, 1));
    if (!put_next(target, next, time_alone) || flash_.program(kFirstSector + target, 0, bytes) != hal::FlashResult::ok)
      return false;
    sector_ = target;
    head_ = head;
    next_ = next;
    places_ = places;
    kept_ = copied;
    return true;
  }

  Flash& flash_;
  std::size_t sector_ = 1, next_ = 0;  ///< `next_`: the first free place
  Head head_{};                        ///< of the sector in use; generation 0 before the first
  std::size_t kept_ = 0;               ///< faults in that sector
  std::array<std::uint16_t, kLoggedFaults> places_{};
  std::uint32_t number_ = 0, run_s_ = 0;
};

}  // namespace firmware
