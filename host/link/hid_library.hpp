// Loads hidapi at run time: its hidraw back end (which uses the kernel's HID driver) or its libusb back end.
#pragma once

#include <hidapi/hidapi.h>

#include <string>

namespace host {

enum class HidBackend { hidraw, libusb };

/// The functions of one back end. Both libraries use the same names, so neither is linked.
struct HidLibrary {
  HidBackend backend{};
  decltype(&hid_enumerate) enumerate = nullptr;
  decltype(&hid_free_enumeration) free_enumeration = nullptr;
  decltype(&hid_open_path) open_path = nullptr;
  decltype(&hid_close) close = nullptr;
  decltype(&hid_write) write = nullptr;
  decltype(&hid_read_timeout) read_timeout = nullptr;
  decltype(&hid_send_feature_report) send_feature_report = nullptr;
};

/// The back end in the environment variable AXISTOOL_HIDAPI (hidraw or libusb), else hidraw, else libusb. Throws
/// Failure: usage for another name, no_such_device if the library is not installed.
const HidLibrary& hid_library();

/// The given back end. Throws Failure (no_such_device) if it is not installed.
const HidLibrary& hid_library(HidBackend backend);

const char* name_of(HidBackend backend);

}  // namespace host
