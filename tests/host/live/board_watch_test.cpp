// Watching and commanding a simulated board through its socket.
#include "host/live/board_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "firmware/core/supervision/fault_table.hpp"
#include "host/device/board_report.hpp"
#include "host/device/capture_wish.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/live/board_command.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/host/board_at_a_socket.hpp"
#include "tests/wait_until.hpp"

namespace {

using host::BoardPicture;
using host::BoardWatch;
using host::WatchedTrigger;

host::OpenBoard opener(const BoardAtASocket& board) {
  return [&board] { return board.client(); };
}

/// Whether the state of x is this one.
bool is_x(const BoardWatch& watch, const std::string& state) {
  return host::state_text(watch.picture().status.axis.at(0)) == state;
}

TEST(BoardWatch, StreamsEveryRowOnceAndBeginsAnewWithOtherChannels) {
  const BoardAtASocket board(firmware_test::paper_values());
  BoardWatch watch(opener(board));
  ASSERT_TRUE(wait_until([&] { return watch.picture().end > 1500; }));
  const BoardPicture first = watch.picture();
  EXPECT_EQ(first.lost, 0U);
  EXPECT_EQ(first.repeated, 0U);
  EXPECT_EQ(first.channels.size(), 8U);
  EXPECT_EQ(first.row_period_s, 1e-3);
  const auto envelope = watch.envelope(first.epoch, 0, 1000, 100);
  ASSERT_TRUE(envelope);
  EXPECT_EQ(envelope->taken, std::vector<std::size_t>(10, 100));

  watch.choose(host::watched_channels({"x.x_mm", "x.u_V"}, first.kinds));
  ASSERT_TRUE(wait_until([&] { return watch.picture().epoch > first.epoch && watch.picture().end > 100; }));
  const BoardPicture second = watch.picture();
  EXPECT_EQ(second.channels,
            (std::vector<host::WatchedChannel>{{0, firmware::Channel::dac_code}, {0, firmware::Channel::counts}}));
  EXPECT_EQ(second.lost, 0U);
  EXPECT_FALSE(watch.envelope(first.epoch, 0, 1000, 100)) << "of the earlier stream nothing is left";
  host::CaptureSettings settings;
  EXPECT_THROW(watch.rows(first.epoch, 0, 0, 1000, settings), host::Failure);
  const host::Capture rows = watch.rows(second.epoch, 0, 10, 60, settings);
  EXPECT_EQ(rows.number.size(), 50U);
  EXPECT_EQ(settings.channels, (std::vector{firmware::Channel::dac_code, firmware::Channel::counts}));
  EXPECT_THROW(watch.rows(second.epoch, 1, 10, 60, settings), host::Failure) << "no channel of this axis";
}

TEST(BoardWatch, EndsItsStreamForAnotherProgramThatCaptures) {
  const BoardAtASocket board(firmware_test::paper_values());
  BoardWatch watch(opener(board));
  ASSERT_TRUE(wait_until([&] { return watch.picture().end > 10; }));
  host::BoardClient other = board.client();
  firmware::CaptureRequest request;
  request.channels[0] = 1;
  other.take_capture(request);
  EXPECT_FALSE(host::is_capture_wished(other.name())) << "it has it";
  EXPECT_TRUE(wait_until([&] { return !watch.picture().message.empty(); })) << "the reason is told";
  other.stop_capture();
  EXPECT_TRUE(wait_until([&] { return watch.picture().epoch > 1 && watch.picture().end > 10; }));
}

TEST(BoardWatch, ALentBoardCapturesForAnotherProgramAndStreamsAgainAfterwards) {
  const BoardAtASocket board(firmware_test::paper_values());
  BoardWatch watch(opener(board));
  ASSERT_TRUE(wait_until([&] { return watch.picture().end > 10; }));
  const std::uint64_t first = watch.picture().epoch;
  host::BoardClient other = board.client();
  firmware::CaptureRequest request;
  request.channels[0] = 1;
  EXPECT_THROW(other.start_capture(request), host::Failure) << "a board runs one capture at a time";
  watch.lend("lent");
  other.start_capture(request);
  EXPECT_EQ(watch.picture().message, "lent");
  EXPECT_THROW(watch.arm({}, {}), host::Failure);
  other.stop_capture();
  EXPECT_EQ(watch.picture().epoch, first);
  watch.give_back();
  EXPECT_TRUE(wait_until([&] { return watch.picture().epoch > first && watch.picture().end > 10; }));
}

TEST(BoardWatch, NamesUnitsAndRefusesWhatIsNoSetOfChannels) {
  const std::vector<sim::DriveKind> kinds{sim::DriveKind::rotary, sim::DriveKind::linear};
  const auto names = [&](const std::vector<std::string>& wanted) {
    std::vector<std::string> told;
    for (const host::WatchedChannel& one : host::watched_channels(wanted, kinds))
      told.push_back(host::name_of(one, kinds) + " " + host::unit_of(one, kinds));
    return told;
  };
  EXPECT_EQ(names({"y.v_m_s", "x.w_hat_rad_s", "y.x_err_m"}),
            (std::vector<std::string>{"x.w_hat_rad_s rad/s", "y.v_m_s m/s", "y.x_err_m m"}));
  EXPECT_THROW(names({}), host::Failure);
  EXPECT_THROW(names({"x.u_V", "x.u_V"}), host::Failure);
  EXPECT_THROW(names({"z.u_V"}), host::Failure);
  EXPECT_THROW(names({"x.x_m"}), host::Failure);
  std::vector<std::string> many;
  for (const host::WatchedChannel& one : host::all_channels(2)) many.push_back(host::name_of(one, kinds));
  EXPECT_THROW(names(many), host::Failure) << "more than a row holds";
}

TEST(BoardWatch, TheBoardsTriggerKeepsWhatCameBeforeIt) {
  const BoardAtASocket board(firmware_test::paper_values());
  BoardWatch watch(opener(board));
  host::TriggeredSettings settings;
  settings.capture.channels = {firmware::Channel::dac_code, firmware::Channel::counts};
  settings.capture.before_s = 0.1;
  settings.capture.duration_s = 0.2;
  settings.trigger = host::parse_board_trigger("x.motion", sim::DriveKind::rotary);
  std::size_t rows = 0;
  watch.arm(settings, [&](const host::Capture& capture, const host::CaptureSettings&) {
    rows = capture.number.size();
    return "kept.csv";
  });
  EXPECT_THROW(watch.arm(settings, {}), host::Failure) << "one at a time";
  {
    host::BoardClient mover = board.client();
    host::enable_and_wait(mover, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));  // so that the time before the trigger is recorded
    const auto end = watch.picture().end;
    host::jog_for(mover, 0, 5.0, std::chrono::milliseconds(400), [] { return false; });
    EXPECT_GT(watch.picture().end, end + 200) << "the stream goes on meanwhile";
    host::disable_and_wait(mover, 1);
  }
  ASSERT_TRUE(wait_until([&] { return watch.picture().trigger.phase == WatchedTrigger::Phase::done; }));
  EXPECT_EQ(watch.picture().trigger.text, "kept.csv");
  EXPECT_EQ(rows, 300U);

  watch.arm(settings, {});
  watch.disarm();
  EXPECT_TRUE(wait_until([&] { return watch.picture().trigger.phase == WatchedTrigger::Phase::idle; }));
  EXPECT_EQ(watch.picture().lost, 0U);
}

TEST(BoardWatch, SaysThatTheBoardHasGoneAndComesBackWithIt) {
  auto board = std::make_unique<BoardAtASocket>();
  std::atomic<BoardAtASocket*> present = board.get();
  BoardWatch watch([&] {
    if (present == nullptr) throw host::Failure(host::ExitCode::no_such_device, "no board");
    return present.load()->client();
  });
  const std::uint64_t epoch = watch.picture().epoch;
  present = nullptr;
  board.reset();
  ASSERT_TRUE(wait_until([&] { return !watch.picture().is_connected; }));
  EXPECT_FALSE(watch.picture().message.empty());
  board = std::make_unique<BoardAtASocket>();
  present = board.get();
  EXPECT_TRUE(wait_until([&] { return watch.picture().is_connected && watch.picture().end > 100; }));
  EXPECT_GT(watch.picture().epoch, epoch);
}

class CommandedBoard : public testing::Test {
 protected:
  void enable_and_jog() {
    ASSERT_TRUE(wait_until([&] { return is_x(watch_, "ready"); }));
    command_.take();
    command_.with([](host::BoardClient& client) { client.enable_at_rest(1); });
    ASSERT_TRUE(wait_until([&] { return is_x(watch_, "enabled"); }));
    command_.with([](host::BoardClient& client) { client.jog(0, 5.0); });
    ASSERT_TRUE(wait_until([&] { return at() > 100; }));
  }
  std::int64_t at() const { return watch_.picture().status.axis.at(0).counts(); }
  std::uint8_t fault() const { return watch_.picture().status.axis.at(0).fault; }

  const BoardAtASocket board_{firmware_test::paper_values()};
  BoardWatch watch_{opener(board_)};
  std::atomic<bool> is_there_ = true;
  host::BoardCommand command_{opener(board_), [this] { return is_there_.load(); }};
};

TEST_F(CommandedBoard, MovesWhileSomebodyIsThereAndIsStoppedByItsMonitorOtherwise) {
  enable_and_jog();
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // three times host.timeout
  EXPECT_TRUE(is_x(watch_, "enabled")) << "heart-beats go out without further commands";
  is_there_ = false;
  constexpr auto kLost = static_cast<std::uint8_t>(firmware::AxisFault::host_heartbeat_lost);
  EXPECT_TRUE(wait_until([&] { return fault() == kLost; }));
  is_there_ = true;  // too late
  EXPECT_THROW(command_.with([](host::BoardClient& client) { client.heartbeat(); }), host::Failure);
}

TEST_F(CommandedBoard, StopsByTheRampAndForgetsWhatComesAfterwards) {
  enable_and_jog();
  command_.stop();
  EXPECT_THROW(command_.with([](host::BoardClient& client) { client.jog(0, 5.0); }), host::Failure);
  EXPECT_TRUE(wait_until([&] { return is_x(watch_, "ready"); }));
  EXPECT_EQ(fault(), 0);
  EXPECT_TRUE(wait_until([&] {
    try {
      command_.take();
    } catch (const host::Failure&) {
      return false;
    }
    return true;
  })) << "once the axes are off, the command can be taken again";
}

TEST_F(CommandedBoard, StopsTheMotionOfAnotherProgram) {
  host::BoardClient other = board_.client();
  host::enable_and_wait(other, 1);
  other.jog(0, 5.0);
  command_.stop();
  EXPECT_TRUE(wait_until([&] {
    other.heartbeat();
    return is_x(watch_, "ready");
  }));
  EXPECT_EQ(fault(), 0);
}

}  // namespace
