// Tables of pitch errors on the simulated board: loading, saving, refusal, and the effect on an axis with a screw
// error.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "firmware/app/protocol/pitch_messages.hpp"
#include "tests/firmware/app/board_on_a_bench.hpp"
#include "tests/firmware/circle_in_counts.hpp"

namespace {

using firmware::MessageType;
using firmware::PitchPoint;
using firmware::Status;
using firmware_test::kEncoderResolution_mm;

/// A screw and its nut: the table lags by half of a play behind the motor, and has the screw's error. Long errors of
/// the pitch, short ones of the thread.
class Screw {
 public:
  explicit Screw(double phase) : phase_(phase) {}
  double table_mm(double motor_mm) {
    nut_mm_ = std::clamp(nut_mm_, motor_mm - kHalfPlay_mm, motor_mm + kHalfPlay_mm);
    return nut_mm_ + error_mm(nut_mm_);
  }

 private:
  static constexpr double kHalfPlay_mm = 0.0025;
  double error_mm(double x) const {
    return 8e-5 * x + 0.01 * std::sin(2.0 * std::numbers::pi * x / 60.0 + phase_) - 0.01 * std::sin(phase_);
  }
  double phase_, nut_mm_ = 0.0;
};

/// The board with both axes behind screws, homed, at 0.
template <typename Scalar>
struct Machine {
  using Bench = firmware_test::BoardOnABench<Scalar>;

  explicit Machine(const hal::pc::SimulatedFlash* flash = nullptr) : bench(flash) {
    if (flash == nullptr) {
      firmware::ParameterValues values = firmware_test::paper_values();
      firmware_test::fit_axis(values, "y", firmware_test::kPaperY);
      for (const char* name : {"x.monitor.travel_max", "y.monitor.travel_max"}) firmware_test::set(values, name, 200);
      for (const char* name : {"x.monitor.travel_min", "y.monitor.travel_min"}) firmware_test::set(values, name, -50);
      EXPECT_EQ(bench.download(values).status, Status::ok);
    }
    run(300);
  }

  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      bench.run(1);
      for (std::size_t i = 0; i < 2; ++i) table[i] = screw[i].table_mm(bench.board.plant(i).truth().x);
      if (k % 50 == 0) bench.ask(MessageType::heartbeat);
    }
  }
  void enable() {
    EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{3}).status, Status::ok);
    run(5);
    for (std::uint8_t axis = 0; axis < 2; ++axis) {
      if (bench.application.axes()[axis].is_homed()) continue;
      EXPECT_EQ(bench.ask(MessageType::home, firmware::HomeRequest{axis, 1}).status, Status::ok);
    }
    run(100);
  }
  void disable() {
    EXPECT_EQ(bench.ask(MessageType::disable, firmware::AxesRequest{3}).status, Status::ok);
    run(600);
    EXPECT_FALSE(bench.application.any_enabled());
  }

  void move_to(double x_mm, std::uint8_t axis = 0) {
    const auto target = std::llround(x_mm / kEncoderResolution_mm);
    ASSERT_EQ(bench.ask(MessageType::move, firmware::MoveRequest::to(axis, target)).status, Status::ok) << x_mm;
    run(50);
    for (int k = 0; k < 5000 && !bench.application.axes()[axis].is_at_rest(); ++k) run(1);
    run(150);
    ASSERT_EQ(bench.application.axes()[axis].fault(), firmware::AxisFault::none) << x_mm;
  }

  /// Measures as with a laser interferometer: approaches each position from below, then each from above.
  struct Deviation {
    double x_mm, forward_mm, backward_mm;
  };
  std::vector<Deviation> measure(double first, double step, int count, std::uint8_t axis = 0) {
    std::vector<Deviation> found;
    move_to(first - 5, axis);
    for (int i = 0; i < count; ++i) {
      move_to(first + i * step, axis);
      found.push_back({first + i * step, mean(axis) - (first + i * step), 0});
    }
    move_to(first + (count - 1) * step + 5, axis);
    for (int i = count; i-- > 0;) {
      move_to(found[i].x_mm, axis);
      found[i].backward_mm = mean(axis) - found[i].x_mm;
    }
    return found;
  }
  double mean(std::size_t axis) {
    double sum = 0;
    for (int k = 0; k < 50; ++k) {
      run(1);
      sum += table[axis];
    }
    return sum / 50;
  }

  static std::vector<PitchPoint> points_of(const std::vector<Deviation>& measured) {
    const auto unit = [](double mm) {
      return static_cast<std::int32_t>(std::lround(65536 * mm / kEncoderResolution_mm));
    };
    std::vector<PitchPoint> points;
    for (const Deviation& one : measured)
      points.push_back({static_cast<std::int32_t>(std::lround(one.x_mm / kEncoderResolution_mm)), unit(one.forward_mm),
                        unit(one.backward_mm)});
    return points;
  }

  Status begin(std::size_t points, std::uint8_t axis = 0) {
    const auto bits = firmware::resolution_bits(bench.application.active(), axis);
    return bench
        .ask(MessageType::begin_table, firmware::BeginTableRequest{axis, 0, static_cast<std::uint16_t>(points), bits})
        .status;
  }
  Status send(const std::vector<PitchPoint>& points) {
    for (std::size_t first = 0; first < points.size(); first += firmware::kPointsPerReport) {
      firmware::TablePointsRequest part{static_cast<std::uint16_t>(first), 0, 0, {}};
      while (part.count < firmware::kPointsPerReport && first + part.count < points.size()) {
        part.point[part.count] = points[first + part.count];
        ++part.count;
      }
      const Status status = bench.ask(MessageType::table_points, part).status;
      if (status != Status::ok) return status;
    }
    return Status::ok;
  }
  Status finish(const std::vector<PitchPoint>& points, bool on) {
    const std::uint32_t crc = firmware::crc32(std::as_bytes(std::span(points)));
    return bench.ask(MessageType::finish_table, firmware::FinishTableRequest{crc, static_cast<std::uint8_t>(on), {}})
        .status;
  }
  Status load(const std::vector<PitchPoint>& points, bool on = true, std::uint8_t axis = 0) {
    const Status begun = begin(points.size(), axis);
    const Status sent = begun == Status::ok ? send(points) : begun;
    return sent == Status::ok ? finish(points, on) : sent;
  }
  std::vector<PitchPoint> read(std::uint8_t axis = 0) {
    std::vector<PitchPoint> points;
    firmware::TablePointsPayload part;
    do {
      const firmware::Message reply = bench.ask(
          MessageType::read_table, firmware::ReadTableRequest{axis, 0, static_cast<std::uint16_t>(points.size())});
      EXPECT_EQ(reply.status, Status::ok);
      EXPECT_TRUE(reply.get(part));
      for (std::size_t i = 0; i < firmware::kPointsPerReport && points.size() < part.points; ++i)
        points.push_back(part.point[i]);
    } while (points.size() < part.points);
    return points;
  }
  bool is_corrected(std::size_t axis = 0) { return (bench.status().axis[axis].flags & firmware::kAxisPitch) != 0; }

  Bench bench;
  std::array<Screw, 2> screw{Screw(0.3), Screw(1.9)};
  std::array<double, 2> table{};
};

template <typename Deviations>
double worst_um(const Deviations& all) {
  double worst = 0;
  for (const auto& one : all) worst = std::max({worst, std::abs(one.forward_mm), std::abs(one.backward_mm)});
  return 1e3 * worst;
}

template <typename Scalar>
class PitchOnBoard : public testing::Test {
 protected:
  Machine<Scalar> machine;
};
using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(PitchOnBoard, Scalars);

std::vector<PitchPoint> some_points(int count, int seed = 1) {
  std::vector<PitchPoint> points;
  for (int i = 0; i < count; ++i) points.push_back({2000 * i, 65536 * ((i * seed) % 5), -65536 * (i % 7)});
  return points;
}

/// Catches a wrong sign, swapped columns, and points that are off by one.
TYPED_TEST(PitchOnBoard, BringsTheTableToItsPlace) {
  auto& machine = this->machine;
  machine.enable();
  const auto before = machine.measure(0, 10, 13);
  machine.disable();
  ASSERT_EQ(machine.load(machine.points_of(before)), Status::ok);
  machine.run(300);
  machine.enable();
  machine.move_to(-8);
  EXPECT_TRUE(machine.is_corrected());
  const auto after = machine.measure(0, 10, 13);
  const auto between = machine.measure(5, 10, 12);
  std::printf("largest deviation: %.2f um before, %.2f um after at the points, %.2f um between them\n",
              worst_um(before), worst_um(after), worst_um(between));
  EXPECT_GT(worst_um(before), 10.0);
  EXPECT_LT(worst_um(after), 2.5) << "a count of the encoder is 2.44 um";
  // A straight line between points 10 mm apart misses the short error's arc by (10 / 60 * 2 pi)^2 / 8 of 10 um: 1.4 um.
  EXPECT_LT(worst_um(between), 2.5 + 1.4);
}

/// Distance of the table from the commanded circle, while both axes follow it.
template <typename M>
double circle_error_um(M& machine) {
  const firmware_test::Circle circle{10'000, 12'000};
  const firmware::PathUnits units{16, 24, 32};
  constexpr double kPiece = 40.0;
  machine.move_to(20, 0);
  machine.move_to(50, 1);
  EXPECT_EQ(machine.bench.ask(MessageType::open_path, firmware::OpenPathRequest{3, 0, units}).status, Status::ok);
  std::array<std::int64_t, 2> given{};
  for (int i = 1; i <= 300; ++i) {
    const auto node = circle.node(kPiece * i, kPiece, units, i == 300, given);
    firmware::Message request;
    request.type = MessageType::path_nodes;
    const auto word = [](std::int32_t value) { return static_cast<std::uint32_t>(value); };
    const std::array<std::uint32_t, 7> words{node.duration | (i == 300 ? firmware::kLastNode : 0u),
                                             word(node.axis[0].travel),
                                             word(node.axis[0].velocity),
                                             word(node.axis[0].acceleration),
                                             word(node.axis[1].travel),
                                             word(node.axis[1].velocity),
                                             word(node.axis[1].acceleration)};
    request.put(words);
    EXPECT_EQ(machine.bench.ask(request).status, Status::ok) << i;
  }
  EXPECT_EQ(machine.bench.ask(MessageType::start_path).status, Status::ok);
  double worst = 0;
  const double radius_mm = circle.radius * kEncoderResolution_mm;
  for (int k = 0; k < 12'100; ++k) {
    machine.run(1);
    if (k % 50 == 0) machine.bench.ask(MessageType::heartbeat);
    const double x = machine.table[0] - 20, y = machine.table[1] - 50;
    worst = std::max(worst, std::abs(std::hypot(x - radius_mm, y) - radius_mm));
  }
  EXPECT_EQ(machine.bench.application.axes()[0].fault(), firmware::AxisFault::none);
  EXPECT_EQ(machine.bench.application.axes()[1].fault(), firmware::AxisFault::none);
  return 1e3 * worst;
}

TEST(PitchOnBoardContour, KeepsACircleRound) {
  Machine<float> machine;
  machine.enable();
  const double before = circle_error_um(machine);
  const auto x = machine.points_of(machine.measure(0, 10, 11));
  const auto y = machine.points_of(machine.measure(0, 10, 11, 1));
  machine.disable();
  ASSERT_EQ(machine.load(x), Status::ok);
  ASSERT_EQ(machine.load(y, true, 1), Status::ok);
  machine.run(300);
  machine.enable();
  machine.move_to(5, 0);
  machine.move_to(5, 1);
  const double after = circle_error_um(machine);
  std::printf("largest error of a circle of 24.4 mm radius: %.2f um before, %.2f um after\n", before, after);
  EXPECT_LT(after, 0.6 * before);
}

TYPED_TEST(PitchOnBoard, IsKeptWithTheParametersAndOutlivesFurtherSaves) {
  auto& machine = this->machine;
  const auto x = some_points(256), y = some_points(9, 3);
  ASSERT_EQ(machine.load(x), Status::ok);
  ASSERT_EQ(machine.load(y, false, 1), Status::ok);
  EXPECT_EQ(machine.read(), x);
  EXPECT_EQ(machine.read(1), y);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(machine.bench.ask(MessageType::save).status, Status::ok);
  EXPECT_EQ(machine.read(), x);
  Machine<TypeParam> again(&machine.bench.board.parameter_flash());
  EXPECT_EQ(again.read(), x);
  EXPECT_EQ(again.read(1), y);
  EXPECT_TRUE(again.bench.application.active().axis(0).template get<"pitch.on">());
  EXPECT_FALSE(again.bench.application.active().axis(1).template get<"pitch.on">());
  EXPECT_FALSE(again.bench.application.has_unsaved_changes());
  EXPECT_FALSE(again.is_corrected()) << "not homed yet";
  again.enable();
  EXPECT_TRUE(again.is_corrected());
  EXPECT_FALSE(again.is_corrected(1)) << "switched off";
  again.disable();
  ASSERT_EQ(again.load({}, false), Status::ok) << "removed";
  EXPECT_TRUE(again.read().empty());
  EXPECT_EQ(again.read(1), y);
}

TYPED_TEST(PitchOnBoard, RefusesWhileADriveIsEnabled) {
  auto& machine = this->machine;
  const auto points = some_points(8);
  machine.enable();
  EXPECT_EQ(machine.begin(8), Status::drive_enabled);
  machine.disable();
  ASSERT_EQ(machine.begin(8), Status::ok);
  machine.run(300);
  machine.enable();
  EXPECT_EQ(machine.send(points), Status::drive_enabled);
  machine.disable();
  ASSERT_EQ(machine.send(points), Status::ok);
  machine.enable();
  EXPECT_EQ(machine.finish(points, true), Status::drive_enabled);
  machine.disable();
  EXPECT_TRUE(machine.read().empty()) << "an incomplete table is discarded";
  EXPECT_EQ(machine.finish(points, true), Status::ok);
}

TYPED_TEST(PitchOnBoard, RefusesWhatDoesNotGoTogether) {
  auto& machine = this->machine;
  auto points = some_points(8);
  EXPECT_EQ(machine.begin(1), Status::malformed);
  EXPECT_EQ(machine.begin(257), Status::malformed);
  EXPECT_EQ(machine.begin(8, 2), Status::malformed) << "no such axis";
  EXPECT_EQ(machine.bench.ask(MessageType::begin_table, firmware::BeginTableRequest{0, 0, 8, 0}).status,
            Status::bad_value)
      << "counts of another encoder";
  EXPECT_EQ(machine.send(points), Status::set_differs) << "nothing was begun";
  EXPECT_EQ(machine.finish(points, true), Status::set_differs);
  ASSERT_EQ(machine.begin(8), Status::ok);
  EXPECT_EQ(machine.finish(points, true), Status::not_verified) << "no point has come";
  ASSERT_EQ(machine.begin(8), Status::ok);
  ASSERT_EQ(machine.send(points), Status::ok);
  EXPECT_EQ(machine.send(points), Status::set_differs) << "the table must be sent again from its first point";
  auto others = points;
  others[3].forward += 1;
  EXPECT_EQ(machine.finish(others, true), Status::not_verified);
  EXPECT_EQ(machine.load({}, true), Status::malformed) << "no table to switch on";
  for (std::size_t i = 1; i < points.size(); ++i) {
    auto falling = points;
    falling[i].counts = falling[i - 1].counts;
    ASSERT_EQ(machine.begin(8), Status::ok);
    EXPECT_EQ(machine.send(falling), Status::bad_value) << i;
    auto steep = points;
    steep[i].backward += 2000 * 65536 / 64 + 8 * 65536;
    ASSERT_EQ(machine.begin(8), Status::ok);
    EXPECT_EQ(machine.send(steep), Status::bad_value) << i;
  }
  ASSERT_EQ(machine.begin(8), Status::ok);
  ASSERT_EQ(machine.send(points), Status::ok);
  ASSERT_EQ(machine.bench.ask(MessageType::save).status, Status::ok);
  EXPECT_EQ(machine.finish(points, true), Status::set_differs) << "a save has taken its place";
  EXPECT_TRUE(machine.read().empty());
}

TYPED_TEST(PitchOnBoard, SwitchNeedsATableOfThisEncoder) {
  auto& machine = this->machine;
  firmware::ParameterValues values = machine.bench.application.active();
  const auto place = firmware_test::place_named("x.pitch.on");
  const auto refused_key = [&] {
    const firmware::Message reply = machine.bench.download(values);
    EXPECT_EQ(reply.status, Status::bad_value);
    firmware::RefusedValuePayload refused;
    EXPECT_TRUE(reply.get(refused));
    return refused.key;
  };
  values.set(place, 1);
  EXPECT_EQ(refused_key(), firmware::key_at(place).code);
  ASSERT_EQ(machine.load(some_points(8)), Status::ok);
  values = machine.bench.application.active();
  EXPECT_EQ(values.at(place), 1.0F);
  firmware_test::set(values, "x.drive.encoder_resolution", kEncoderResolution_mm * 0.99);
  EXPECT_EQ(refused_key(), firmware::key_at(place).code);
  values.set(place, 0);
  EXPECT_EQ(machine.bench.download(values).status, Status::ok);
}

/// Limits of travel apply to the table's position: the additional correction causes no fault.
TYPED_TEST(PitchOnBoard, MayReachTheLimitOfTravel) {
  auto& machine = this->machine;
  // 20 and 25 counts short: the motor has to go beyond the limits.
  ASSERT_EQ(machine.load({{-20480, 20 * 65536, 20 * 65536}, {0, 0, 0}, {81920, -20 * 65536, -25 * 65536}}), Status::ok);
  machine.run(300);
  machine.enable();
  machine.move_to(199.9);
  machine.move_to(-49.9);
  machine.move_to(200.0);
  EXPECT_GT(machine.bench.application.axes()[0].telemetry().encoder_counts, 81920 + 15);
  machine.move_to(-50.0);
}

TYPED_TEST(PitchOnBoard, DoesNotMoveAnAxisThatIsEnabled) {
  auto& machine = this->machine;
  ASSERT_EQ(machine.load({{0, 20 * 65536, 20 * 65536}, {81920, -20 * 65536, -25 * 65536}}), Status::ok);
  machine.run(300);
  machine.enable();
  machine.move_to(30);
  machine.disable();
  const std::int64_t before = machine.bench.application.axes()[0].telemetry().encoder_counts;
  EXPECT_EQ(machine.bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
  machine.run(300);
  EXPECT_NEAR(static_cast<double>(machine.bench.application.axes()[0].telemetry().encoder_counts - before), 0.0, 2.0);
}

}  // namespace
