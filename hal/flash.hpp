// Flash sectors that the program writes: for parameters (the first two) and the fault log (the next two), or images.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hal {

enum class FlashResult : std::uint8_t {
  ok,
  out_of_range,    ///< sector or offset outside the reserved area; nothing was done
  misaligned,      ///< offset or length is no multiple of `program_size()`; nothing was done
  not_erased,      ///< a bit that should become 1 is 0; the words before it are programmed
  hardware_error,  ///< write protection, programming or erase error; contents undefined
};

/// Contract: `sector_count()` sectors of `sector_size()` bytes. `read` copies out; `view` shows a whole sector in
/// place, so later operations change its contents. `program` turns ones into zeros, in units of `program_size()` bytes.
/// A power cut leaves the unit old, new or unreadable, and never changes others. `erase` sets a whole sector to 0xFF; a
/// power cut leaves that sector undefined, and never changes others. `program` and `erase` return when the hardware has
/// finished, and stall the bus: never call them while a drive is enabled.
template <typename T>
concept Flash = requires(T& flash, const T& constant, std::size_t sector, std::size_t offset, std::span<std::byte> out,
                         std::span<const std::byte> in) {
  { constant.sector_count() } -> std::same_as<std::size_t>;
  { constant.sector_size() } -> std::same_as<std::size_t>;
  { constant.program_size() } -> std::same_as<std::size_t>;
  { constant.view(sector) } -> std::same_as<std::span<const std::byte>>;
  { flash.read(sector, offset, out) } -> std::same_as<FlashResult>;
  { flash.program(sector, offset, in) } -> std::same_as<FlashResult>;
  { flash.erase(sector) } -> std::same_as<FlashResult>;
};

}  // namespace hal
