// The board behind its protocol: sets of parameters, saving, motion, capture.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::MessageType;
using firmware::ParameterValues;
using firmware::Status;
using firmware::StoreState;
using firmware::SupervisorState;
using firmware_test::place_named;
using firmware_test::set;

/// Every test runs on boards of one, two and three axes.
template <typename Axes>
class OfAxes : public testing::Test {
 protected:
  static constexpr std::size_t kAxes = Axes::value;
  using Bench = firmware_test::BoardOnABench<float, kAxes>;
  static ParameterValues paper_values() { return firmware_test::paper_values(kAxes); }
};
using AxisCounts = testing::Types<std::integral_constant<std::size_t, 1>, std::integral_constant<std::size_t, 2>,
                                  std::integral_constant<std::size_t, 3>>;
struct CountNames {
  template <typename Axes>
  static std::string GetName(int) {
    return std::to_string(Axes::value) + "axes";
  }
};
#define AXIS_COUNTS(suite)    \
  template <typename Axes>    \
  using suite = OfAxes<Axes>; \
  TYPED_TEST_SUITE(suite, AxisCounts, CountNames)

AXIS_COUNTS(BoardParameters);
AXIS_COUNTS(BoardMotion);
AXIS_COUNTS(Capture);
AXIS_COUNTS(BoardProtocol);

constexpr auto kFault = static_cast<std::uint8_t>(SupervisorState::fault);
constexpr auto kEnabled = static_cast<std::uint8_t>(SupervisorState::enabled);

TYPED_TEST(BoardParameters, AreTakenOverAsAWholeSet) {
  typename TestFixture::Bench bench;
  EXPECT_EQ(bench.download(this->paper_values()).status, Status::ok);
  EXPECT_EQ(bench.application.active(), this->paper_values());
  EXPECT_NE(bench.status().flags & firmware::kBoardUnsaved, 0);
}

TYPED_TEST(BoardParameters, ASetThatDoesNotFitTogetherChangesNothing) {
  typename TestFixture::Bench bench;
  ASSERT_EQ(bench.download(this->paper_values()).status, Status::ok);
  ParameterValues other = this->paper_values();
  set(other, "x.feedback.k1", 1);
  set(other, "x.drive.sample_period", 0.002);
  const firmware::Message reply = bench.download(other);
  EXPECT_EQ(reply.status, Status::bad_value);
  firmware::RefusedValuePayload problem;
  ASSERT_TRUE(reply.get(problem));
  EXPECT_EQ(problem.key, firmware::key_at(place_named("x.drive.sample_period")).code);
  EXPECT_EQ(bench.application.active(), this->paper_values());
}

TYPED_TEST(BoardParameters, AReportWithOneBadValueStagesNone) {
  typename TestFixture::Bench bench;
  bench.ask(MessageType::begin_staging, firmware::BeginRequest{});
  firmware::ValuesPayload part;
  part.count = 2;
  part.key[0] = firmware::key_at(place_named("x.feedback.k1")).code;
  part.bits[0] = std::bit_cast<std::uint32_t>(48.0F);
  part.key[1] = firmware::key_at(place_named("x.kalman.k11")).code;
  part.bits[1] = std::bit_cast<std::uint32_t>(5.2F);
  const firmware::Message reply = bench.ask(MessageType::stage, part);
  EXPECT_EQ(reply.status, Status::bad_value);
  firmware::RefusedValuePayload problem;
  ASSERT_TRUE(reply.get(problem));
  EXPECT_EQ(problem.key, part.key[1]);
  EXPECT_EQ(problem.kind, static_cast<std::uint8_t>(firmware::ValueRefusal::above_maximum));
  EXPECT_EQ(bench.application.staged(), bench.application.active());
  part.key[1] = 0x1FFF;
  EXPECT_EQ(bench.ask(MessageType::stage, part).status, Status::unknown_parameter);
}

TYPED_TEST(BoardParameters, OnlyTheSetThatTheHostMeansIsCommitted) {
  typename TestFixture::Bench bench;
  bench.ask(MessageType::begin_staging, firmware::BeginRequest{});
  EXPECT_EQ(bench.ask(MessageType::commit, firmware::CommitRequest{firmware::set_crc(this->paper_values())}).status,
            Status::set_differs);
  EXPECT_EQ(bench.application.active(), ParameterValues(TestFixture::kAxes));
}

TYPED_TEST(BoardParameters, AreRefusedAndNotSavedWhileADriveIsEnabled) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  ParameterValues other = this->paper_values();
  set(other, "x.feedback.k1", 40);
  EXPECT_EQ(bench.download(other).status, Status::drive_enabled);
  EXPECT_EQ(bench.ask(MessageType::save).status, Status::drive_enabled);
  EXPECT_EQ(bench.ask(MessageType::restart).status, Status::drive_enabled);
  EXPECT_EQ(bench.application.active(), this->paper_values());
  EXPECT_EQ(bench.status().axis[0].state, kEnabled);
}

TYPED_TEST(BoardParameters, OutliveARestartOnceTheyAreSaved) {
  typename TestFixture::Bench bench;
  ASSERT_EQ(bench.download(this->paper_values()).status, Status::ok);
  ASSERT_EQ(bench.ask(MessageType::save).status, Status::ok);
  EXPECT_EQ(bench.status().flags & firmware::kBoardUnsaved, 0);
  typename TestFixture::Bench again(&bench.board.parameter_flash());
  EXPECT_EQ(again.application.active(), this->paper_values());
  EXPECT_EQ(again.status().store_state, static_cast<std::uint8_t>(StoreState::loaded));
}

TYPED_TEST(BoardParameters, ADamagedStoreKeepsTheDrivesDisabledAndHasAName) {
  typename TestFixture::Bench bench;
  ASSERT_EQ(bench.download(this->paper_values()).status, Status::ok);
  ASSERT_EQ(bench.ask(MessageType::save).status, Status::ok);
  ASSERT_EQ(bench.ask(MessageType::save).status, Status::ok);
  bench.board.parameter_flash().contents()[1][64] ^= std::byte{4};
  typename TestFixture::Bench again(&bench.board.parameter_flash());
  EXPECT_EQ(again.status().store_state, static_cast<std::uint8_t>(StoreState::damaged));
  again.run(200);
  EXPECT_EQ(again.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::device_fault);
  EXPECT_FALSE(again.board.axis(0).drive_enable().is_on());
  // New parameters alone are no remedy: they must also be saved.
  ASSERT_EQ(again.download(this->paper_values()).status, Status::ok);
  EXPECT_EQ(again.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::device_fault);
  ASSERT_EQ(again.ask(MessageType::save).status, Status::ok);
  again.run(200);
  EXPECT_EQ(again.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
}

/// A changed gain, threshold, friction curve, board limit or value is found while the axis is enabled. Only a restart
/// clears the fault.
TYPED_TEST(BoardParameters, ThatChangeByThemselvesStopTheBoard) {
  using TestedBoard = typename TestFixture::Bench;
  const auto flip = [](const auto& setting, std::size_t byte) {
    const_cast<std::byte*>(std::as_bytes(std::span(&setting, 1)).data())[byte] ^= std::byte{4};
  };
  const std::function<void(TestedBoard&)> changes[] = {
      [&](TestedBoard& b) { flip(b.application.axes()[0].parameters().Kc[0], 1); },
      [&](TestedBoard& b) { flip(b.application.axes()[0].monitors().limits().overspeed, 0); },
      [&](TestedBoard& b) {
        b.application.axes()[0].law().each_setting([&](const auto& setting) {
          if constexpr (sizeof setting > 1000) flip(setting, sizeof setting - 1);
        });
      },
      [&](TestedBoard& b) { flip(b.application.axes().board().limits().standing_samples, 0); },
      [&](TestedBoard& b) { flip(b.application.active(), sizeof(ParameterValues) / 4); },
      [&](TestedBoard& b) { flip(b.application.axes()[TestFixture::kAxes - 1].parameters().Kobs[0][0], 3); },
  };
  for (const auto& change : changes) {
    TestedBoard bench;
    bench.fit_and_enable_x();
    bench.run(2000);
    ASSERT_EQ(bench.application.axes()[0].fault(), firmware::AxisFault::none);
    change(bench);
    bench.run(1500);
    EXPECT_EQ(bench.application.axes()[0].fault(), firmware::AxisFault::settings_changed) << &change - changes;
    EXPECT_FALSE(bench.board.axis(0).drive_enable().is_on());
    bench.ask(MessageType::clear_faults);
    bench.run(200);
    EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::device_fault);
  }
}

TYPED_TEST(BoardParameters, ThatHaveChangedByThemselvesAreNotSaved) {
  typename TestFixture::Bench bench;
  ASSERT_EQ(bench.download(this->paper_values()).status, Status::ok);
  const_cast<ParameterValues&>(bench.application.active()).set(place_named("x.feedback.k1"), 40.0F);
  EXPECT_EQ(bench.ask(MessageType::save).status, Status::device_fault);
}

TYPED_TEST(BoardMotion, AnAxisThatIsNotFittedStaysOff) {
  typename TestFixture::Bench bench;
  bench.run(200);
  EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::not_fitted);
  EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{0}).status, Status::malformed);
  EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1u << TestFixture::kAxes}).status, Status::malformed);
  EXPECT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 1.0F}).status, Status::wrong_state);
}

TYPED_TEST(BoardMotion, MovesToItsTargetWhileTheHostIsHeard) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  const std::int64_t target = 4096;  // 10 mm
  ASSERT_EQ(bench.ask(MessageType::move, firmware::MoveRequest::to(0, target)).status, Status::ok);
  for (int i = 0; i < 20; ++i) {
    bench.run(50);
    ASSERT_EQ(bench.ask(MessageType::heartbeat).status, Status::ok);
  }
  const firmware::AxisStatus axis = bench.status().axis[0];
  EXPECT_EQ(axis.state, kEnabled);
  EXPECT_NE(axis.flags & firmware::kAxisAtRest, 0);
  EXPECT_NEAR(static_cast<double>(axis.counts()), static_cast<double>(target), 2.0);
}

/// Move requests by any number of counts, for a homed axis and for one that is not homed: the board answers, and the
/// axis does not move.
TYPED_TEST(BoardMotion, AMoveBeyondAllCountingIsRefused) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min(),
                         kMost = std::numeric_limits<std::int64_t>::max();
  for (const bool is_homed : {true, false}) {
    typename TestFixture::Bench bench;
    bench.fit_and_enable_x();
    if (!is_homed) bench.application.axes()[0].forget_home();
    const std::int64_t before = bench.status().axis[0].counts();
    for (const std::int64_t counts : {kLeast, kLeast + 1, kMost, kMost - 1, -(std::int64_t{1} << 62)}) {
      EXPECT_NE(bench.ask(MessageType::move, firmware::MoveRequest::by(0, counts)).status, Status::ok) << counts;
      EXPECT_NE(bench.ask(MessageType::move, firmware::MoveRequest::to(0, counts)).status, Status::ok) << counts;
    }
    bench.run(50);
    EXPECT_EQ(bench.status().axis[0].counts(), before);
    EXPECT_EQ(bench.status().axis[0].state, kEnabled);
  }
}

/// Until an axis is homed, its free travel is unknown.
TYPED_TEST(BoardMotion, AnAxisThatIsNotHomedHasAVelocityLimitOfItsOwn) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x(5.0);
  ASSERT_EQ(bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(50);
  ParameterValues values = bench.application.active();
  set(values, "x.limits.unhomed_velocity", 20);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  bench.run(200);
  ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(5);
  const auto jog = [&](float velocity) { return bench.ask(MessageType::jog, firmware::JogRequest{0, {}, velocity}); };
  EXPECT_EQ(jog(60.0F).status, Status::ok) << "homed";
  bench.run(200);
  bench.ask(MessageType::stop);
  bench.run(300);
  bench.application.axes()[0].forget_home();
  for (const float fast : {20.1F, -20.1F, 1e30F}) {
    firmware::RefusedValuePayload refused;
    const firmware::Message reply = jog(fast);
    EXPECT_EQ(reply.status, Status::bad_value) << fast;
    ASSERT_TRUE(reply.get(refused));
    EXPECT_EQ(refused.key, firmware::key_at(firmware_test::place_named("x.limits.unhomed_velocity")).code);
  }
  const std::int64_t before = bench.status().axis[0].counts();
  ASSERT_EQ(bench.ask(MessageType::move, firmware::MoveRequest::by(0, 8192)).status, Status::ok);  // 20 mm
  bench.run(900);
  const double way_mm = static_cast<double>(bench.status().axis[0].counts() - before) * 0.00244140625;
  EXPECT_GT(way_mm, 15.0);
  EXPECT_LT(way_mm, 18.1) << "faster than 20 mm/s";
  bench.run(300);
  EXPECT_NEAR(static_cast<double>(bench.status().axis[0].counts() - before), 8192.0, 2.0);
  EXPECT_EQ(jog(-20.0F).status, Status::ok);
}

/// Control periods of 1 ms from the last request to the beginning of the stop; also checks the end of the stop.
template <typename Bench>
int periods_until_a_stop(double timeout_s) {
  Bench bench;
  bench.fit_and_enable_x(timeout_s);
  EXPECT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 50.0F}).status, Status::ok);
  int periods = 0;
  for (; periods < 2000 && bench.application.axes()[0].state() == SupervisorState::enabled; ++periods) bench.run(1);
  bench.run(1000);
  const firmware::AxisStatus axis = bench.status().axis[0];
  EXPECT_EQ(axis.state, kFault);
  EXPECT_EQ(axis.fault, static_cast<std::uint8_t>(firmware::AxisFault::host_heartbeat_lost));
  EXPECT_NEAR(axis.velocity, 0.0, 0.5);
  EXPECT_FALSE(bench.board.axis(0).drive_enable().is_on());
  return periods;
}

TYPED_TEST(BoardMotion, StopsWhenTheHostFallsSilent) {
  EXPECT_NEAR(periods_until_a_stop<typename TestFixture::Bench>(0.2), 200, 2);
  EXPECT_NEAR(periods_until_a_stop<typename TestFixture::Bench>(0.05), 50, 2);
}

/// A change of parameters in motion does not pause the monitor: a late interrupt after it is still detected.
TYPED_TEST(BoardMotion, AParameterChangeHidesNoOverrun) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 50.0F}).status, Status::ok);
  bench.run(50);
  ParameterValues values = bench.application.active();
  set(values, "host.standing_timeout", 50);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  bench.board.advance();
  bench.run(1);
  EXPECT_EQ(bench.status().axis[0].fault, static_cast<std::uint8_t>(firmware::AxisFault::control_overrun));
}

TYPED_TEST(BoardMotion, StandsAsLongAsItLikesWithoutAHost) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  bench.run(2000);
  EXPECT_EQ(bench.status().axis[0].state, kEnabled);
}

TYPED_TEST(BoardMotion, FaultsAreClearedAndKeptRowsAreReadable) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  bench.board.emergency_stop().press();
  bench.run(20);
  EXPECT_EQ(bench.status().axis[0].fault, static_cast<std::uint8_t>(firmware::AxisFault::emergency_stop));
  firmware::FaultRowPayload row;
  ASSERT_TRUE(bench.ask(MessageType::read_fault_capture, firmware::FaultRowRequest{0, 0, 0}).get(row));
  EXPECT_GT(row.rows, 50);
  EXPECT_EQ(bench.ask(MessageType::read_fault_capture, firmware::FaultRowRequest{0, 0, row.rows}).status,
            Status::no_such_row);
  bench.board.emergency_stop().release();
  EXPECT_EQ(bench.ask(MessageType::clear_faults).status, Status::ok);
  bench.run(200);
  EXPECT_EQ(bench.status().axis[0].fault, 0);
  EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
}

/// Captures for 3 s and expects every row once and in order.
template <typename Bench>
void expect_all_rows(const firmware::CaptureRequest& request, std::size_t words) {
  Bench bench;
  bench.fit_and_enable_x();
  ASSERT_EQ(bench.ask(MessageType::start_capture, request).status, Status::ok);
  const int kPeriods = 3000;
  std::uint32_t next_row = 0;
  const auto fetch = [&] {
    hal::HidReport report;
    while (bench.board.usb().host_receive(report)) {
      firmware::Message message;
      ASSERT_EQ(firmware::decode(report, message), firmware::Status::ok);
      ASSERT_EQ(message.type, MessageType::samples);
      std::uint32_t first = 0;
      std::memcpy(&first, message.payload.data(), 4);
      ASSERT_EQ(first, next_row);
      ASSERT_EQ((message.length - 4u) % (4 * words), 0u);
      next_row += static_cast<std::uint32_t>((message.length - 4u) / (4 * words));
    }
  };
  for (int k = 0; k < kPeriods; ++k) {
    bench.run(1);
    fetch();
  }
  firmware::CaptureReply taken;
  ASSERT_TRUE(bench.ask(MessageType::stop_capture).get(taken));
  for (int i = 0; i < 100; ++i) bench.server.poll(bench.board.usb());
  fetch();
  EXPECT_EQ(taken.rows, (kPeriods + request.every - 1u) / request.every);
  EXPECT_EQ(taken.dropped, 0u);
  EXPECT_EQ(next_row, taken.rows);
}

TYPED_TEST(Capture, SendsEveryRowOnceAndInOrder) {
  using Tested = typename TestFixture::Bench;
  expect_all_rows<Tested>({{1u << 1}, 1, 0}, 1);
  expect_all_rows<Tested>({{0x1F}, 3, 0}, 5);
  firmware::CaptureRequest full{{0x7FF >> (TestFixture::kAxes - 1)}, 1, 0};  // twelve words with all axes
  for (std::size_t axis = 1; axis < TestFixture::kAxes; ++axis) full.channels[axis] = axis == 1 ? 3 : 1;
  expect_all_rows<Tested>(full, full.words());
}

TYPED_TEST(Capture, ARowHoldsTheAxesInTheirOrder) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  firmware::CaptureRequest request;
  for (std::size_t axis = 0; axis < TestFixture::kAxes; ++axis) request.channels[axis] = 1u << 10;  // flags: the state
  ASSERT_EQ(bench.ask(MessageType::start_capture, request).status, Status::ok);
  bench.run(12);
  hal::HidReport report;
  ASSERT_TRUE(bench.board.usb().host_receive(report));
  for (std::size_t axis = 0; axis < TestFixture::kAxes; ++axis)
    EXPECT_EQ(std::to_integer<int>(report[firmware::kPayloadOffset + 4 + 4 * axis]), axis == 0 ? kEnabled : 0) << axis;
}

TYPED_TEST(Capture, LossIsCountedAndShowsInTheNumbersOfRows) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  ASSERT_EQ(bench.ask(MessageType::start_capture, firmware::CaptureRequest{{0x7FF}, 1, 0}).status, Status::ok);
  bench.run(500);  // the host does not read: first the queue of the cable, then the board's rows fill up
  std::vector<std::uint32_t> numbers;
  firmware::CaptureReply taken;
  ASSERT_TRUE(bench.ask(MessageType::stop_capture).get(taken));
  hal::HidReport report;
  for (int i = 0; i < 500; ++i) {
    bench.server.poll(bench.board.usb());
    while (bench.board.usb().host_receive(report)) {
      std::uint32_t first = 0;
      std::memcpy(&first, report.data() + firmware::kPayloadOffset, 4);
      numbers.push_back(first);
    }
  }
  EXPECT_EQ(taken.rows, 500u);
  EXPECT_GT(taken.dropped, 0u);
  EXPECT_EQ(numbers.size(), taken.rows - taken.dropped) << "every row that was not dropped arrives";
}

TYPED_TEST(Capture, RefusesWhatDoesNotFitAReport) {
  typename TestFixture::Bench bench;
  const auto status_of = [&](firmware::CaptureRequest request) {
    return bench.ask(MessageType::start_capture, request).status;
  };
  EXPECT_EQ(status_of({{}, 1, 0}), Status::malformed) << "no channel";
  EXPECT_EQ(status_of({{1u << 11}, 1, 0}), Status::malformed) << "no such channel";
  EXPECT_EQ(status_of({{1}, 0, 0}), Status::malformed) << "every 0th period";
  firmware::CaptureRequest beyond{{1}, 1, 0};
  beyond.channels[TestFixture::kAxes] = 1;
  EXPECT_EQ(status_of(beyond), Status::malformed) << "no such axis";
  if (TestFixture::kAxes > 1) {
    EXPECT_EQ(status_of({{0x7FF, 3}, 1, 0}), Status::malformed) << "13 channels";
  }
}

TYPED_TEST(BoardProtocol, TellsHowManyAxesThereAreAndNothingOfOthers) {
  typename TestFixture::Bench bench;
  firmware::IdentityPayload identity;
  ASSERT_TRUE(bench.ask(MessageType::identify).get(identity));
  EXPECT_EQ(identity.axis_count, TestFixture::kAxes);
  EXPECT_EQ(identity.parameter_count, firmware::parameter_count(TestFixture::kAxes));
  EXPECT_EQ(bench.status().axis.size(), TestFixture::kAxes);
  constexpr std::uint8_t kBeyond = TestFixture::kAxes;
  EXPECT_EQ(bench.ask(MessageType::status, firmware::StatusRequest{kBeyond}).status, Status::malformed);
  EXPECT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{kBeyond, {}, 1.0F}).status, Status::malformed);
  EXPECT_EQ(bench.ask(MessageType::move, firmware::MoveRequest::to(kBeyond, 1)).status, Status::malformed);
  EXPECT_EQ(bench.ask(MessageType::read_fault_capture, firmware::FaultRowRequest{kBeyond, 0, 0}).status,
            Status::malformed);
  firmware::ValuesPayload part;
  part.count = 1;
  part.key[0] = firmware::ParameterKey::of_axis(TestFixture::kAxes, 80).code;
  EXPECT_EQ(bench.ask(MessageType::stage, part).status, Status::unknown_parameter);
}

TYPED_TEST(BoardMotion, TheLastAxisMovesAndTheOthersStopWithIt) {
  typename TestFixture::Bench bench;
  constexpr std::uint8_t kLast = TestFixture::kAxes - 1;
  ParameterValues values = this->paper_values();
  for (std::size_t axis = 0; axis < TestFixture::kAxes; ++axis)
    firmware_test::fit_axis(values, std::string(firmware::kAxisNames[axis]),
                            axis % 2 == 0 ? firmware_test::kPaperX : firmware_test::kPaperY);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  bench.run(200);
  ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{(1u << TestFixture::kAxes) - 1}).status, Status::ok);
  bench.run(5);
  ASSERT_EQ(bench.ask(MessageType::move, firmware::MoveRequest::by(kLast, 2048)).status, Status::ok);
  for (int i = 0; i < 20; ++i) {
    bench.run(50);
    ASSERT_EQ(bench.ask(MessageType::heartbeat).status, Status::ok);
  }
  EXPECT_NEAR(static_cast<double>(bench.status().axis.at(kLast).counts()), 2048.0, 2.0);
  bench.board.plant(kLast).set_enabled(false);  // the drive has no current, and an external force acts
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{kLast, {}, 50.0F}).status, Status::ok);
  for (int i = 0; i < 100; ++i) {
    bench.run(10);
    ASSERT_EQ(bench.ask(MessageType::heartbeat).status, Status::ok);
  }
  const auto seen = bench.status();
  EXPECT_NE(seen.axis.at(kLast).fault, 0);
  for (std::size_t axis = 0; axis < kLast; ++axis)
    EXPECT_EQ(seen.axis[axis].fault, static_cast<std::uint8_t>(firmware::AxisFault::other_axis_stopped)) << axis;
}

TYPED_TEST(BoardProtocol, AnswersWhatItDoesNotKnow) {
  typename TestFixture::Bench bench;
  EXPECT_EQ(bench.ask(static_cast<MessageType>(0x44)).status, Status::unknown_request);
  EXPECT_EQ(bench.ask(MessageType::jog).status, Status::malformed);
  hal::HidReport noise{};
  noise.fill(std::byte{0xA5});
  firmware::Message reply;
  ASSERT_EQ(firmware::decode(bench.server.answer(noise), reply), firmware::Status::ok);
  EXPECT_EQ(reply.type, MessageType::rejected);
  EXPECT_EQ(reply.status, Status::damaged);
}

TEST(FixedPointProtocol, SpeaksThePhysicalUnitsOfRequests) {
  firmware_test::BoardOnABench<firmware::FixedPoint> bench;
  bench.fit_and_enable_x();
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 20.0F}).status, Status::ok);
  const std::int64_t before = bench.status().axis[0].counts();
  for (int i = 0; i < 20; ++i) {
    bench.run(50);
    bench.ask(MessageType::heartbeat);
  }
  const firmware::AxisStatus axis = bench.status().axis[0];
  const double travel_mm = static_cast<double>(axis.counts() - before) * firmware_test::kEncoderResolution_mm;
  EXPECT_NEAR(travel_mm, 20.0, 1.5) << "one second at 20 mm/s, less the acceleration";
  EXPECT_NEAR(axis.velocity, 20.0 / firmware_test::kLead_mm_per_rad, 1.0);
}

}  // namespace
