// Processor in the loop: the image in the emulator against the core built for this computer, bit for bit.
#include <gtest/gtest.h>

#include "tests/target/pil/links.hpp"

namespace {

using target_test::FileLink;
using target_test::first_difference;
using target_test::hash;
using target_test::obstacle;
using target_test::Replies;
using target_test::run_on_host;
using target_test::run_over;
using target_test::SerialLink;

template <typename Scalar>
void expect_equal_over_files(const std::string& image_name) {
  const std::string why = obstacle(image_name);
  if (!why.empty()) GTEST_SKIP() << why;
  const Replies expected = run_on_host<Scalar>();
  for (int repetition = 0; repetition < 3; ++repetition) {
    FileLink link(image_name);
    const Replies seen = run_over<Scalar>(link);
    EXPECT_EQ(first_difference(expected, seen), "");
    EXPECT_EQ(hash(seen), hash(expected));
    EXPECT_EQ(link.finish(), 0);
  }
}

template <typename Scalar>
class PilScenario : public testing::Test {};
using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(PilScenario, Scalars);

TYPED_TEST(PilScenario, MovesBothAxesFarWithoutFaultOrRefusal) {
  const Replies replies = run_on_host<TypeParam>();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::int64_t least = 0, most = 0;
    std::uint32_t enabled = 0;
    for (const auto& reply : replies) {
      const auto counts = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(reply.axis[axis].encoder_counts));
      least = std::min(least, counts);
      most = std::max(most, counts);
      enabled += reply.axis[axis].outputs & 1u;
      EXPECT_EQ((reply.axis[axis].flags >> 8) & 0xFFu, 0u) << "a fault in period " << reply.number;
      EXPECT_EQ(reply.axis[axis].flags & 1u, 0u) << "axis " << axis << " refuses the order of period " << reply.number;
    }
    EXPECT_GT(most - least, 40'000) << "encoder counts travelled by axis " << axis;
    EXPECT_GT(enabled, 8'000u);
  }
}

std::uint32_t fault_of(const firmware::boards::PilReply& reply, std::size_t axis) {
  return (reply.axis[axis].flags >> 8) & 0xFFu;
}

TYPED_TEST(PilScenario, FaultsOfTheFaultStoryAreNamedAndStopBothAxes) {
  const auto& story = target_test::fault_story();
  const Replies replies = run_on_host<TypeParam>(story.periods, story);
  using firmware::AxisFault;
  const auto expect = [&](std::uint32_t period, AxisFault x, AxisFault y) {
    EXPECT_EQ(fault_of(replies[period], 0), static_cast<std::uint32_t>(x)) << period;
    EXPECT_EQ(fault_of(replies[period], 1), static_cast<std::uint32_t>(y)) << period;
    for (const auto& axis : replies[period].axis) {
      EXPECT_EQ(axis.outputs, 0u) << period;
      EXPECT_EQ(axis.dac_code, 0) << period;
    }
  };
  expect(590, AxisFault::limit_switch_positive, AxisFault::other_axis_stopped);
  expect(1'290, AxisFault::control_overrun, AxisFault::control_overrun);
  expect(2'090, AxisFault::other_axis_stopped, AxisFault::drive_fault);
  expect(2'690, AxisFault::emergency_stop, AxisFault::emergency_stop);
  expect(3'290, AxisFault::other_axis_stopped, AxisFault::amplifier_not_ready);
}

/// Edges of y's outputs, each with its period, in their order.
std::vector<std::pair<std::uint32_t, firmware::boards::OutputEdge>> edges_of_y(const Replies& replies) {
  std::vector<std::pair<std::uint32_t, firmware::boards::OutputEdge>> edges;
  for (const auto& reply : replies)
    for (int shift = 28; shift >= 4; shift -= 4)
      if (const std::uint32_t edge = reply.axis[1].outputs >> shift & 15u; edge != 0)
        edges.emplace_back(reply.number, static_cast<firmware::boards::OutputEdge>(edge));
  return edges;
}

/// The expected edges; the image must show the same words (PilFaults).
TYPED_TEST(PilScenario, OutputsChangeInTheOrderOfEnablingAndOfEachStop) {
  using enum firmware::boards::OutputEdge;
  const auto& story = target_test::fault_story();
  const auto edges = edges_of_y(run_on_host<TypeParam>(story.periods, story));
  const firmware::boards::OutputEdge expected[] = {enable_on, brake_released, brake_applied, enable_off};
  ASSERT_EQ(edges.size(), 20u) << "five starts, five stops";
  for (std::size_t i = 0; i < edges.size(); ++i) EXPECT_EQ(edges[i].second, expected[i % 4]) << i;
  for (std::size_t i = 0; i < edges.size(); i += 4) EXPECT_GE(edges[i + 1].first, edges[i].first + 1) << i;
  EXPECT_EQ(edges[3].first, edges[2].first + 4) << "after a ramp the brake holds before the enable drops";
  for (const std::size_t drop : {10u, 14u, 18u}) EXPECT_EQ(edges[drop + 1].first, edges[drop].first) << drop;
}

template <typename Scalar>
void expect_equal_faults(const std::string& image_name) {
  const std::string why = obstacle(image_name);
  if (!why.empty()) GTEST_SKIP() << why;
  const auto& story = target_test::fault_story();
  FileLink link(image_name);
  const Replies seen = run_over<Scalar>(link, story.periods, story);
  EXPECT_EQ(first_difference(run_on_host<Scalar>(story.periods, story), seen), "");
  EXPECT_EQ(link.finish(), 0);
}

TEST(PilFaults, FloatEqualsTheHostBitForBit) { expect_equal_faults<float>("qemu-f405"); }
TEST(PilFaults, FixedPointEqualsTheHostBitForBit) { expect_equal_faults<firmware::FixedPoint>("qemu-f405-fixed"); }

TEST(PilComparison, AChangedBitIsFound) {
  const Replies expected = run_on_host<float>();
  Replies seen = expected;
  seen[7'777].axis[1].velocity ^= 1u;
  EXPECT_NE(first_difference(expected, seen).find("period 7777"), std::string::npos);
  EXPECT_NE(hash(seen), hash(expected));
}

TEST(Pil, FloatEqualsTheHostBitForBit) { expect_equal_over_files<float>("qemu-f405"); }

TEST(Pil, FixedPointEqualsTheHostBitForBit) { expect_equal_over_files<firmware::FixedPoint>("qemu-f405-fixed"); }

TEST(Pil, FixedPointForCortexM3EqualsTheHostBitForBit) {
  expect_equal_over_files<firmware::FixedPoint>("qemu-f405-fixed-m3");
}

TEST(Pil, FixedPointForCortexM0PlusEqualsTheHostBitForBit) {
  expect_equal_over_files<firmware::FixedPoint>("qemu-f405-fixed-m0plus");
}

TEST(Pil, TheSerialLineEqualsTheHostAndSurvivesNoise) {
  const std::string why = obstacle("qemu-f405");
  if (!why.empty()) GTEST_SKIP() << why;
  SerialLink link("qemu-f405");
  const std::array<std::byte, 5> noise{std::byte{0xA5}, std::byte{0x5A}, std::byte{0x00}, std::byte{0x00},
                                       std::byte{0xA5}};
  link.send_noise(noise);               // begins like an empty frame, which then fails its CRC
  constexpr std::uint32_t kSome = 500;  // `make pil` runs all of them; the emulated port takes some ms a period
  EXPECT_EQ(first_difference(run_on_host<float>(kSome), run_over<float>(link, kSome)), "");
  EXPECT_EQ(link.finish(), 2) << "the board reports that it rejected a frame";
}

}  // namespace
