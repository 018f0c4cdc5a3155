// Entries that a board writes into its fault log, and their time.
#include <gtest/gtest.h>

#include "firmware/app/protocol/fault_log_messages.hpp"
#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::AxisActivity;
using firmware::AxisFault;
using firmware::MessageType;
using firmware::Status;
using firmware_test::paper_values;
using firmware_test::set;

template <typename Scalar>
class FaultLogOnBoard : public testing::Test {
 protected:
  using Bench = firmware_test::BoardOnABench<Scalar>;

  static firmware::FaultLogPayload read(Bench& bench, std::uint8_t age, Status expected = Status::ok) {
    firmware::FaultLogPayload payload;
    const firmware::Message reply = bench.ask(MessageType::read_fault_log, firmware::FaultLogRequest{age});
    EXPECT_EQ(reply.status, expected) << "age " << int{age};
    EXPECT_TRUE(reply.get(payload));
    return payload;
  }
  static firmware::LoggedFault press_stop(Bench& bench) {
    bench.board.emergency_stop().press();
    bench.run(20);
    bench.board.emergency_stop().release();
    return read(bench, 0).entry;
  }
  static void clear(Bench& bench) {
    bench.run(20);
    EXPECT_EQ(bench.ask(MessageType::clear_faults).status, Status::ok);
    bench.run(300);
  }
};
using Numbers = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(FaultLogOnBoard, Numbers);

/// Catches an entry that is lost, that replaces a fault, or that is written while a drive is enabled.
TYPED_TEST(FaultLogOnBoard, KeepsHowTheLastRunEnded) {
  typename TestFixture::Bench bench;
  firmware::LoggedFault ended;
  ended.reset = 5;
  ended.second_fault = 3;
  ended.counts_low = 0x08001234;
  bench.application.log_end_of_last_run(ended);
  bench.run(3);
  firmware::LoggedFault first = this->read(bench, 0).entry;
  EXPECT_EQ(first.number, 1u);
  EXPECT_EQ(first.reset, 5);
  EXPECT_EQ(first.counts_low, 0x08001234u);
  this->read(bench, 1, Status::no_such_row);
  bench.fit_and_enable_x();
  ended.reset = 4;
  const std::size_t operations = bench.board.parameter_flash().operations();
  bench.application.log_end_of_last_run(ended);
  bench.run(50);
  EXPECT_EQ(bench.board.parameter_flash().operations(), operations) << "a drive is enabled";
  this->press_stop(bench);
  this->clear(bench);
  typename TestFixture::Bench again(&bench.board.parameter_flash());
  EXPECT_EQ(this->read(again, 2).entry.reset, 5);
  EXPECT_EQ(this->read(again, 1).entry.reset, 4);
  EXPECT_EQ(this->read(again, 0).entry.fault, static_cast<std::uint8_t>(AxisFault::emergency_stop));
  EXPECT_EQ(this->read(again, 0).entry.number, 3u);
}

TYPED_TEST(FaultLogOnBoard, TellsWhatTheAxisDidAndWhere) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 50.0F}).status, Status::ok);
  bench.run(150);
  bench.ask(MessageType::heartbeat);
  const std::int64_t here = bench.application.axes()[0].telemetry().encoder_counts;
  const firmware::LoggedFault entry = this->press_stop(bench);
  EXPECT_EQ(entry.fault, static_cast<std::uint8_t>(AxisFault::emergency_stop));
  EXPECT_EQ(entry.number, 1u);
  EXPECT_EQ(entry.axis, 0);
  EXPECT_EQ(entry.activity, static_cast<std::uint8_t>(AxisActivity::moving));
  EXPECT_EQ(entry.homed, 1);
  // 50 mm/s is 20 counts a millisecond; the stop counts once its input has been open for 3.
  EXPECT_NEAR(static_cast<double>(entry.counts() - here), 60.0, 45.0);
  EXPECT_NEAR(entry.velocity, 50.0 / firmware_test::kLead_mm_per_rad, 2.0);
  this->read(bench, 1, Status::no_such_row);
}

TYPED_TEST(FaultLogOnBoard, OutlivesSavesAndARestart) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  const firmware::LoggedFault standing = this->press_stop(bench);
  EXPECT_EQ(standing.activity, static_cast<std::uint8_t>(AxisActivity::standing));
  this->clear(bench);
  const firmware::LoggedFault off = this->press_stop(bench);
  EXPECT_EQ(off.activity, static_cast<std::uint8_t>(AxisActivity::disabled));
  this->clear(bench);
  for (int save = 0; save < 3; ++save) ASSERT_EQ(bench.ask(MessageType::save).status, Status::ok);
  typename TestFixture::Bench again(&bench.board.parameter_flash());
  EXPECT_EQ(this->read(again, 0).entry, off);
  EXPECT_EQ(this->read(again, 1).entry, standing);
  EXPECT_EQ(again.application.active(), bench.application.active());
}

TYPED_TEST(FaultLogOnBoard, NamesHomingAndExperiments) {
  typename TestFixture::Bench bench;
  bench.fit_and_enable_x();
  ASSERT_EQ(bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(50);
  firmware::ParameterValues values = bench.application.active();
  set(values, "x.homing.mode", 1);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  bench.run(200);
  ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(5);
  ASSERT_EQ(bench.ask(MessageType::home, firmware::HomeRequest{0, 0}).status, Status::ok);
  bench.run(50);
  EXPECT_EQ(this->press_stop(bench).activity, static_cast<std::uint8_t>(AxisActivity::homing));
  this->clear(bench);
  firmware::ExcitationEntriesRequest part;
  part.count = 1;
  part.entry[0] = {500.0F, 2000, 0};
  ASSERT_EQ(bench.ask(MessageType::load_excitation, part).status, Status::ok);
  firmware::ExcitationRequest train;
  train.count = 1;
  train.travel_counts = 20000;
  train.speed = 60;
  train.volts = train.amplitude = 3000;
  train.samples = 2000;
  ASSERT_EQ(bench.ask(MessageType::start_excitation, train).status, Status::ok);
  bench.run(50);
  EXPECT_EQ(this->press_stop(bench).activity, static_cast<std::uint8_t>(AxisActivity::open_loop));
}

/// Flash stalls the processor, so nothing is written while an axis is enabled, and no fault is lost meanwhile.
TYPED_TEST(FaultLogOnBoard, WaitsUntilEveryAxisIsOff) {
  typename TestFixture::Bench bench;
  firmware::ParameterValues values = paper_values();
  fit_axis(values, "y", firmware_test::kPaperY);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  bench.run(300);
  ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{2}).status, Status::ok);
  bench.run(5);
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{1, {}, 100.0F}).status, Status::ok);
  bench.run(150);
  const std::size_t operations = bench.board.parameter_flash().operations();
  int waiting = 0;  // from the fault of x after the host fell silent, to the end of the ramp of y
  for (int k = 0; k < 2000 && bench.application.any_enabled(); ++k) {
    bench.run(1);
    if (bench.application.axes()[0].fault() == AxisFault::none) continue;
    ++waiting;
    ASSERT_TRUE(bench.board.parameter_flash().operations() == operations || !bench.application.any_enabled()) << k;
  }
  EXPECT_GT(waiting, 50) << "y did not stop along its ramp";
  bench.run(5);
  EXPECT_EQ(bench.board.parameter_flash().operations(), operations + 2 * 8);
  const firmware::LoggedFault y = this->read(bench, 0).entry, x = this->read(bench, 1).entry;
  for (const firmware::LoggedFault& entry : {x, y})
    EXPECT_EQ(entry.fault, static_cast<std::uint8_t>(AxisFault::host_heartbeat_lost));
  EXPECT_EQ(x.activity, static_cast<std::uint8_t>(AxisActivity::disabled));
  EXPECT_EQ(y.activity, static_cast<std::uint8_t>(AxisActivity::moving));
  EXPECT_EQ(y.axis, 1);
}

TYPED_TEST(FaultLogOnBoard, CountsTheTimeThatTheBoardRuns) {
  typename TestFixture::Bench bench;
  bench.run(725'000);
  typename TestFixture::Bench again(&bench.board.parameter_flash());
  again.run(10'000);
  EXPECT_EQ(this->read(again, 0, Status::no_such_row).run_s, 730u) << "720 s were written, 10 s followed";
}

}  // namespace
