// A touch probe on the simulated board: position of its edge, exact to a count, and motion without an edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::MessageType;
using firmware::PathEnd;
using firmware::PathPhase;
using firmware::ProbeContact;
using firmware::ProbeStop;
using firmware::Status;
using hal::pc::SimulatedSurface;

constexpr firmware::PathUnits kProbeUnits{16, 20, 26};
constexpr double kWay_mm = 30.0;

template <typename Scalar>
class Probing : public testing::Test {
 protected:
  void fit(ProbeContact contact, double homing_mode = 0) {
    firmware::ParameterValues values = firmware_test::paper_values();
    firmware_test::fit_axis(values, "y", firmware_test::kPaperY);
    firmware_test::set(values, "probe.input", static_cast<double>(contact));
    firmware_test::set(values, "x.homing.mode", homing_mode);
    firmware_test::set(values, "x.homing.velocity", 20.0);
    firmware_test::set(values, "x.homing.travel", 60.0);
    ASSERT_EQ(bench.download(values).status, Status::ok);
    run(200);
    ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{3}).status, Status::ok);
    for (std::uint8_t axis = homing_mode != 0 ? 1 : 0; axis < 2; ++axis)
      ASSERT_EQ(bench.ask(MessageType::home, firmware::HomeRequest{axis, 1}).status, Status::ok);
    run(10);
    bench.application.control_period();  // and no motion after it
    for (std::size_t axis = 0; axis < 2; ++axis) origin[axis] = counts(axis) - bench.board.plant(axis).encoder_counts();
    bench.board.advance();
  }

  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      bench.run(1);
      if (++since_heard % 20 == 0) bench.ask(MessageType::heartbeat);
    }
  }
  std::int64_t counts(std::size_t axis) { return bench.application.axes()[axis].telemetry().encoder_counts; }
  /// Reading of the axis's encoder at that position.
  std::int64_t counts_of(double travel_mm, std::size_t axis = 0) const {
    return static_cast<std::int64_t>(std::floor(travel_mm / firmware_test::kEncoderResolution_mm)) + origin[axis];
  }

  Status open(ProbeStop probe) {
    firmware::OpenPathRequest request{3, 0, kProbeUnits};
    request.probe = probe;
    return bench.ask(MessageType::open_path, request).status;
  }
  /// From rest to rest, both axes, in one polynomial; its speed in the middle is 1.875 times the mean. y goes half as
  /// far.
  Status load(double x_mm, int samples) {
    const auto travel = [&](double mm) {
      return static_cast<std::uint32_t>(std::lround(mm / firmware_test::kEncoderResolution_mm * 65536.0));
    };
    const std::array<std::uint32_t, 7> node{
        static_cast<std::uint32_t>(samples) << firmware::kPathTimeBits | firmware::kLastNode,
        travel(x_mm),
        0,
        0,
        travel(x_mm / 2),
        0,
        0};
    return bench.ask(MessageType::path_nodes, node).status;
  }
  Status start(ProbeStop probe, double x_mm, int samples) {
    const Status opened = open(probe);
    if (opened != Status::ok) return opened;
    const Status loaded = load(x_mm, samples);
    return loaded != Status::ok ? loaded : bench.ask(MessageType::start_path).status;
  }
  void follow(ProbeStop probe, double x_mm, int samples) {
    ASSERT_EQ(start(probe, x_mm, samples), Status::ok);
    for (int k = 0; k < 3000 && phase() != PathPhase::done; ++k) {
      const double before_mm = bench.board.plant(0).truth().x;
      const std::int64_t y = bench.board.plant(1).encoder_counts() + origin[1];
      run(1);
      if ((before_mm < watched_mm) == (bench.board.plant(0).truth().x < watched_mm)) continue;
      y_then = std::minmax(y, bench.board.plant(1).encoder_counts() + origin[1]);
    }
    ASSERT_EQ(phase(), PathPhase::done);
    run(20);
  }

  firmware::PathStatePayload path() {
    firmware::PathStatePayload state;
    EXPECT_TRUE(bench.ask(MessageType::path_state).get(state));
    return state;
  }
  PathPhase phase() { return static_cast<PathPhase>(path().phase); }
  PathEnd end() { return static_cast<PathEnd>(path().end); }
  firmware::ProbeStatePayload probe() {
    firmware::ProbeStatePayload state;
    EXPECT_TRUE(bench.ask(MessageType::probe_state).get(state));
    return state;
  }
  bool has_met() { return (probe().flags & firmware::kProbeMet) != 0; }
  std::int64_t met_at(std::size_t axis) {
    const auto at = probe().axis[axis];
    EXPECT_NE(probe().flags & firmware::kProbeLatched, 0);
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(static_cast<std::uint32_t>(at.counts_high)) << 32 |
                                     at.counts_low);
  }

  Status jog(double velocity, std::uint8_t axis = 0) {
    return bench.ask(MessageType::jog, firmware::JogRequest{axis, {}, static_cast<float>(velocity)}).status;
  }
  bool is_at_rest(std::size_t axis = 0) { return (bench.status().axis[axis].flags & firmware::kAxisAtRest) != 0; }
  double travel_mm() { return bench.board.plant(0).truth().x; }
  /// x stands in closed loop, beyond the surface by at most its stopping distance (as for a path, above).
  void expect_stopped_behind(double surface_mm, double speed) {
    run(600);
    EXPECT_TRUE(is_at_rest());
    EXPECT_EQ(bench.status().axis[0].state, static_cast<std::uint8_t>(firmware::SupervisorState::enabled));
    EXPECT_EQ(bench.application.axes()[0].fault(), firmware::AxisFault::none);
    EXPECT_GT(travel_mm(), surface_mm);
    EXPECT_LT(travel_mm(), surface_mm + speed * (0.13 + 0.004));
    EXPECT_EQ(probe().flags,
              firmware::kProbeWired | firmware::kProbeTouches | firmware::kProbeMet | firmware::kProbeLatched);
    EXPECT_EQ(met_at(0), counts_of(surface_mm));
  }

  firmware_test::BoardOnABench<Scalar> bench;
  std::array<std::int64_t, 2> origin{};
  double watched_mm = 1e9;                         ///< position at which x passes the surface
  std::pair<std::int64_t, std::int64_t> y_then{};  ///< range of y in that control period
  int since_heard = 0;
};

using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(Probing, Scalars);

/// Catches a position that is read when the edge is noticed: up to a control period late, 57 counts at 141 mm/s.
TYPED_TEST(Probing, IsExactToACountAtAnySpeedAndInBothDirections) {
  constexpr double kSurface_mm = 15.0017;
  for (const int samples : {1000, 600, 400})
    for (const double sign : {1.0, -1.0})
      for (const auto contact : {ProbeContact::closes, ProbeContact::opens}) {
        const double speed = 1.875 * kWay_mm / samples * 1000.0;  // where the surface is
        SCOPED_TRACE(testing::Message() << speed * sign << " mm/s, probe.input " << static_cast<int>(contact));
        std::destroy_at(&this->bench);
        std::construct_at(&this->bench);
        // An input that opens on contact is closed on this side of the surface.
        const bool is_upwards = (sign > 0.0) == (contact == ProbeContact::closes);
        this->bench.board.put_surfaces({{0, sign * kSurface_mm, is_upwards}});
        this->watched_mm = sign * kSurface_mm;
        this->fit(contact);
        this->follow(ProbeStop::contact, sign * kWay_mm, samples);
        EXPECT_EQ(this->end(), PathEnd::probed);
        ASSERT_TRUE(this->has_met());
        EXPECT_EQ(this->met_at(0), this->counts_of(sign * kSurface_mm));
        EXPECT_GE(this->met_at(1), this->y_then.first) << "y is latched with it";
        EXPECT_LE(this->met_at(1), this->y_then.second);
        EXPECT_GT(this->y_then.second - this->y_then.first, 5);
        // The stopping distance of core/path/README.md, three periods of the input filter, and the following error.
        this->run(100);
        const double beyond_mm =
            firmware_test::kEncoderResolution_mm * std::abs(static_cast<double>(this->counts(0) - this->met_at(0)));
        EXPECT_LT(beyond_mm, speed * (0.13 + 0.004)) << "stopping way";
        EXPECT_GT(beyond_mm, speed * 0.02);
      }
}

TYPED_TEST(Probing, LossOfContactIsAsExact) {
  this->bench.board.put_surfaces({{0, 14.9991, false}});
  this->fit(ProbeContact::closes);
  this->follow(ProbeStop::release, kWay_mm, 400);
  EXPECT_EQ(this->end(), PathEnd::probed);
  ASSERT_TRUE(this->has_met());
  EXPECT_EQ(this->met_at(0), this->counts_of(14.9991));
}

TYPED_TEST(Probing, WithoutContactThePathIsCompleted) {
  this->bench.board.put_surfaces({{0, kWay_mm + 0.1, true}});
  this->fit(ProbeContact::closes);
  this->follow(ProbeStop::contact, kWay_mm, 1000);
  EXPECT_EQ(this->end(), PathEnd::completed);
  EXPECT_EQ(this->probe().flags, firmware::kProbeWired);
}

TYPED_TEST(Probing, WhatIsThereAlreadyIsNotLookedFor) {
  this->bench.board.put_surfaces({{0, 10.0, false}});
  this->fit(ProbeContact::closes);
  EXPECT_EQ(this->probe().flags, firmware::kProbeWired | firmware::kProbeTouches);
  EXPECT_EQ(this->start(ProbeStop::contact, kWay_mm, 400), Status::probe_already);
  this->run(100);
  EXPECT_EQ(this->phase(), PathPhase::open);
  EXPECT_NEAR(static_cast<double>(this->counts(0)), static_cast<double>(this->counts_of(0.0)), 2.0) << "nothing moved";
  this->follow(ProbeStop::release, kWay_mm, 400);
  EXPECT_TRUE(this->has_met());
  EXPECT_EQ(this->start(ProbeStop::release, -1.0, 400), Status::probe_already);
}

TYPED_TEST(Probing, NeedsAProbe) {
  this->fit(ProbeContact::none);
  EXPECT_EQ(this->open(ProbeStop::contact), Status::no_probe);
  EXPECT_EQ(this->open(ProbeStop::release), Status::no_probe);
  EXPECT_EQ(this->open(static_cast<ProbeStop>(3)), Status::malformed);
  EXPECT_EQ(this->probe().flags, 0);
  EXPECT_EQ(this->open(ProbeStop::none), Status::ok);
}

/// The first edge is where the probe touched; the contact then opens and closes again for a while.
TYPED_TEST(Probing, ABouncingContactIsItsFirstEdge) {
  this->fit(ProbeContact::closes);
  ASSERT_EQ(this->start(ProbeStop::contact, kWay_mm, 1000), Status::ok);
  this->run(400);
  const std::array<std::int64_t, 2> here{this->bench.board.plant(0).encoder_counts() + this->origin[0],
                                         this->bench.board.plant(1).encoder_counts() + this->origin[1]};
  for (const bool closed : {true, false, true, false, true}) {
    this->bench.board.touch(closed);
    this->run(1);
  }
  this->run(500);
  EXPECT_EQ(this->end(), PathEnd::probed);
  EXPECT_EQ(this->met_at(0), here[0]);
  EXPECT_EQ(this->met_at(1), here[1]);
}

TYPED_TEST(Probing, ASparkIsForgotten) {
  this->bench.board.put_surfaces({{0, 20.0009, true}});
  this->fit(ProbeContact::closes);
  ASSERT_EQ(this->start(ProbeStop::contact, kWay_mm, 1000), Status::ok);
  this->run(300);
  this->bench.board.touch(true);
  this->bench.board.touch(false);
  ASSERT_TRUE(this->bench.board.probe().has_latched());
  this->run(20);
  EXPECT_EQ(this->phase(), PathPhase::running);
  this->run(1200);
  EXPECT_EQ(this->end(), PathEnd::probed);
  EXPECT_EQ(this->met_at(0), this->counts_of(20.0009));
}

/// The path ends before the input has been filtered.
TYPED_TEST(Probing, AContactInTheLastPeriodCounts) {
  this->fit(ProbeContact::closes);
  ASSERT_EQ(this->start(ProbeStop::contact, kWay_mm, 1000), Status::ok);
  this->run(999);
  ASSERT_EQ(this->phase(), PathPhase::running);
  this->bench.board.touch(true);
  while (this->phase() != PathPhase::done) this->run(1);
  EXPECT_EQ(this->end(), PathEnd::completed);
  EXPECT_TRUE(this->has_met());
}

/// A probe that makes contact stops the path; one that loses contact does not.
TYPED_TEST(Probing, AContactOnAnyOtherPathStopsIt) {
  this->bench.board.put_surfaces({{0, 10.0, false}, {0, 25.0, true}});
  this->fit(ProbeContact::closes);
  this->follow(ProbeStop::none, 20.0, 1000);
  EXPECT_EQ(this->end(), PathEnd::completed) << "away from a surface";
  this->follow(ProbeStop::none, kWay_mm, 1000);
  EXPECT_EQ(this->end(), PathEnd::touched);
  this->run(100);
  EXPECT_LT(this->counts(0), this->counts_of(20.0 + kWay_mm - 5.0));
  EXPECT_EQ(this->bench.application.axes()[0].fault(), firmware::AxisFault::none);
}

TYPED_TEST(Probing, AContactStopsAJog) {
  this->bench.board.put_surfaces({{0, 25.0, true}});
  this->fit(ProbeContact::closes);
  ASSERT_EQ(this->jog(50.0), Status::ok);
  this->run(100);
  EXPECT_EQ(this->jog(60.0), Status::ok) << "faster on the way";
  EXPECT_EQ(this->jog(5.0, 1), Status::ok);
  while (this->travel_mm() < 25.0) this->run(1);
  EXPECT_EQ(this->jog(60.0), Status::ok) << "it may be a noise spike";
  this->run(10);
  ASSERT_FALSE(this->is_at_rest());
  EXPECT_EQ(this->jog(60.0), Status::wrong_state) << "it slows down";
  EXPECT_EQ(this->jog(5.0, 1), Status::wrong_state) << "and so does the machine";
  this->expect_stopped_behind(25.0, 60.0);
  EXPECT_TRUE(this->is_at_rest(1));
}

/// Moves away from the surface, and against it again.
TYPED_TEST(Probing, AJogLeavesWhatTheProbeTouches) {
  this->bench.board.put_surfaces({{0, 10.0, true}});
  this->fit(ProbeContact::closes);
  for (int time = 0; time < 2; ++time) {
    ASSERT_EQ(this->jog(40.0), Status::ok);
    this->expect_stopped_behind(10.0, 40.0);
    ASSERT_EQ(this->jog(-40.0), Status::ok);
    this->run(400);
    EXPECT_LT(this->travel_mm(), 5.0);
    EXPECT_FALSE(this->is_at_rest());
    EXPECT_FALSE(this->has_met());
    ASSERT_EQ(this->bench.ask(MessageType::stop).status, Status::ok);
    this->run(600);
  }
}

TYPED_TEST(Probing, AContactStopsAMove) {
  this->bench.board.put_surfaces({{0, 25.0, true}});
  this->fit(ProbeContact::closes);
  const std::int64_t target = this->counts(0) + static_cast<std::int64_t>(80.0 / firmware_test::kEncoderResolution_mm);
  ASSERT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::to(0, target)).status, Status::ok);
  this->expect_stopped_behind(25.0, 250.0);
  EXPECT_LT(this->travel_mm(), 70.0);
}

TYPED_TEST(Probing, AContactStopsHomingAndThereIsNoHome) {
  this->bench.board.put_surfaces({{0, 3.0, true}});  // the home switch acts from 5 mm on
  this->fit(ProbeContact::closes, 1);
  ASSERT_EQ(this->bench.ask(MessageType::home, firmware::HomeRequest{0, 0}).status, Status::ok);
  this->expect_stopped_behind(3.0, 20.0);
  EXPECT_EQ(this->bench.status().axis[0].flags & (firmware::kAxisHomed | firmware::kAxisHoming), 0);
}

/// The monitoring for the path must not end the jog.
TYPED_TEST(Probing, AJogIsWatchedOnOnceAProbingPathOfAnotherAxisHasEnded) {
  this->bench.board.put_surfaces({{0, 40.0, true}});
  this->fit(ProbeContact::closes);
  ASSERT_EQ(this->jog(20.0), Status::ok);
  firmware::OpenPathRequest request{2, 0, kProbeUnits};
  request.probe = ProbeStop::contact;
  ASSERT_EQ(this->bench.ask(MessageType::open_path, request).status, Status::ok);
  const std::array<std::uint32_t, 4> node{200u << firmware::kPathTimeBits | firmware::kLastNode, 65536, 0, 0};
  ASSERT_EQ(this->bench.ask(MessageType::path_nodes, node).status, Status::ok);
  ASSERT_EQ(this->bench.ask(MessageType::start_path).status, Status::ok);
  this->run(300);
  EXPECT_EQ(this->end(), PathEnd::completed);
  ASSERT_EQ(this->phase(), PathPhase::done);
  while (this->travel_mm() < 40.0) this->run(1);
  this->expect_stopped_behind(40.0, 20.0);
}

TYPED_TEST(Probing, WithoutAProbeNothingStopsAJog) {
  this->bench.board.put_surfaces({{0, 10.0, true}});
  this->fit(ProbeContact::none);
  ASSERT_EQ(this->jog(40.0), Status::ok);
  this->run(800);
  EXPECT_FALSE(this->is_at_rest());
  EXPECT_GT(this->travel_mm(), 20.0);
}

/// A probe whose edge reaches no timer also stops the path, but no position is reported.
TYPED_TEST(Probing, AnEdgeThatWasNotLatchedGivesNoPosition) {
  this->fit(ProbeContact::closes);
  ASSERT_EQ(this->start(ProbeStop::contact, kWay_mm, 1000), Status::ok);
  this->run(400);
  this->bench.board.touch(true);  // a noise spike, which the encoders have latched
  this->bench.board.touch(false);
  this->run(20);
  this->bench.board.probe().arm(false);
  this->bench.board.touch(true);
  this->run(500);
  EXPECT_EQ(this->end(), PathEnd::probed);
  EXPECT_EQ(this->probe().flags, firmware::kProbeWired | firmware::kProbeTouches | firmware::kProbeMet);
}

}  // namespace
