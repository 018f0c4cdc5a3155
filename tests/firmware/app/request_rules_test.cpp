// Every message, from the owner and from another client: exactly the expected ones are refused.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::MessageType;
using firmware::Status;
using firmware::SupervisorState;
using firmware_test::kJog;
using firmware_test::set;
using Bench = firmware_test::BoardOnABench<float>;

constexpr std::uint16_t kOwner = 1, kStranger = 2;
/// Moves only x, for 600 ms in all, at 50 mm/s.
constexpr firmware::PathUnits kUnits{8, 20, 26};

/// Payload size, and the reply to another client while the owner's axis moves and the owner captures; from the
/// protocol's page, not from the table under test.
struct Expected {
  int length = 0;
  Status stranger = Status::ok;
  bool any_length = false;
};
const std::map<int, Expected> kMessages{
    {0x01, {}},
    {0x02, {1}},
    {0x03, {1}},
    {0x10, {4}},
    {0x11, {1}},
    {0x12, {52}},
    {0x13, {4, Status::others_motion}},
    {0x14, {0, Status::others_motion}},
    {0x15, {4}},
    {0x16, {8, Status::others_motion}},
    {0x17, {52, Status::others_motion}},
    {0x18, {8, Status::others_motion}},
    {0x19, {4}},
    {0x20, {1, Status::others_motion}},
    {0x21, {1}},
    {0x22, {0, Status::ok, true}},
    {0x23, {8, Status::others_motion}},
    {0x24, {12, Status::others_motion}},
    {0x25, {0, Status::others_motion}},
    {0x26, {}},
    {0x27, {}},
    {0x28, {2, Status::others_motion}},
    {0x30, {12, Status::others_capture}},
    {0x31, {0, Status::others_capture}},
    {0x32, {4}},
    {0x33, {1}},
    {0x3E, {0, Status::others_motion}},
    {0x40, {52, Status::others_motion}},
    {0x41, {52, Status::others_motion}},
    {0x42, {0, Status::ok, true}},
    {0x43, {}},
    {0x48, {40, Status::others_capture}},
    {0x49, {}},
    {0x4A, {4}},
    {0x50, {8, Status::others_motion}},
    {0x51, {16, Status::others_motion, true}},
    {0x52, {0, Status::others_motion}},
    {0x53, {4, Status::others_motion}},
    {0x54, {0, Status::ok, true}},
    {0x55, {}},
    {0x56, {}},
    {0x60, {32, Status::others_motion}},
    {0x61, {52, Status::others_motion}},
    {0x62, {0, Status::others_motion}},
    {0x63, {0, Status::others_motion}},
    {0x64, {1}},
};

firmware::Message request_of(int type, int length) {
  firmware::Message request;
  request.type = static_cast<MessageType>(type);
  request.length = static_cast<std::uint8_t>(length);
  return request;
}

class Requests : public testing::Test {
 protected:
  Requests() { bench.fit_and_enable_x(); }

  Status ask(std::uint16_t client, const firmware::Message& request) {
    bench.client = client;
    return bench.ask(request).status;
  }
  template <typename Payload>
  Status ask(std::uint16_t client, MessageType type, const Payload& payload) {
    bench.client = client;
    return bench.ask(type, payload).status;
  }
  Status ask(std::uint16_t client, MessageType type) {
    bench.client = client;
    return bench.ask(type).status;
  }
  /// Time passes while a client reads the status.
  void look(std::uint16_t client, int periods) {
    for (int k = 0; k < periods; k += 20) {
      bench.run(20);
      ask(client, MessageType::status);
    }
  }
  SupervisorState state() { return bench.application.axes()[0].state(); }
  std::int64_t counts() { return bench.application.axes()[0].telemetry().encoder_counts; }
  Status open(std::uint16_t client) {
    return ask(client, MessageType::open_path, firmware::OpenPathRequest{1, 1, kUnits});
  }
  /// A millimetre back and forth, at rest at both ends.
  Status load_path(std::uint16_t client) {
    constexpr std::array<std::uint32_t, 4> kOut{200u << firmware::kPathTimeBits, 400u << 8, 0, 0};
    constexpr std::array<std::uint32_t, 4> kBack{200u << firmware::kPathTimeBits | firmware::kLastNode,
                                                 static_cast<std::uint32_t>(-(400 << 8)), 0, 0};
    const Status first = ask(client, MessageType::path_nodes, kOut);
    return first != Status::ok ? first : ask(client, MessageType::path_nodes, kBack);
  }
  firmware::ExcitationEntriesRequest levels(float value) const {
    firmware::ExcitationEntriesRequest part;
    part.count = 1;
    part.entry[0] = {value, 200, 0};
    return part;
  }
  firmware::ExcitationRequest train() const {
    firmware::ExcitationRequest r;
    r.count = 1;
    r.travel_counts = 20000;
    r.speed = 60;
    r.volts = 3000;
    r.amplitude = 3000;
    r.samples = 400;
    return r;
  }

  Bench bench;
};

TEST_F(Requests, WhatHasNoRuleIsUnknownWhoeverAsks) {
  for (int type = 0; type < 256; ++type) {
    const bool is_known = kMessages.contains(type);
    EXPECT_EQ(firmware::rule_of(static_cast<MessageType>(type)) != nullptr, is_known) << type;
    if (is_known || (type & 0x80) != 0) continue;
    for (const int length : {0, 1, 52})
      EXPECT_EQ(ask(kOwner, request_of(type, length)), Status::unknown_request) << type;
  }
}

TEST_F(Requests, APayloadOfAnotherLengthIsRefusedAndDoesNothing) {
  for (const auto& [type, expected] : kMessages) {
    if (expected.any_length) continue;
    for (const int length : {expected.length + 1, expected.length - 1}) {
      if (length < 0 || length > 52 || (type == 0x02 && length == 0)) continue;
      EXPECT_EQ(ask(kOwner, request_of(type, length)), Status::malformed) << type << " with " << length;
    }
  }
  EXPECT_EQ(state(), SupervisorState::enabled);
}

TEST_F(Requests, AStrangerMayLookStopAndDisableAndNothingElse) {
  for (const auto& [type, expected] : kMessages) {
    Bench fresh;
    fresh.fit_and_enable_x();
    ASSERT_EQ(fresh.ask(MessageType::start_capture, firmware::CaptureRequest{{1}, 1, 0}).status, Status::ok);
    firmware::TriggerRequest trigger{};
    trigger.channels[0] = 1;
    trigger.every = 1;
    trigger.kind = 3;
    trigger.after = 100;
    ASSERT_EQ(fresh.ask(MessageType::arm_trigger, trigger).status, Status::ok);
    ASSERT_EQ(fresh.ask(MessageType::jog, kJog).status, Status::ok);
    fresh.run(100);
    fresh.client = kStranger;
    const Status heard = fresh.ask(request_of(type, expected.length)).status;
    if (expected.stranger != Status::ok)
      EXPECT_EQ(heard, expected.stranger) << type;
    else
      EXPECT_TRUE(heard != Status::others_motion && heard != Status::others_capture) << type;
    EXPECT_TRUE(fresh.application.capture().is_running()) << type;
    if (expected.stranger == Status::ok) continue;
    fresh.client = kOwner;
    EXPECT_EQ(fresh.ask(MessageType::jog, kJog).status, Status::ok) << "still owned by the first client after " << type;
  }
}

/// Replies, which every client sees, contain only the number.
TEST_F(Requests, ANumberThatWasOverheardIsNoPass) {
  bench.pass = 77;
  ASSERT_EQ(ask(kOwner, MessageType::jog, kJog), Status::ok);
  bench.pass = 0;
  EXPECT_EQ(ask(kOwner, MessageType::jog, kJog), Status::others_motion);
  for (int k = 0; k < 400; k += 20) {
    bench.run(20);
    ask(kOwner, MessageType::heartbeat);
  }
  EXPECT_EQ(bench.application.axes()[0].fault(), firmware::AxisFault::host_heartbeat_lost);
}

TEST_F(Requests, TheTimeOutIsNobodysWhileADriveIsEnabled) {
  firmware::ParameterValues values = bench.application.active();
  set(values, "host.timeout", 5.0);
  for (const bool moves : {false, true}) {
    if (moves) {
      ASSERT_EQ(ask(kOwner, MessageType::jog, kJog), Status::ok);
    }
    bench.client = kOwner;
    EXPECT_EQ(bench.download(values).status, Status::drive_enabled);
    bench.client = kStranger;
    EXPECT_EQ(bench.download(values).status, moves ? Status::others_motion : Status::drive_enabled);
  }
}

TEST_F(Requests, APathIsStartedByWhoOpenedIt) {
  ASSERT_EQ(open(kOwner), Status::ok);
  ASSERT_EQ(load_path(kOwner), Status::ok);
  EXPECT_EQ(ask(kStranger, MessageType::start_path), Status::others_motion);
  ask(kStranger, MessageType::enable, firmware::AxesRequest{1});  // the axis is already enabled
  EXPECT_EQ(ask(kStranger, MessageType::start_path), Status::others_motion);
  EXPECT_EQ(load_path(kStranger), Status::others_motion);
  EXPECT_EQ(ask(kStranger, MessageType::path_rate, firmware::PathRateRequest{}), Status::others_motion);
  EXPECT_EQ(ask(kOwner, MessageType::start_path), Status::ok);
  look(kOwner, 600);
  EXPECT_EQ(state(), SupervisorState::enabled);
}

TEST_F(Requests, APathDoesNotOutliveItsEnables) {
  ASSERT_EQ(open(kOwner), Status::ok);
  ASSERT_EQ(load_path(kOwner), Status::ok);
  ASSERT_EQ(ask(kOwner, MessageType::disable, firmware::AxesRequest{1}), Status::ok);
  look(kOwner, 300);
  ASSERT_EQ(ask(kOwner, MessageType::enable, firmware::AxesRequest{1}), Status::ok);
  bench.run(20);
  ASSERT_EQ(state(), SupervisorState::enabled);
  EXPECT_EQ(ask(kOwner, MessageType::start_path), Status::wrong_state);
  const std::int64_t before = counts();
  look(kOwner, 300);
  EXPECT_EQ(counts(), before);
  EXPECT_EQ(ask(kOwner, MessageType::jog, kJog), Status::ok) << "the axis is no longer on a path";
}

/// An emergency stop drops the enable; nodes and entries that were loaded before are discarded.
TEST_F(Requests, APathDoesNotOutliveAFault) {
  ASSERT_EQ(open(kOwner), Status::ok);
  ASSERT_EQ(load_path(kOwner), Status::ok);
  bench.board.emergency_stop().press();
  look(kOwner, 40);
  bench.board.emergency_stop().release();
  look(kOwner, 40);
  ASSERT_EQ(ask(kOwner, MessageType::clear_faults), Status::ok);
  look(kOwner, 300);
  ASSERT_EQ(ask(kOwner, MessageType::enable, firmware::AxesRequest{1}), Status::ok);
  bench.run(20);
  EXPECT_EQ(ask(kOwner, MessageType::start_path), Status::wrong_state);
}

TEST_F(Requests, AnExperimentIsStartedByWhoLoadedIt) {
  ASSERT_EQ(ask(kOwner, MessageType::disable, firmware::AxesRequest{1}), Status::ok);
  look(kOwner, 300);
  ASSERT_EQ(ask(kOwner, MessageType::load_excitation, levels(500.0F)), Status::ok);
  EXPECT_EQ(ask(kStranger, MessageType::start_excitation, train()), Status::others_motion);
  ASSERT_EQ(ask(kStranger, MessageType::load_excitation, levels(3000.0F)), Status::ok);
  EXPECT_EQ(ask(kOwner, MessageType::start_excitation, train()), Status::others_motion) << "it is not what was loaded";
  ASSERT_EQ(ask(kOwner, MessageType::load_excitation, levels(500.0F)), Status::ok);
  EXPECT_EQ(ask(kOwner, MessageType::start_excitation, train()), Status::ok);
}

TEST_F(Requests, AnExperimentNeedsAllItsEntriesForItsAxisAndInput) {
  ASSERT_EQ(ask(kOwner, MessageType::disable, firmware::AxesRequest{1}), Status::ok);
  look(kOwner, 300);
  EXPECT_EQ(ask(kOwner, MessageType::start_excitation, train()), Status::malformed) << "nothing was loaded";
  firmware::ExcitationEntriesRequest counts_of_reference = levels(500.0F);
  counts_of_reference.input = static_cast<std::uint8_t>(firmware::ExcitationInput::reference);
  ASSERT_EQ(ask(kOwner, MessageType::load_excitation, counts_of_reference), Status::ok);
  EXPECT_EQ(ask(kOwner, MessageType::start_excitation, train()), Status::malformed)
      << "levels in counts must not act as volts";
  ASSERT_EQ(ask(kOwner, MessageType::load_excitation, levels(500.0F)), Status::ok);
  firmware::ExcitationRequest longer = train();
  longer.count = 2;
  EXPECT_EQ(ask(kOwner, MessageType::start_excitation, longer), Status::malformed) << "half of it was loaded";
  firmware::ParameterValues values = bench.application.active();
  set(values, "x.drive.dac_resolution", 2e-4);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  look(kOwner, 300);
  EXPECT_EQ(ask(kOwner, MessageType::start_excitation, train()), Status::malformed) << "its unit has changed";
}

TEST_F(Requests, ATriggeredCaptureIsItsClientsUntilThatOneLetsGo) {
  firmware::TriggerRequest request{};
  request.channels[0] = 1;
  request.every = 1;
  request.after = 100;
  ASSERT_EQ(ask(kOwner, MessageType::arm_trigger, request), Status::ok);
  look(kOwner, 3000);
  EXPECT_EQ(ask(kStranger, MessageType::arm_trigger, request), Status::others_capture) << "complete, but not released";
  request.after = 0;
  EXPECT_EQ(ask(kStranger, MessageType::arm_trigger, request), Status::others_capture);
  EXPECT_EQ(ask(kOwner, MessageType::arm_trigger, request), Status::ok);
  request.after = 100;
  EXPECT_EQ(ask(kStranger, MessageType::arm_trigger, request), Status::ok);
  look(kOwner, 2100);
  EXPECT_EQ(ask(kOwner, MessageType::arm_trigger, request), Status::ok) << "the other has died";
}

/// Without a brown-out reset no drive is enabled, and requests that move an axis are refused.
TEST_F(Requests, NothingMovesWithoutBrownOutReset) {
  firmware::ProtocolServer<Bench::Application> server(bench.application, bench.image, {.lacks_brown_out_reset = true});
  for (const auto& [type, expected] : kMessages) {
    firmware::Message request = request_of(type, expected.length), reply;
    request.client = kOwner;
    ASSERT_EQ(firmware::decode(server.answer(firmware::encode(request)), reply), Status::ok);
    const bool moves = type == 0x20 || type == 0x23 || type == 0x24 || type == 0x27 || type == 0x28 || type == 0x41 ||
                       type == 0x50 || type == 0x52;
    EXPECT_EQ(reply.status == Status::brown_out_off, moves) << type;
    if (type != 0x02) continue;
    firmware::StatusPayload status;
    std::memcpy(&status, reply.payload.data(), reply.length);
    EXPECT_NE(status.board.flags & firmware::kBoardBrownOutOff, 0);
  }
}

/// Without a design only the box limits an experiment, so the board has limits of its own, whatever the request's box
/// is.
TEST(UnfittedAxis, HasLimitsOfItsOwn) {
  Bench bench;
  bench.run(200);
  firmware::ExcitationRequest r;
  r.kind = static_cast<std::uint8_t>(firmware::ExcitationKind::chirp);
  r.travel_counts = 1'000'000;
  r.speed = 16384;
  r.volts = r.amplitude = 6.0F / (20.0F / 65536);
  r.samples = 120'000;
  r.step = r.last_step = 1u << 22;
  const auto asked = [&](auto change) {
    firmware::ExcitationRequest changed = r;
    change(changed);
    const firmware::Message reply = bench.ask(MessageType::start_excitation, changed);
    firmware::RefusedValuePayload limit;
    return reply.status == Status::bad_value && reply.get(limit) ? limit.key : std::uint16_t{0};
  };
  EXPECT_EQ(asked([](auto& c) { c.volts *= 1.01F; }), 0x1000 + 256);
  EXPECT_EQ(asked([](auto& c) { c.samples += 1; }), 0x1000 + 257);
  EXPECT_EQ(asked([](auto& c) { c.travel_counts += 1; }), 0x1000 + 258);
  EXPECT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::ok);
}

}  // namespace
