// A cable for reports over a byte stream, for a processor whose USB controller is not emulated. One end belongs to the
// board, the other to a program that has the controller and reports the state of the bus to the board.
#pragma once

#include <cstring>
#include <utility>

#include "firmware/boards/pil/frame.hpp"
#include "hal/serial_port.hpp"
#include "hal/tinyusb/report_queue.hpp"
#include "hal/usb_hid.hpp"

namespace firmware::boards {

/// First byte of each frame's payload, and the only one except in `report`, where the report follows.
enum class CableMessage : std::uint8_t {
  hello = 'H',         ///< from the board, when its receiver is on: earlier frames are invalid
  configured = 'C',    ///< to the board
  unconfigured = 'U',  ///< to the board
  report = 'R',
  taken = 'T',  ///< the receiver's program has taken a report, so there is room for another
  time = 'M',   ///< to the board: computer time since the last such frame, us, u32
};

/// Number of reports for which each end has room. The computer has much more, because its programs may pause while the
/// board's time continues: 65 s of one report per control period at 1 kHz.
inline constexpr std::size_t kBoardRoom = 4, kComputerRoom = 65536;

/// One end. It sends only as many reports as the other has room for, so none is lost and neither end waits.
template <hal::SerialPort Port, std::size_t own_room, std::size_t other_room>
class ReportCable {
 public:
  explicit ReportCable(Port& port) : port_(port) {}

  /// For the board, once, when its receiver is on.
  void say_hello() { tell(CableMessage::hello); }
  /// For the computer: the present state of the bus.
  void set_configured(bool configured) {
    begin_anew(configured);
    tell(configured ? CableMessage::configured : CableMessage::unconfigured);
  }
  /// For the computer: sends the time by which its clock has advanced.
  void pass_time(std::uint32_t passed_us) {
    std::array<std::byte, 1 + sizeof passed_us> payload{static_cast<std::byte>(CableMessage::time)};
    std::memcpy(payload.data() + 1, &passed_us, sizeof passed_us);
    tell(payload);
  }
  /// For the board: the computer's time that has passed since the last call.
  std::uint32_t take_passed_us() { return std::exchange(passed_us_, 0u); }
  /// For the computer: true once after each start of the board.
  bool heard_hello() {
    const bool heard = heard_hello_;
    heard_hello_ = false;
    return heard;
  }

  /// Processes the bytes that have arrived; call it often. False if there were none.
  bool poll() {
    constexpr int kMostBytes = 256;  // keeps a round of the background short
    std::byte byte{};
    int taken = 0;
    for (; taken < kMostBytes && port_.receive(byte); ++taken)
      if (receiver_.take(byte)) handle(receiver_.payload());
    return taken > 0;
  }

  bool send(const hal::HidReport& report) {
    if (!configured_ || room_ == 0) return false;
    --room_;
    std::array<std::byte, 1 + hal::kHidReportSize> payload{static_cast<std::byte>(CableMessage::report)};
    std::copy(report.begin(), report.end(), payload.begin() + 1);
    tell(payload);
    return true;
  }
  bool receive(hal::HidReport& report) {
    if (!arrived_.take(report)) return false;
    tell(CableMessage::taken);
    return true;
  }
  bool is_configured() const { return configured_; }

 private:
  void tell(std::span<const std::byte> payload) {
    send_frame(payload, [this](std::byte byte) { port_.send(byte); });
  }
  void tell(CableMessage message) { tell(std::array{static_cast<std::byte>(message)}); }

  void handle(std::span<const std::byte> payload) {
    if (payload.empty()) return;
    switch (static_cast<CableMessage>(payload.front())) {
      case CableMessage::hello:
        heard_hello_ = true;
        begin_anew(false);
        break;
      case CableMessage::configured:
        begin_anew(true);
        break;
      case CableMessage::unconfigured:
        begin_anew(false);
        break;
      case CableMessage::report:
        take_report(payload.subspan(1));
        break;
      case CableMessage::taken:
        if (room_ < other_room) ++room_;
        break;
      case CableMessage::time:
        take_time(payload.subspan(1));
        break;
    }
  }

  void take_report(std::span<const std::byte> bytes) {
    hal::HidReport report;
    if (!configured_ || bytes.size() != report.size()) return;
    std::copy(bytes.begin(), bytes.end(), report.begin());
    arrived_.put(report);
  }

  void take_time(std::span<const std::byte> bytes) {
    std::uint32_t passed_us = 0;
    if (bytes.size() != sizeof passed_us) return;
    std::memcpy(&passed_us, bytes.data(), sizeof passed_us);
    passed_us_ += passed_us;
  }

  void begin_anew(bool configured) {
    configured_ = configured;
    room_ = other_room;
    arrived_.clear();
  }

  Port& port_;
  FrameReceiver<1 + hal::kHidReportSize> receiver_;
  hal::tinyusb::ReportQueue<own_room> arrived_;
  std::size_t room_ = other_room;
  std::uint32_t passed_us_ = 0;
  bool configured_ = false;
  bool heard_hello_ = false;
};

template <hal::SerialPort Port>
using BoardEnd = ReportCable<Port, kBoardRoom, kComputerRoom>;
template <hal::SerialPort Port>
using ComputerEnd = ReportCable<Port, kComputerRoom, kBoardRoom>;

}  // namespace firmware::boards
