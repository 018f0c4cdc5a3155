#include "hal/tinyusb/descriptors.hpp"

#include <tusb.h>

#include <algorithm>

#include "hal/usb_hid.hpp"
#include "hal/usb_identity.hpp"

namespace hal::tinyusb {

namespace {

enum StringIndex : std::uint8_t { kNoString, kManufacturer, kProduct, kSerialNumber };

constexpr std::uint16_t kDeviceRelease = 0x0100;  // binary-coded 1.00
constexpr std::uint16_t kEnglish = 0x0409;
constexpr std::uint8_t kConfigurationSize = 41;
constexpr std::uint8_t kSelfPowered = 0xC0;  // USB 2.0, table 9-10: bit 7 is always set
constexpr std::uint8_t kCurrent_2mA = 50;    // 100 mA: the maximum of a self-powered board while starting
constexpr std::uint8_t kInterval_ms = 1;

constexpr std::uint8_t low(std::size_t value) { return static_cast<std::uint8_t>(value & 0xFF); }
constexpr std::uint8_t high(std::size_t value) { return static_cast<std::uint8_t>(value >> 8 & 0xFF); }

/// USB 2.0, table 9-8.
constexpr std::array<std::uint8_t, 18> kDevice{18,
                                               TUSB_DESC_DEVICE,
                                               0x00,
                                               0x02,  // USB 2.0
                                               0,
                                               0,
                                               0,  // the class is the interface's
                                               CFG_TUD_ENDPOINT0_SIZE,
                                               low(kUsbVendor),
                                               high(kUsbVendor),
                                               low(kUsbProduct),
                                               high(kUsbProduct),
                                               low(kDeviceRelease),
                                               high(kDeviceRelease),
                                               kManufacturer,
                                               kProduct,
                                               kSerialNumber,
                                               1};

// clang-format off
/// USB 2.0, tables 9-10, 9-12 and 9-13; HID 1.11, section 6.2.1.
constexpr std::array<std::uint8_t, kConfigurationSize> kConfiguration{
    9, TUSB_DESC_CONFIGURATION, kConfigurationSize, 0, 1, 1, kNoString, kSelfPowered, kCurrent_2mA,
    9, TUSB_DESC_INTERFACE, kUsbInterface, 0, 2, TUSB_CLASS_HID, 0, 0, kNoString,
    9, 0x21, 0x11, 0x01, 0, 1, 0x22, low(kReportDescriptor.size()), high(kReportDescriptor.size()),
    7, TUSB_DESC_ENDPOINT, kEndpointIn, TUSB_XFER_INTERRUPT, low(kHidReportSize), 0, kInterval_ms,
    7, TUSB_DESC_ENDPOINT, kEndpointOut, TUSB_XFER_INTERRUPT, low(kHidReportSize), 0, kInterval_ms};
// clang-format on

std::array<char, kUsbSerialNumberSize> serial_number;
std::size_t serial_number_size = 0;

std::string_view text_of(std::uint8_t index) {
  if (index == kManufacturer) return kUsbManufacturerName;
  if (index == kProduct) return kUsbProductName;
  if (index == kSerialNumber) return {serial_number.data(), serial_number_size};
  return {};
}

/// Header and UTF-16 text: USB 2.0, section 9.6.7. Holds the longest of the texts.
std::array<std::uint16_t, 1 + kUsbSerialNumberSize> string_descriptor;

void describe_string(std::size_t length) {
  string_descriptor[0] = static_cast<std::uint16_t>(TUSB_DESC_STRING << 8 | (2 + 2 * length));
}

}  // namespace

void set_serial_number(std::string_view text) {
  serial_number_size = std::min(text.size(), serial_number.size());
  std::copy_n(text.begin(), serial_number_size, serial_number.begin());
}

}  // namespace hal::tinyusb

// Called by TinyUSB; null answers with a stall.

extern "C" std::uint8_t const* tud_descriptor_device_cb() { return hal::tinyusb::kDevice.data(); }

extern "C" std::uint8_t const* tud_descriptor_configuration_cb(std::uint8_t) {
  return hal::tinyusb::kConfiguration.data();
}

extern "C" std::uint16_t const* tud_descriptor_string_cb(std::uint8_t index, std::uint16_t) {
  using namespace hal::tinyusb;  // NOLINT(google-build-using-namespace): this function is of that namespace
  if (index == kNoString) {
    describe_string(1);
    string_descriptor[1] = kEnglish;
    return string_descriptor.data();
  }
  const std::string_view text = text_of(index);
  if (text.empty()) return nullptr;
  describe_string(text.size());
  std::copy(text.begin(), text.end(), string_descriptor.begin() + 1);
  return string_descriptor.data();
}
