#include "host/link/hid_library.hpp"

#include <cstdlib>
#include <optional>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/shared_library.hpp"

namespace host {

namespace {

std::string file_of(HidBackend backend) { return std::string("libhidapi-") + name_of(backend) + ".so.0"; }

std::optional<HidLibrary> load(HidBackend backend) {
  const SharedLibrary library(file_of(backend));
  if (!library.is_loaded()) return std::nullopt;
  HidLibrary functions;
  functions.backend = backend;
  bool complete = true;
  const auto find = [&](auto& function, const char* name) { complete = library.find(function, name) && complete; };
  find(functions.enumerate, "hid_enumerate");
  find(functions.free_enumeration, "hid_free_enumeration");
  find(functions.open_path, "hid_open_path");
  find(functions.close, "hid_close");
  find(functions.write, "hid_write");
  find(functions.read_timeout, "hid_read_timeout");
  find(functions.send_feature_report, "hid_send_feature_report");
  if (!complete) return std::nullopt;
  return functions;
}

const std::optional<HidLibrary>& loaded(HidBackend backend) {
  if (backend == HidBackend::hidraw) {
    static const std::optional<HidLibrary> hidraw = load(HidBackend::hidraw);
    return hidraw;
  }
  static const std::optional<HidLibrary> libusb = load(HidBackend::libusb);
  return libusb;
}

}  // namespace

const char* name_of(HidBackend backend) { return backend == HidBackend::hidraw ? "hidraw" : "libusb"; }

const HidLibrary& hid_library(HidBackend backend) {
  if (const auto& library = loaded(backend)) return *library;
  throw Failure(ExitCode::no_such_device,
                file_of(backend) + " is not installed: apt-get install libhidapi-" + name_of(backend) + "0");
}

const HidLibrary& hid_library() {
  const char* wanted = std::getenv("AXISTOOL_HIDAPI");
  if (wanted != nullptr && *wanted != '\0') {
    for (const HidBackend backend : {HidBackend::hidraw, HidBackend::libusb})
      if (std::string_view(wanted) == name_of(backend)) return hid_library(backend);
    throw Failure(ExitCode::usage, std::string("AXISTOOL_HIDAPI=") + wanted + ": it may be hidraw or libusb");
  }
  if (!loaded(HidBackend::hidraw) && loaded(HidBackend::libusb)) return hid_library(HidBackend::libusb);
  return hid_library(HidBackend::hidraw);
}

}  // namespace host
