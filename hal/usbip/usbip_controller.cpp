#include "hal/usbip/usbip_controller.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <tusb.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <deque>
#include <optional>
#include <vector>

#include "hal/usbip/usbip_messages.hpp"

// After tusb.h, whose types it needs.
#include <device/dcd.h>

namespace hal::usbip {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kPort = 0;
constexpr std::uint8_t kDirectionIn = TUSB_DIR_IN_MASK;
using Clock = std::chrono::steady_clock;
constexpr int kFramesToCatchUp = 8;              // the computer may be late; a real bus never is
constexpr std::size_t kLongestTransfer = 65536;  // far above any transfer of a HID device

/// A transfer for which the host waits.
struct Transfer {
  Request request;
  Bytes data;  ///< out: data from the host; in: data for the host so far
  std::size_t sent = 0;
};

/// One direction of one endpoint: TinyUSB's pending transfer, and the host's transfers that wait for it.
struct Endpoint {
  bool open = false, armed = false, stalled = false;
  std::uint8_t* buffer = nullptr;
  std::uint16_t size = 0;
  std::deque<Transfer> waiting;
  Clock::time_point next_frame{};  ///< when it may move the next report

  bool may_move() const { return armed && !waiting.empty(); }
};

struct Controller {
  int socket = -1;
  bool connected = false;
  Clock::duration frame{};
  std::array<std::array<Endpoint, 2>, TUP_DCD_ENDPOINT_MAX> endpoints;
  std::optional<Transfer> control;  ///< the request on the control pipe
  Bytes received;                   ///< of the next message
};
Controller controller;

Endpoint& endpoint(std::uint8_t address) { return controller.endpoints[tu_edpt_number(address)][tu_edpt_dir(address)]; }

std::uint8_t address_of(const Request& request) {
  return static_cast<std::uint8_t>(request.endpoint | (request.in ? kDirectionIn : 0u));
}

void write_all(const std::uint8_t* data, std::size_t size) {
  while (size > 0 && controller.connected) {
    const ssize_t written = send(controller.socket, data, size, MSG_NOSIGNAL);
    if (written > 0) {
      data += written;
      size -= static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      controller.connected = false;
    }
  }
}

void answer(const Transfer& transfer, std::int32_t status) {
  const bool in = transfer.request.in;
  const std::size_t transferred = in ? transfer.data.size() : transfer.sent;
  Bytes message(kHeaderSize);
  const Header header =
      reply(Command::submit_reply, transfer.request.sequence, status, static_cast<std::uint32_t>(transferred));
  std::copy(header.begin(), header.end(), message.begin());
  if (in) message.insert(message.end(), transfer.data.begin(), transfer.data.end());
  write_all(message.data(), message.size());
}

void report_done(std::uint8_t address, std::size_t size) {
  endpoint(address).armed = false;
  dcd_event_xfer_complete(kPort, address, static_cast<std::uint32_t>(size), XFER_RESULT_SUCCESS, false);
}

/// Makes the transfers for which both sides are ready. The device's reports are single packets, so each packet in ends
/// a transfer.
void advance(std::uint8_t address) {
  Endpoint& side = endpoint(address);
  if (side.stalled) {
    for (; !side.waiting.empty(); side.waiting.pop_front()) answer(side.waiting.front(), kStalled);
    return;
  }
  const auto now = Clock::now();
  if (!side.may_move() || now < side.next_frame) return;
  side.next_frame = std::max(side.next_frame + controller.frame, now - kFramesToCatchUp * controller.frame);
  Transfer& transfer = side.waiting.front();
  std::size_t size = 0;
  bool finished = true;
  if (transfer.request.in) {
    size = std::min<std::size_t>(side.size, transfer.request.length);
    transfer.data.assign(side.buffer, side.buffer + size);
  } else {
    size = std::min<std::size_t>(side.size, transfer.data.size() - transfer.sent);
    std::copy_n(transfer.data.begin() + static_cast<std::ptrdiff_t>(transfer.sent), size, side.buffer);
    transfer.sent += size;
    finished = transfer.sent == transfer.data.size();
  }
  if (finished) {
    answer(transfer, kDone);
    side.waiting.pop_front();
  }
  report_done(address, size);
}

/// Time until the next frame with a transfer, at most `longest`.
Clock::duration time_to_next_frame(Clock::duration longest) {
  const auto now = Clock::now();
  for (const auto& number : controller.endpoints)
    for (const Endpoint& side : number)
      if (side.may_move()) longest = std::min(longest, side.next_frame - now);
  return std::max(longest, Clock::duration::zero());
}

void advance_all() {
  for (std::uint8_t number = 1; number < TUP_DCD_ENDPOINT_MAX; ++number) {
    advance(number);
    advance(number | kDirectionIn);
  }
}

void finish_control(std::int32_t status) {
  if (!controller.control) return;
  answer(*controller.control, status);
  controller.control.reset();
}

/// A stage of the request on the control pipe, for which TinyUSB is ready: data one way, then the status the other way.
void advance_control(std::uint8_t address, std::uint8_t* buffer, std::size_t size) {
  if (!controller.control) return;
  Transfer& transfer = *controller.control;
  const bool in = tu_edpt_dir(address) == TUSB_DIR_IN;
  const bool reads = (transfer.request.setup[0] & kDirectionIn) != 0;
  if (in && reads) {
    size = std::min(size, transfer.request.length - transfer.data.size());
    transfer.data.insert(transfer.data.end(), buffer, buffer + size);
  } else if (!in && !reads && size > 0) {
    size = std::min(size, transfer.data.size() - transfer.sent);
    std::copy_n(transfer.data.begin() + static_cast<std::ptrdiff_t>(transfer.sent), size, buffer);
    transfer.sent += size;
  } else {
    finish_control(kDone);
  }
  dcd_event_xfer_complete(kPort, address, static_cast<std::uint32_t>(size), XFER_RESULT_SUCCESS, false);
}

void submit(Transfer transfer) {
  const Request& request = transfer.request;
  if (request.endpoint == 0) {
    controller.control = std::move(transfer);
    dcd_event_setup_received(kPort, controller.control->request.setup.data(), false);
  } else if (request.endpoint < TUP_DCD_ENDPOINT_MAX && endpoint(address_of(request)).open) {
    const std::uint8_t address = address_of(request);
    endpoint(address).waiting.push_back(std::move(transfer));
    advance(address);
  } else {
    answer(transfer, kStalled);
  }
}

bool take_back(std::uint32_t sequence) {
  for (auto& number : controller.endpoints)
    for (Endpoint& side : number) {
      const auto found = std::find_if(side.waiting.begin(), side.waiting.end(),
                                      [&](const Transfer& one) { return one.request.sequence == sequence; });
      if (found == side.waiting.end()) continue;
      side.waiting.erase(found);
      return true;
    }
  return false;
}

void unlink(const Request& request) {
  const Header header = reply(Command::unlink_reply, request.sequence, take_back(request.victim) ? kUnlinked : kDone);
  write_all(header.data(), header.size());
}

/// Takes one whole message out of the received bytes; empty if it is incomplete.
std::optional<Transfer> next_message() {
  Bytes& received = controller.received;
  if (received.size() < kHeaderSize) return std::nullopt;
  Header header{};
  std::copy_n(received.begin(), kHeaderSize, header.begin());
  Transfer transfer{parse(header), {}, 0};
  const Request& request = transfer.request;
  if ((request.command != Command::submit && request.command != Command::unlink) || request.length > kLongestTransfer) {
    controller.connected = false;
    return std::nullopt;
  }
  const std::size_t follows = request.command == Command::submit && !request.in ? request.length : 0;
  if (received.size() < kHeaderSize + follows) return std::nullopt;
  const auto end = received.begin() + static_cast<std::ptrdiff_t>(kHeaderSize + follows);
  transfer.data.assign(received.begin() + kHeaderSize, end);
  received.erase(received.begin(), end);
  return transfer;
}

}  // namespace

UsbipController::UsbipController(int socket, tinyusb::HidPort& port, std::chrono::microseconds frame) : port_(port) {
  controller = {};
  controller.frame = frame;
  controller.socket = socket;
  controller.connected = true;
  dcd_event_bus_reset(kPort, TUSB_SPEED_FULL, false);
  port_.poll();
}

UsbipController::~UsbipController() { close(controller.socket); }

bool UsbipController::serve(std::chrono::nanoseconds wait) {
  pollfd waiting{controller.socket, POLLIN, 0};
  const auto limit = std::chrono::duration_cast<std::chrono::nanoseconds>(time_to_next_frame(wait)).count();
  const timespec limit_ns{limit / 1'000'000'000, limit % 1'000'000'000};
  const int ready = ppoll(&waiting, 1, &limit_ns, nullptr);
  advance_all();
  port_.poll();
  if (ready > 0) {
    std::array<std::uint8_t, 4096> buffer{};
    const ssize_t size = recv(controller.socket, buffer.data(), buffer.size(), 0);
    if (size > 0) controller.received.insert(controller.received.end(), buffer.begin(), buffer.begin() + size);
    if (size == 0 || (size < 0 && errno != EINTR)) controller.connected = false;
  }
  while (controller.connected) {
    std::optional<Transfer> message = next_message();
    if (!message) break;
    if (message->request.command == Command::unlink)
      unlink(message->request);
    else
      submit(std::move(*message));
    port_.poll();
  }
  if (!controller.connected) {
    dcd_event_bus_signal(kPort, DCD_EVENT_UNPLUGGED, false);
    port_.poll();
  }
  return controller.connected;
}

}  // namespace hal::usbip

// The controller as TinyUSB sees it.

using hal::usbip::endpoint;

extern "C" {

bool dcd_init(std::uint8_t, const tusb_rhport_init_t*) { return true; }
void dcd_int_enable(std::uint8_t) {}
void dcd_int_disable(std::uint8_t) {}
void dcd_int_handler(std::uint8_t) {}
void dcd_remote_wakeup(std::uint8_t) {}
void dcd_sof_enable(std::uint8_t, bool) {}
void dcd_edpt0_status_complete(std::uint8_t, const tusb_control_request_t*) {}

bool dcd_edpt_xfer(std::uint8_t, std::uint8_t address, std::uint8_t* buffer, std::uint16_t size) {
  if (tu_edpt_number(address) == 0) {
    hal::usbip::advance_control(address, buffer, size);
    return true;
  }
  auto& side = endpoint(address);
  side.armed = true;
  side.buffer = buffer;
  side.size = size;
  hal::usbip::advance(address);
  return true;
}

/// vhci-hcd does not forward addresses; another host may.
void dcd_set_address(std::uint8_t port, std::uint8_t) {
  std::uint8_t nothing = 0;
  dcd_edpt_xfer(port, TUSB_DIR_IN_MASK, &nothing, 0);
}

bool dcd_edpt_open(std::uint8_t, const tusb_desc_endpoint_t* descriptor) {
  auto& side = endpoint(descriptor->bEndpointAddress);
  side.open = true;
  side.armed = side.stalled = false;
  side.next_frame = hal::usbip::Clock::now();
  return true;
}

void dcd_edpt_close(std::uint8_t, std::uint8_t address) { endpoint(address).open = endpoint(address).armed = false; }

void dcd_edpt_close_all(std::uint8_t port) {
  for (std::uint8_t number = 1; number < TUP_DCD_ENDPOINT_MAX; ++number) {
    dcd_edpt_close(port, number);
    dcd_edpt_close(port, number | TUSB_DIR_IN_MASK);
  }
}

void dcd_edpt_stall(std::uint8_t, std::uint8_t address) {
  if (tu_edpt_number(address) == 0) {
    hal::usbip::finish_control(hal::usbip::kStalled);
    return;
  }
  endpoint(address).stalled = true;
  endpoint(address).armed = false;
  hal::usbip::advance(address);
}

void dcd_edpt_clear_stall(std::uint8_t, std::uint8_t address) { endpoint(address).stalled = false; }
}
