#include "tests/hal/tinyusb/mock_bus.hpp"

#include <tusb.h>

#include <algorithm>
#include <array>

// After tusb.h, on whose types it relies.
#include <device/dcd.h>

namespace usb_test {

namespace {

/// Transfer that TinyUSB has requested for one direction of one endpoint.
struct Endpoint {
  bool open = false, armed = false, stalled = false;
  std::uint8_t* buffer = nullptr;
  std::uint16_t size = 0;
};

struct Controller {
  std::array<std::array<Endpoint, 2>, CFG_TUD_ENDPPOINT_MAX> endpoints{};
  std::uint8_t address = 0;
};
Controller controller;

Endpoint& endpoint(std::uint8_t address) { return controller.endpoints[tu_edpt_number(address)][tu_edpt_dir(address)]; }

constexpr std::uint8_t kControlOut = 0x00, kControlIn = 0x80;
constexpr std::uint8_t kPort = 0;

void finish(std::uint8_t address, std::size_t size) {
  endpoint(address).armed = false;
  dcd_event_xfer_complete(kPort, address, static_cast<std::uint32_t>(size), XFER_RESULT_SUCCESS, true);
}

}  // namespace

void MockBus::reset() {
  controller = {};
  endpoint(kControlOut).open = endpoint(kControlIn).open = true;
  dcd_event_bus_reset(kPort, TUSB_SPEED_FULL, true);
  port_.poll();
}

void MockBus::suspend() {
  dcd_event_bus_signal(kPort, DCD_EVENT_SUSPEND, true);
  port_.poll();
}

void MockBus::resume() {
  dcd_event_bus_signal(kPort, DCD_EVENT_RESUME, true);
  port_.poll();
}

void MockBus::unplug() {
  dcd_event_bus_signal(kPort, DCD_EVENT_UNPLUGGED, true);
  port_.poll();
}

std::uint8_t MockBus::address() { return controller.address; }

Transfer MockBus::in(std::uint8_t address) {
  const Endpoint& from = endpoint(address);
  if (from.stalled) return {Outcome::stalled, {}};
  if (!from.open || !from.armed) return {Outcome::not_ready, {}};
  Bytes data(from.buffer, from.buffer + from.size);
  finish(address, data.size());
  port_.poll();
  return {Outcome::done, data};
}

Outcome MockBus::out(std::uint8_t address, const Bytes& data) {
  const Endpoint& to = endpoint(address);
  if (to.stalled) return Outcome::stalled;
  if (!to.open || !to.armed || data.size() > to.size) return Outcome::not_ready;
  std::copy(data.begin(), data.end(), to.buffer);
  finish(address, data.size());
  port_.poll();
  return Outcome::done;
}

Transfer MockBus::control(const Request& request, const Bytes& out_data) {
  const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
  const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); };
  const std::array<std::uint8_t, 8> packet{request.type,        request.code,        low(request.value),
                                           high(request.value), low(request.index),  high(request.index),
                                           low(request.length), high(request.length)};
  for (const std::uint8_t address : {kControlOut, kControlIn}) {  // a new request ends the stall of the last one
    endpoint(address).stalled = false;
    endpoint(address).armed = false;
  }
  dcd_event_setup_received(kPort, packet.data(), true);
  port_.poll();
  const bool reads = (request.type & 0x80) != 0;
  Transfer result{Outcome::done, {}};
  for (std::size_t sent = 0; reads ? result.data.size() < request.length : sent < request.length;) {
    if (reads) {
      Transfer part = in(kControlIn);
      if (part.outcome != Outcome::done) return part;
      result.data.insert(result.data.end(), part.data.begin(), part.data.end());
      if (part.data.size() < CFG_TUD_ENDPOINT0_SIZE) break;
    } else {
      const std::size_t size = std::min<std::size_t>(request.length - sent, CFG_TUD_ENDPOINT0_SIZE);
      const auto begin = out_data.begin() + static_cast<std::ptrdiff_t>(sent);
      const Outcome part = out(kControlOut, Bytes(begin, begin + static_cast<std::ptrdiff_t>(size)));
      if (part != Outcome::done) return {part, {}};
      sent += size;
    }
  }
  // The status stage goes the other way.
  result.outcome = reads && request.length > 0 ? out(kControlOut, {}) : in(kControlIn).outcome;
  return result;
}

bool MockBus::enumerate(std::uint8_t address) {
  reset();
  return control({0x80, TUSB_REQ_GET_DESCRIPTOR, TUSB_DESC_DEVICE << 8, 0, 64}).outcome == Outcome::done &&
         control({0x00, TUSB_REQ_SET_ADDRESS, address, 0, 0}).outcome == Outcome::done &&
         control({0x80, TUSB_REQ_GET_DESCRIPTOR, TUSB_DESC_CONFIGURATION << 8, 0, 255}).outcome == Outcome::done &&
         control({0x00, TUSB_REQ_SET_CONFIGURATION, 1, 0, 0}).outcome == Outcome::done;
}

}  // namespace usb_test

// The controller's side, as TinyUSB sees it.

namespace {

bool pulls_up = false;

}  // namespace

bool usb_test::MockBus::sees_device() { return pulls_up; }

extern "C" {

bool dcd_init(std::uint8_t, const tusb_rhport_init_t*) { return pulls_up = true; }
void dcd_connect(std::uint8_t) { pulls_up = true; }
void dcd_disconnect(std::uint8_t) { pulls_up = false; }
void dcd_int_enable(std::uint8_t) {}
void dcd_int_disable(std::uint8_t) {}
void dcd_int_handler(std::uint8_t) {}
void dcd_remote_wakeup(std::uint8_t) {}
void dcd_sof_enable(std::uint8_t, bool) {}
void dcd_edpt0_status_complete(std::uint8_t, const tusb_control_request_t*) {}

bool dcd_edpt_xfer(std::uint8_t, std::uint8_t address, std::uint8_t* buffer, std::uint16_t size) {
  auto& endpoint = usb_test::endpoint(address);
  endpoint.armed = true;
  endpoint.buffer = buffer;
  endpoint.size = size;
  return true;
}

void dcd_set_address(std::uint8_t port, std::uint8_t address) {
  usb_test::controller.address = address;
  dcd_edpt_xfer(port, usb_test::kControlIn, nullptr, 0);
}

bool dcd_edpt_open(std::uint8_t, const tusb_desc_endpoint_t* descriptor) {
  usb_test::endpoint(descriptor->bEndpointAddress) = {};
  usb_test::endpoint(descriptor->bEndpointAddress).open = true;
  return true;
}

void dcd_edpt_close(std::uint8_t, std::uint8_t address) { usb_test::endpoint(address) = {}; }

void dcd_edpt_close_all(std::uint8_t) {
  for (std::size_t number = 1; number < usb_test::controller.endpoints.size(); ++number)
    usb_test::controller.endpoints[number] = {};
}

void dcd_edpt_stall(std::uint8_t, std::uint8_t address) {
  usb_test::endpoint(address).stalled = true;
  usb_test::endpoint(address).armed = false;
}

void dcd_edpt_clear_stall(std::uint8_t, std::uint8_t address) { usb_test::endpoint(address).stalled = false; }
}
