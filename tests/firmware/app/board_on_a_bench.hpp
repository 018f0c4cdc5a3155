// A simulated board with its program, and a host that talks to it in reports.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>
#include <vector>

#include "firmware/app/protocol/server.hpp"
#include "hal/pc/simulated_board.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace firmware_test {

/// Axis x at 20 mm/s.
inline constexpr firmware::JogRequest kJog{0, {}, 20.0F};

inline sim::DriveDescription paper_machine(const PaperAxis& paper) {
  sim::DriveDescription drive;
  drive.data.amplifier_gain_A_per_V = paper.amplifier_gain_A_per_V;
  drive.data.torque_constant_Nm_per_A = kMotorConstant_Nm_per_A;
  drive.data.lead = kLead_mm_per_rad;
  drive.data.dac_resolution_V = kDacResolution_V;
  drive.data.encoder_resolution = kEncoderResolution_mm;
  drive.data.tach_noise_variance = 0.01;
  drive.effects = {{"inertia", {{"J", paper.inertia_kg_m2}}, {}, {}},
                   {"viscous", {{"B", paper.viscous_Nm_s_per_rad}}, {}, {}}};
  return drive;
}

/// A board's status and that of each of its axes.
struct SeenStatus : firmware::BoardStatus {
  std::vector<firmware::AxisStatus> axis;
};

/// The paper's axes alternate.
template <typename Scalar = float, std::size_t axes = hal::kAxisCount>
struct BoardOnABench {
  using Board = hal::pc::SimulatedBoardOf<axes>;
  using Application = firmware::BoardApplication<Scalar, Board>;
  static constexpr std::size_t kAxes = axes;

  Board board;
  Application application{board};
  firmware::ImageHeader image;
  firmware::ProtocolServer<Application> server{application, image, {}};
  std::uint16_t sequence = 0;
  std::uint16_t client = 1;  ///< the requesting client
  std::uint8_t pass = 0;     ///< pass of the requesting client

  static typename Board::Drives machines() {
    typename Board::Drives drives;
    for (std::size_t axis = 0; axis < axes; ++axis) drives[axis] = paper_machine(axis % 2 == 0 ? kPaperX : kPaperY);
    return drives;
  }

  /// The home switch acts from 5 mm on, index pulses lie at 1 mm, 4 mm, 7 mm …
  static typename Board::Wiring switches() {
    typename Board::Wiring wiring;
    for (hal::pc::AxisWiring& one : wiring) {
      one.home = 5.0;
      one.index_spacing = 3.0;
      one.index_offset = 1.0;
    }
    return wiring;
  }

  /// Starts with the present contents of the flash.
  explicit BoardOnABench(const hal::pc::SimulatedFlash* flash = nullptr,
                         const typename Board::Drives& drives = machines())
      : board(drives, 1, switches()) {
    if (flash != nullptr) board.parameter_flash() = *flash;
    board.usb().plug_in();
    application.start();
  }

  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      application.control_period();
      server.poll(board.usb());
      board.advance();
    }
  }

  template <typename Payload>
  firmware::Message ask(firmware::MessageType type, const Payload& payload) {
    firmware::Message request;
    request.type = type;
    request.sequence = ++sequence;
    request.put(payload);
    return ask(request);
  }

  firmware::Message ask(firmware::MessageType type) {
    firmware::Message request;
    request.type = type;
    request.sequence = ++sequence;
    return ask(request);
  }

  firmware::Message ask(firmware::Message request) {
    request.client = client;
    request.set_pass(pass);
    firmware::Message reply;
    EXPECT_EQ(firmware::decode(server.answer(firmware::encode(request)), reply), firmware::Status::ok);
    EXPECT_EQ(reply.type, firmware::reply_to(request.type));
    EXPECT_EQ(reply.sequence, request.sequence);
    EXPECT_EQ(reply.client, request.client);
    return reply;
  }

  /// Stages all values that differ from the active set, and commits.
  firmware::Message download(const firmware::ParameterValues& values) {
    EXPECT_EQ(ask(firmware::MessageType::begin_staging, firmware::BeginRequest{}).status, firmware::Status::ok);
    firmware::ValuesPayload part;
    for (std::size_t place = 0; place < values.size(); ++place) {
      if (values.at(place) == application.active().at(place)) continue;
      part.key[part.count] = firmware::key_at(place).code;
      part.bits[part.count++] = std::bit_cast<std::uint32_t>(values.at(place));
      if (part.count < firmware::kValuesPerReport) continue;
      EXPECT_EQ(ask(firmware::MessageType::stage, part).status, firmware::Status::ok);
      part = {};
    }
    if (part.count != 0) {
      EXPECT_EQ(ask(firmware::MessageType::stage, part).status, firmware::Status::ok);
    }
    return ask(firmware::MessageType::commit, firmware::CommitRequest{firmware::set_crc(values)});
  }

  /// Sends as many requests as necessary.
  SeenStatus status() {
    SeenStatus seen;
    do {
      const firmware::StatusRequest from{static_cast<std::uint8_t>(seen.axis.size())};
      const firmware::Message reply = ask(firmware::MessageType::status, from);
      firmware::StatusPayload part;
      std::memcpy(&part, reply.payload.data(), reply.length);
      static_cast<firmware::BoardStatus&>(seen) = part.board;
      const std::size_t told = (reply.length - sizeof part.board) / sizeof part.axis[0];
      if (told == 0) throw std::runtime_error("a status without axes");
      seen.axis.insert(seen.axis.end(), part.axis.begin(), part.axis.begin() + static_cast<std::ptrdiff_t>(told));
    } while (seen.axis.size() < seen.axis_count);
    return seen;
  }

  /// Parameters of the paper's x axis, self-test passed, enabled; home is where the axis stands.
  void fit_and_enable_x(double timeout_s = 0.2) {
    firmware::ParameterValues values = paper_values(axes);
    set(values, "host.timeout", timeout_s);
    ASSERT_EQ(download(values).status, firmware::Status::ok);
    run(200);
    ASSERT_EQ(ask(firmware::MessageType::enable, firmware::AxesRequest{1}).status, firmware::Status::ok);
    ASSERT_EQ(ask(firmware::MessageType::home, firmware::HomeRequest{0, 1}).status, firmware::Status::ok);
    run(5);
    ASSERT_EQ(status().axis[0].state, static_cast<std::uint8_t>(firmware::SupervisorState::enabled));
  }
};

}  // namespace firmware_test
