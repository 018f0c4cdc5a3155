// Paths on the simulated board, requested by reports: both number types, a host that ends, nodes that do not arrive.
#include <gtest/gtest.h>

#include "tests/firmware/app/board_on_a_bench.hpp"
#include "tests/firmware/circle_in_counts.hpp"

namespace {

using firmware::AxisFault;
using firmware::MessageType;
using firmware::PathEnd;
using firmware::PathPhase;
using firmware::Status;
using firmware::SupervisorState;

constexpr firmware::PathUnits kPathUnits{16, 24, 32};
constexpr double kPiece = 10.0;  ///< samples

template <typename Scalar>
class PathOnBoard : public testing::Test {
 protected:
  using Bench = firmware_test::BoardOnABench<Scalar>;

  PathOnBoard() {
    firmware::ParameterValues values = firmware_test::paper_values();
    firmware_test::fit_axis(values, "y", firmware_test::kPaperY);
    firmware_test::set(values, "x.monitor.travel_max", 300);
    EXPECT_EQ(bench.download(values).status, Status::ok);
    bench.run(200);
    EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{3}).status, Status::ok);
    for (std::uint8_t axis = 0; axis < 2; ++axis)
      EXPECT_EQ(bench.ask(MessageType::home, firmware::HomeRequest{axis, 1}).status, Status::ok);
    bench.run(5);
  }

  Status open(bool relative = false) {
    const firmware::OpenPathRequest request{3, static_cast<std::uint8_t>(relative ? 1 : 0), kPathUnits};
    const firmware::Message reply = bench.ask(MessageType::open_path, request);
    if (reply.status != Status::ok) return reply.status;
    EXPECT_TRUE(reply.get(opened));
    begin = {static_cast<double>(bench.application.axes()[0].leading().counts),
             static_cast<double>(bench.application.axes()[1].leading().counts)};
    given = {};
    sent = 0;
    return reply.status;
  }

  int pieces() const { return static_cast<int>(circle.samples / kPiece); }

  Status send_next() {
    const bool last = sent + 1 == pieces();
    std::array<std::int64_t, 2> then = given;
    const auto node = circle.node(kPiece * (sent + 1), kPiece, kPathUnits, last, then);
    firmware::Message request;
    request.type = MessageType::path_nodes;
    const std::uint32_t headrooms = headroom << firmware::kHeadroomHereShift | headroom
                                                                                   << firmware::kHeadroomAheadShift;
    const std::array<std::uint32_t, 7> words{node.duration | headrooms | (last ? firmware::kLastNode : 0u),
                                             static_cast<std::uint32_t>(node.axis[0].travel),
                                             static_cast<std::uint32_t>(node.axis[0].velocity),
                                             static_cast<std::uint32_t>(node.axis[0].acceleration),
                                             static_cast<std::uint32_t>(node.axis[1].travel),
                                             static_cast<std::uint32_t>(node.axis[1].velocity),
                                             static_cast<std::uint32_t>(node.axis[1].acceleration)};
    request.put(words);
    const Status status = bench.ask(request).status;
    if (status != Status::ok) return status;
    given = then;
    ++sent;
    return status;
  }
  void send(int nodes) {
    for (int k = 0; k < nodes; ++k) ASSERT_EQ(send_next(), Status::ok);
  }

  /// Runs steps; returns the largest distance of the references from the circle.
  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      bench.run(1);
      std::array<double, 2> at{};
      for (std::size_t i = 0; i < 2; ++i) {
        const firmware::CountPosition reference = bench.application.axes()[i].table_reference();
        at[i] =
            static_cast<double>(reference.counts) + std::ldexp(static_cast<double>(reference.fraction), -48) - begin[i];
        seen[i] = at[i];
      }
      // The reference of an axis that is off is at its encoder's position.
      if (bench.application.axes()[0].telemetry().enabled && bench.application.axes()[1].telemetry().enabled)
        off = std::max(off, circle.off(at[0], at[1]));
    }
  }
  void keep_alive(int periods) {
    for (int k = 0; k < periods; k += 20) {
      run(20);
      bench.ask(MessageType::heartbeat);
    }
  }
  firmware::PathStatePayload state() {
    firmware::PathStatePayload found;
    EXPECT_TRUE(bench.ask(MessageType::path_state).get(found));
    return found;
  }
  PathEnd end() { return static_cast<PathEnd>(state().end); }
  AxisFault fault(std::size_t axis) { return bench.application.axes()[axis].fault(); }
  Status ask(MessageType type) { return bench.ask(type).status; }

  Bench bench;
  firmware_test::Circle circle{4096.0, 1500.0};             // 10 mm, at 78 mm/s
  std::uint32_t headroom = firmware::headroom_number(1.7);  ///< its acceleration is 610 mm/s^2 at most, of 2000
  firmware::OpenPathPayload opened;
  std::array<double, 2> begin{}, seen{};
  std::array<std::int64_t, 2> given{};
  int sent = 0;
  double off = 0.0;
};

using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(PathOnBoard, Scalars);

/// This board would misread the nodes of an older host.
TYPED_TEST(PathOnBoard, RefusesAHostThatWritesNodesAnotherWay) {
  firmware::OpenPathRequest request{3, 1, {}};
  EXPECT_EQ(this->bench.ask(MessageType::open_path, request).status, Status::ok);
  for (const int format : {0, firmware::kPathNodeFormat + 1}) {
    request.node_format = static_cast<std::uint8_t>(format);
    EXPECT_EQ(this->bench.ask(MessageType::open_path, request).status, Status::wrong_version) << format;
  }
}

TYPED_TEST(PathOnBoard, EndsExactlyWhereItLeads) {
  ASSERT_EQ(this->open(), Status::ok);
  this->send(this->pieces());
  ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
  this->keep_alive(1600);
  EXPECT_EQ(this->end(), PathEnd::completed);
  EXPECT_EQ(this->state().elapsed, 1500u);
  EXPECT_LT(this->off, 1e-3) << "counts";
  EXPECT_EQ(this->seen, (std::array<double, 2>{0.0, 0.0}));
  EXPECT_EQ(this->fault(0), AxisFault::none);
  EXPECT_EQ(this->fault(1), AxisFault::none);
  EXPECT_TRUE(this->bench.application.axes()[0].is_at_rest());
}

/// Catches axes that stop independently and so leave the circle, and a fault that does not occur.
TYPED_TEST(PathOnBoard, StandsOnThePathWhenTheHostDiesAndThenSaysSo) {
  ASSERT_EQ(this->open(), Status::ok);
  this->send(this->pieces());
  ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
  this->keep_alive(500);
  int silent = 0;
  for (; silent < 2000 && this->fault(0) == AxisFault::none; ++silent) this->run(1);
  EXPECT_LT(silent, 200 + 300) << "host.timeout and the clock's ramp";
  EXPECT_EQ(this->fault(0), AxisFault::host_heartbeat_lost);
  EXPECT_EQ(this->fault(1), AxisFault::host_heartbeat_lost);
  EXPECT_LT(this->off, 1e-3);
  this->run(300);
  EXPECT_LT(this->off, 1e-3);
  EXPECT_FALSE(this->bench.board.axis(0).drive_enable().is_on());
  EXPECT_EQ(this->end(), PathEnd::host_lost);
}

TYPED_TEST(PathOnBoard, StandsOnThePathWhenNodesFailToCome) {
  ASSERT_EQ(this->open(), Status::ok);
  this->send(90);
  ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
  this->keep_alive(3000);
  EXPECT_EQ(this->end(), PathEnd::starved);
  EXPECT_LE(this->state().elapsed, 900u);
  EXPECT_LT(this->off, 1e-3);
  EXPECT_EQ(this->fault(0), AxisFault::none);
  EXPECT_TRUE(this->bench.application.axes()[0].is_at_rest());
  EXPECT_EQ(this->bench.application.axes()[0].state(), SupervisorState::enabled);
}

TYPED_TEST(PathOnBoard, HoldsAndGoesOn) {
  ASSERT_EQ(this->open(), Status::ok);
  this->send(this->pieces());
  ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
  this->keep_alive(400);
  ASSERT_EQ(this->bench.ask(MessageType::path_rate, firmware::PathRateRequest{1000, 1, 0}).status, Status::ok);
  this->keep_alive(500);
  const auto held = this->state();
  EXPECT_EQ(held.permille, 0);
  this->keep_alive(300);
  EXPECT_EQ(this->state().elapsed, held.elapsed);
  ASSERT_EQ(this->bench.ask(MessageType::path_rate, firmware::PathRateRequest{500, 0, 0}).status, Status::ok);
  this->keep_alive(500);
  EXPECT_EQ(this->state().permille, 500);
  this->keep_alive(3000);
  EXPECT_EQ(this->end(), PathEnd::completed);
  EXPECT_LT(this->off, 1e-3);
}

/// A disable in the middle of a path also stops on the path; then the enable drops.
TYPED_TEST(PathOnBoard, DisablesAtRestOnThePath) {
  ASSERT_EQ(this->open(), Status::ok);
  this->send(this->pieces());
  ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
  this->keep_alive(600);
  ASSERT_EQ(this->bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  this->keep_alive(700);
  EXPECT_EQ(this->end(), PathEnd::asked);
  EXPECT_LT(this->off, 1e-3);
  EXPECT_EQ(this->bench.application.axes()[0].state(), SupervisorState::ready);
  EXPECT_EQ(this->bench.application.axes()[1].state(), SupervisorState::enabled);
}

TYPED_TEST(PathOnBoard, BelongsToItsOwner) {
  ASSERT_EQ(this->open(), Status::ok);
  this->send(this->pieces());
  ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
  this->keep_alive(200);
  this->bench.client = 2;
  EXPECT_EQ(this->send_next(), Status::others_motion);
  EXPECT_EQ(this->open(), Status::others_motion);
  EXPECT_EQ(this->bench.ask(MessageType::path_rate, firmware::PathRateRequest{1000, 1, 0}).status,
            Status::others_motion);
  EXPECT_EQ(this->state().phase, static_cast<std::uint8_t>(PathPhase::running)) << "every client may read";
  EXPECT_EQ(this->ask(MessageType::stop_path), Status::ok) << "and stop";
  this->bench.client = 1;
  this->keep_alive(300);
  EXPECT_EQ(this->end(), PathEnd::asked);
}

TYPED_TEST(PathOnBoard, RefusesWhatDoesNotGoTogether) {
  EXPECT_EQ(this->send_next(), Status::wrong_state);
  EXPECT_EQ(this->ask(MessageType::start_path), Status::wrong_state);
  ASSERT_EQ(this->open(), Status::ok);
  EXPECT_EQ(this->ask(MessageType::start_path), Status::wrong_state) << "no nodes";
  EXPECT_EQ(this->bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 20.0F}).status, Status::wrong_state);
  firmware::Message odd;
  odd.type = MessageType::path_nodes;
  odd.put(std::array<std::uint32_t, 3>{});
  EXPECT_EQ(this->bench.ask(odd).status, Status::malformed);
  EXPECT_EQ(this->bench.ask(MessageType::path_rate, firmware::PathRateRequest{1001, 0, 0}).status, Status::malformed);
  Status status = Status::ok;
  for (int k = 0; k < 400 && status == Status::ok; ++k) {
    firmware::PathNode<2> far;
    far.duration = firmware::kLongestPiece;
    odd.put(std::array<std::uint32_t, 7>{far.duration, 1u << 30, 0, 0, 0, 0, 0});
    status = this->bench.ask(odd).status;
  }
  EXPECT_EQ(status, Status::outside_travel);
}

TYPED_TEST(PathOnBoard, NeedsHomeUnlessItIsRelative) {
  for (std::size_t axis = 0; axis < 2; ++axis) this->bench.application.axes()[axis].forget_home();
  EXPECT_EQ(this->open(), Status::not_homed);
  EXPECT_EQ(this->open(true), Status::ok);
}

/// The machine has no friction, so that its curve acts as a disturbance of 1.7 Nm and more. Catches a limit that does
/// not act or acts below its value, a hold that leaves the circle, and one that the host cannot release.
TYPED_TEST(PathOnBoard, HoldsTheFeedAboveTheLimitOfTheDisturbance) {
  for (const double limit_Nm : {0.5, 20.0}) {
    firmware::ParameterValues values = this->bench.application.active();
    this->bench.ask(MessageType::disable, firmware::AxesRequest{3});
    this->bench.run(300);
    for (const char* name : {"x.feedback.hold_effort", "y.feedback.hold_effort"})
      firmware_test::set(values, name, limit_Nm);
    ASSERT_EQ(this->bench.download(values).status, Status::ok);
    this->bench.run(300);
    ASSERT_EQ(this->bench.ask(MessageType::enable, firmware::AxesRequest{3}).status, Status::ok);
    this->bench.run(20);
    ASSERT_EQ(this->open(true), Status::ok);
    this->send(this->pieces());
    ASSERT_EQ(this->ask(MessageType::start_path), Status::ok);
    this->keep_alive(1000);
    const bool is_small = limit_Nm < 1.0;
    EXPECT_EQ(this->state().held, is_small ? firmware::kHeldForProcess : 0) << limit_Nm;
    EXPECT_EQ(this->state().permille, is_small ? 0 : 1000) << limit_Nm;
    if (is_small) {
      const std::uint32_t held_at = this->state().elapsed;
      EXPECT_LT(held_at, 400u);
      EXPECT_EQ(this->bench.ask(MessageType::path_rate, firmware::PathRateRequest{500, 1, 0}).status, Status::ok);
      EXPECT_EQ(this->state().held, firmware::kHeldForProcess) << "an override does not release it";
      for (int k = 0; k < 20; ++k) {
        EXPECT_EQ(this->bench.ask(MessageType::path_rate, firmware::PathRateRequest{1000, 0, 0}).status, Status::ok);
        EXPECT_EQ(this->state().held, 0);
        this->keep_alive(20);
      }
      EXPECT_GT(this->state().elapsed, held_at);
      EXPECT_EQ(this->ask(MessageType::stop_path), Status::ok);
    }
    this->keep_alive(1000);
    EXPECT_LT(this->off, 1e-3) << "counts";
    EXPECT_EQ(this->fault(0), AxisFault::none);
  }
}

}  // namespace
