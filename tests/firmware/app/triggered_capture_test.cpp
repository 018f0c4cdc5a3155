// Captures in the board's memory: the sample of the event, the rows before it, and their survival of a reset.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::Channel;
using firmware::MessageType;
using firmware::Status;
using firmware::TriggerKind;
using firmware::TriggerPhase;

constexpr std::uint16_t bit(Channel channel) {
  return static_cast<std::uint16_t>(1u << static_cast<unsigned>(channel));
}

class TriggeredCapture : public testing::Test {
 protected:
  TriggeredCapture() {
    bench.fit_and_enable_x();
    request.every = 1;
    request.channels[0] = bit(Channel::counts) | bit(Channel::reference_velocity);
    request.wide[0] = bit(Channel::reference_velocity);
    request.before = 50;
    request.after = 100;
  }

  Status arm() { return bench.ask(MessageType::arm_trigger, request).status; }
  firmware::TriggerStatePayload state() {
    firmware::TriggerStatePayload payload;
    EXPECT_TRUE(bench.ask(MessageType::trigger_state).get(payload));
    return payload;
  }
  /// A row a vector, in half words.
  std::vector<std::vector<std::uint16_t>> rows() {
    const firmware::TriggerStatePayload seen = state();
    std::vector<std::uint16_t> all;
    firmware::TriggeredPayload part;
    while (
        bench.ask(MessageType::read_triggered, firmware::ReadTriggeredRequest{static_cast<std::uint32_t>(all.size())})
            .get(part))
      all.insert(all.end(), part.half_word.begin(), part.half_word.end());
    EXPECT_GE(all.size(), seen.rows * seen.half_words);
    std::vector<std::vector<std::uint16_t>> result;
    for (std::size_t row = 0; row < seen.rows; ++row)
      result.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(row * seen.half_words),
                          all.begin() + static_cast<std::ptrdiff_t>((row + 1) * seen.half_words));
    return result;
  }
  /// Runs and records the axis's counts in every period.
  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      bench.run(1);
      counts.push_back(bench.application.axes()[0].telemetry().encoder_counts);
      moves.push_back(bench.application.axes()[0].telemetry().reference_velocity != 0.0F);
      if (k % 20 == 0) bench.ask(MessageType::heartbeat);
    }
  }
  firmware_test::BoardOnABench<float> bench;
  firmware::TriggerRequest request{};
  std::vector<std::int64_t> counts;
  std::vector<bool> moves;
};

/// Catches a trigger that is found a sample late, rows in the wrong order after the ring has gone round, and a row
/// lost.
TEST_F(TriggeredCapture, TheTriggersRowIsTheFirstSampleBeyondTheLevel) {
  request.kind = static_cast<std::uint8_t>(TriggerKind::edge);
  request.channel = static_cast<std::uint8_t>(Channel::counts);
  request.level = 5000;
  ASSERT_EQ(arm(), Status::ok);
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 40.0F}).status, Status::ok);
  run(3500);
  const auto first = static_cast<std::size_t>(
      std::ranges::find_if(counts, [](std::int64_t count) { return count > 5000; }) - counts.begin());
  ASSERT_LT(first, counts.size());
  const firmware::TriggerStatePayload seen = state();
  ASSERT_EQ(seen.phase, static_cast<std::uint8_t>(TriggerPhase::complete));
  EXPECT_EQ(seen.rows, 150u);
  EXPECT_EQ(seen.trigger_row, 50u);
  EXPECT_EQ(seen.counts_low, static_cast<std::uint32_t>(counts[first]));
  const auto captured = rows();
  for (std::size_t row = 0; row < captured.size(); ++row)
    ASSERT_EQ(captured[row][0], static_cast<std::uint16_t>(counts[first - 50 + row])) << row;
}

TEST_F(TriggeredCapture, MotionBeginsWithTheFirstSampleOfTheReferenceThatMoves) {
  request.kind = static_cast<std::uint8_t>(TriggerKind::motion);
  ASSERT_EQ(arm(), Status::ok);
  run(100);
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 40.0F}).status, Status::ok);
  run(300);
  const auto captured = rows();
  ASSERT_EQ(captured.size(), 150u);
  const auto velocity = [&](std::size_t row) {
    const std::uint32_t word = captured[row][1] | static_cast<std::uint32_t>(captured[row][2]) << 16;
    return std::bit_cast<float>(word);
  };
  EXPECT_EQ(velocity(49), 0.0F);
  EXPECT_GT(velocity(50), 0.0F);
}

TEST_F(TriggeredCapture, AFaultIsCaughtOnWhateverAxisAndOnlyANewOne) {
  request.kind = static_cast<std::uint8_t>(TriggerKind::fault);
  request.axis = firmware::kAnyAxis;
  request.channels[0] |= bit(Channel::flags);
  ASSERT_EQ(arm(), Status::ok);
  run(200);
  EXPECT_EQ(state().phase, static_cast<std::uint8_t>(TriggerPhase::waiting));
  bench.board.emergency_stop().press();
  run(200);
  const auto captured = rows();
  ASSERT_EQ(captured.size(), 150u);
  EXPECT_EQ(captured[49].back() >> 8, 0);
  EXPECT_EQ(captured[50].back() >> 8, static_cast<int>(firmware::AxisFault::emergency_stop));
  ASSERT_EQ(arm(), Status::ok);
  run(200);
  EXPECT_EQ(state().phase, static_cast<std::uint8_t>(TriggerPhase::waiting)) << "the old fault is no event";
}

TEST_F(TriggeredCapture, HoldoffLetsTheFirstPassagesGoBy) {
  request.kind = static_cast<std::uint8_t>(TriggerKind::level);
  request.channel = static_cast<std::uint8_t>(Channel::counts);
  request.level = static_cast<std::uint32_t>(-100);
  request.holdoff = 300;
  request.before = 0;
  ASSERT_EQ(arm(), Status::ok);
  run(300);
  EXPECT_EQ(state().phase, static_cast<std::uint8_t>(TriggerPhase::waiting));
  run(2);
  EXPECT_EQ(state().phase, static_cast<std::uint8_t>(TriggerPhase::recording));
}

/// 100 ms at 20 kHz are 2,000 rows.
TEST_F(TriggeredCapture, FourChannelsOfTwoThousandSamplesFitWithoutLoss) {
  request = {};
  request.every = 1;
  request.channels[0] =
      bit(Channel::dac_code) | bit(Channel::counts) | bit(Channel::tachometer_velocity) | bit(Channel::reference);
  request.after = 2000;
  ASSERT_EQ(arm(), Status::ok);
  ASSERT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 60.0F}).status, Status::ok);
  run(2000);
  const auto captured = rows();
  ASSERT_EQ(captured.size(), 2000u);
  for (std::size_t row = 0; row < captured.size(); ++row)
    ASSERT_EQ(captured[row][1], static_cast<std::uint16_t>(counts[row])) << row;
  request.before = 1;
  EXPECT_EQ(arm(), Status::malformed) << "more than there is room for";
}

/// A board that keeps its memory over a reset can return the last capture afterwards.
TEST(TriggeredMemory, OutlivesAResetIfItIsSoundAndTheTriggerHadCome) {
  auto memory = std::make_unique<firmware::TriggeredMemory>();
  firmware::TriggerRequest request{};
  request.every = 1;
  request.channels[0] = bit(Channel::counts);
  request.kind = static_cast<std::uint8_t>(TriggerKind::fault);
  request.before = 20;
  request.after = 10;
  firmware_test::BoardOnABench<float> bench;
  bench.fit_and_enable_x();
  firmware::TriggeredCapture capture;
  capture.adopt(*memory);
  EXPECT_EQ(capture.state().survived, 0) << "there was nothing";
  capture.arm(request);
  const auto run = [&](int periods) {
    for (int k = 0; k < periods; ++k) {
      bench.run(1);
      if (capture.is_running()) capture.take(bench.application.axes());
    }
  };
  run(100);
  firmware::TriggeredCapture waiting;
  auto copy = std::make_unique<firmware::TriggeredMemory>(*memory);
  waiting.adopt(*copy);
  EXPECT_EQ(waiting.state().survived, 0) << "no trigger yet";
  bench.board.emergency_stop().press();
  run(4);
  firmware::TriggeredCapture after_reset;
  *copy = *memory;
  after_reset.adopt(*copy);
  const firmware::TriggerStatePayload seen = after_reset.state();
  EXPECT_EQ(seen.survived, 1);
  EXPECT_EQ(seen.trigger_row, 20u);
  EXPECT_GT(seen.rows, 20u);
  EXPECT_LT(seen.rows, 30u) << "only the rows recorded so far";
  firmware::TriggeredPayload part;
  EXPECT_TRUE(after_reset.read(0, part));
  *copy = *memory;
  copy->request.every = 7;
  firmware::TriggeredCapture damaged;
  damaged.adopt(*copy);
  EXPECT_EQ(damaged.state().survived, 0);
}

}  // namespace
