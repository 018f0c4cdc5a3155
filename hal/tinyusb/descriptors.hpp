// The descriptors of the board: one full-speed HID interface, 64-byte reports both ways, every millisecond.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace hal::tinyusb {

inline constexpr std::uint8_t kEndpointIn = 0x81;
inline constexpr std::uint8_t kEndpointOut = 0x01;

/// HID 1.11, section 6.2.2: one input and one output report of 64 bytes, no report identifiers.
inline constexpr std::array kReportDescriptor =
    std::to_array<std::uint8_t>({0x06, 0x00, 0xFF,  // usage page: hal::kHidUsagePage
                                 0x09, 0x01,        // usage: hal::kHidUsage
                                 0xA1, 0x01,        // collection: application
                                 0x15, 0x00,        //   logical minimum 0
                                 0x26, 0xFF, 0x00,  //   logical maximum 255
                                 0x75, 0x08,        //   report size: 8 bits
                                 0x95, 0x40,        //   report count: 64
                                 0x09, 0x01,        //   usage 1
                                 0x81, 0x02,        //   input: data, variable, absolute
                                 0x09, 0x02,        //   usage 2
                                 0x91, 0x02,        //   output: data, variable, absolute
                                 0xC0});            // end of collection

/// Call it before the stack is started; at most hal::kUsbSerialNumberSize ASCII characters, further ones are cut off.
void set_serial_number(std::string_view text);

}  // namespace hal::tinyusb
