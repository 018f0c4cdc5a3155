// The HID function, which replaces TinyUSB's hid_device.c and has its interface (class/hid/hid_device.h). Unlike that
// file, it accepts the next report from the host only if there is room for it; until then the endpoint answers NAK, and
// no report is lost.
#include <tusb.h>

#include <algorithm>

#include "hal/tinyusb/descriptors.hpp"
#include "hal/tinyusb/hid_port.hpp"
#include "hal/tinyusb/report_queue.hpp"
#include "hal/usb_identity.hpp"

// After tusb.h, whose types it needs.
#include <device/dcd.h>
#include <device/usbd_pvt.h>

/// Answers a request that reads. If the host sends data with such a request, they would overwrite the answer's memory,
/// which may be invalid or constant, so the request is stalled. TinyUSB's own answers also use this function
/// (cmake/modules/AxisTinyUsb.cmake), because TinyUSB does not check the direction.
extern "C" bool give_to_host(std::uint8_t port, const tusb_control_request_t* request, void* data, std::uint16_t size) {
  if (request->bmRequestType_bit.direction == TUSB_DIR_IN || request->wLength == 0)
    return tud_control_xfer(port, request, data, size);
  dcd_edpt_stall(port, TUSB_DIR_OUT);
  dcd_edpt_stall(port, TUSB_DIR_IN_MASK);
  return false;
}

namespace hal::tinyusb {

namespace {

constexpr std::uint8_t kPort = 0;
constexpr std::uint8_t kHidDescriptorType = 0x21, kReportDescriptorType = 0x22;  // HID 1.11, section 7.1

/// Requests of the HID class: HID 1.11, section 7.2.
enum Request : std::uint8_t { kGetReport = 1, kGetIdle = 2, kSetIdle = 10 };
constexpr std::uint16_t kInputReport = 0x0100;  // value of kGetReport: type in the upper byte, no identifier

constexpr std::size_t kQueued = 8;  // reports each way: 8 ms of traffic

struct Function {
  ReportQueue<kQueued> from_host, to_host;
  HidReport arriving{}, leaving{};  ///< written and read by the controller
  const std::uint8_t* descriptor = nullptr;
  bool accepts = false;  ///< the OUT endpoint waits for a report
  bool sends = false;    ///< the IN endpoint waits for the host to fetch `leaving`
  std::uint8_t idle = 0;
  bool attached = true;
};
constinit Function function;

std::uint8_t* bytes(HidReport& report) { return reinterpret_cast<std::uint8_t*>(report.data()); }

void accept_report() {
  if (function.accepts || function.from_host.is_full()) return;
  function.accepts = usbd_edpt_xfer(kPort, kEndpointOut, bytes(function.arriving), kHidReportSize);
}

void send_leaving() { function.sends = usbd_edpt_xfer(kPort, kEndpointIn, bytes(function.leaving), kHidReportSize); }

void send_next() {
  if (!function.sends && function.to_host.take(function.leaving)) send_leaving();
}

/// Shorter data are filled up with zeros.
void take_report(std::size_t size) {
  const auto rest = static_cast<std::ptrdiff_t>(std::min(size, kHidReportSize));
  std::fill(function.arriving.begin() + rest, function.arriving.end(), std::byte{0});
  function.from_host.put(function.arriving);
}

void reset() {
  function.from_host.clear();
  function.to_host.clear();
  function.accepts = false;
  function.sends = false;
}

/// Returns the number of bytes of the configuration that it has used; 0 refuses the interface.
std::uint16_t open(std::uint8_t port, const tusb_desc_interface_t* interface, std::uint16_t available) {
  if (interface->bInterfaceClass != TUSB_CLASS_HID) return 0;
  const std::uint8_t* descriptor = tu_desc_next(interface);
  const std::uint8_t* endpoints = tu_desc_next(descriptor);
  std::uint8_t out = 0, in = 0;
  if (!usbd_open_edpt_pair(port, endpoints, interface->bNumEndpoints, TUSB_XFER_INTERRUPT, &out, &in)) return 0;
  function.descriptor = descriptor;
  accept_report();
  const auto size = static_cast<std::uint16_t>(tu_desc_next(tu_desc_next(endpoints)) -
                                               reinterpret_cast<const std::uint8_t*>(interface));
  return size <= available ? size : 0;
}

bool answer(std::uint8_t port, const tusb_control_request_t* request, const void* data, std::size_t size) {
  return give_to_host(port, request, const_cast<void*>(data), static_cast<std::uint16_t>(size));
}

bool standard_request(std::uint8_t port, const tusb_control_request_t* request) {
  if (request->bRequest != TUSB_REQ_GET_DESCRIPTOR) return false;
  switch (request->wValue >> 8) {
    case kHidDescriptorType:
      return answer(port, request, function.descriptor, function.descriptor[0]);
    case kReportDescriptorType:
      return answer(port, request, kReportDescriptor.data(), kReportDescriptor.size());
    default:
      return false;
  }
}

bool class_request(std::uint8_t port, const tusb_control_request_t* request) {
  switch (request->bRequest) {
    case kSetIdle:  // reports are sent when there is new data, whatever the host requests: HID 1.11, section 7.2.4
      function.idle = static_cast<std::uint8_t>(request->wValue >> 8);
      return tud_control_status(port, request);
    case kGetIdle:
      return answer(port, request, &function.idle, 1);
    case kGetReport:
      return request->wValue == kInputReport && answer(port, request, function.leaving.data(), kHidReportSize);
    default:
      return false;
  }
}

/// A stall cancels the endpoint's pending transfer; it starts again when the host ends the stall.
void restart(std::uint8_t endpoint) {
  if (endpoint == kEndpointOut) {
    function.accepts = false;
    accept_report();
  } else if (function.sends) {
    send_leaving();
  } else {
    send_next();
  }
}

/// False stalls the request. Stages after the first always succeed, because no request brings data.
bool control(std::uint8_t port, std::uint8_t stage, const tusb_control_request_t* request) {
  if (stage != CONTROL_STAGE_SETUP) return true;
  const auto recipient = request->bmRequestType_bit.recipient;
  const auto type = request->bmRequestType_bit.type;
  if (recipient == TUSB_REQ_RCPT_ENDPOINT && type == TUSB_REQ_TYPE_STANDARD) {
    if (request->bRequest == TUSB_REQ_CLEAR_FEATURE) restart(static_cast<std::uint8_t>(request->wIndex));
    return true;
  }
  if (recipient != TUSB_REQ_RCPT_INTERFACE) return false;
  return type == TUSB_REQ_TYPE_CLASS ? class_request(port, request) : standard_request(port, request);
}

void transferred(std::uint8_t endpoint, xfer_result_t result, std::uint32_t size) {
  if (endpoint == kEndpointOut) {
    function.accepts = false;
    if (result == XFER_RESULT_SUCCESS) take_report(size);
    accept_report();
  } else {
    function.sends = false;
    send_next();
  }
}

}  // namespace

bool HidPort::start(std::string_view serial_number) {
  set_serial_number(serial_number);
  const tusb_rhport_init_t device{TUSB_ROLE_DEVICE, TUSB_SPEED_FULL};
  return tusb_rhport_init(kPort, &device);
}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): it changes the one port that there is
void HidPort::attach(bool is_present) {
  if (is_present == function.attached) return;
  function.attached = is_present;
  if (is_present)
    tud_connect();
  else
    tud_disconnect();
}

void HidPort::poll() { tud_task(); }

void HidPort::handle_interrupt() { tusb_int_handler(kPort, true); }

// NOLINTNEXTLINE(readability-make-member-function-const): it changes the one port that there is
bool HidPort::send(const HidReport& report) {
  if (!is_configured() || !function.to_host.put(report)) return false;
  send_next();
  return true;
}

bool HidPort::receive(HidReport& report) {
  if (!function.from_host.take(report)) return false;
  if (tud_mounted()) accept_report();
  return true;
}

bool HidPort::is_configured() const { return function.attached && tud_mounted() && !tud_suspended(); }

}  // namespace hal::tinyusb

// Functions called by TinyUSB.

extern "C" {

void hidd_init() { hal::tinyusb::reset(); }
bool hidd_deinit() { return true; }
void hidd_reset(std::uint8_t) { hal::tinyusb::reset(); }

std::uint16_t hidd_open(std::uint8_t port, const tusb_desc_interface_t* interface, std::uint16_t available) {
  return hal::tinyusb::open(port, interface, available);
}

bool hidd_control_xfer_cb(std::uint8_t port, std::uint8_t stage, const tusb_control_request_t* request) {
  return hal::tinyusb::control(port, stage, request);
}

bool hidd_xfer_cb(std::uint8_t, std::uint8_t endpoint, xfer_result_t result, std::uint32_t size) {
  hal::tinyusb::transferred(endpoint, result, size);
  return true;
}
}
