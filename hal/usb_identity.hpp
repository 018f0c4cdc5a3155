// The board's identity on USB: in its descriptors, and in a computer's search.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hal {

/// Vendor 0x1209 is pid.codes, which lends product numbers to open hardware. Boards that are sold need a number of
/// their own there.
inline constexpr std::uint16_t kUsbVendor = 0x1209;
inline constexpr std::uint16_t kUsbProduct = 0xA715;
inline constexpr const char* kUsbManufacturerName = "axis";
inline constexpr const char* kUsbProductName = "Axis board";

/// Interface 0, the only one. If usage page and usage are not available (libusb), this number identifies it.
inline constexpr std::uint8_t kUsbInterface = 0;
inline constexpr std::uint16_t kHidUsagePage = 0xFF00;  ///< vendor-defined: HID Usage Tables, section 3
inline constexpr std::uint16_t kHidUsage = 0x0001;

/// Longest serial number: the 96 bits of the chip's unique identifier in hexadecimal.
inline constexpr std::size_t kUsbSerialNumberSize = 24;

}  // namespace hal
