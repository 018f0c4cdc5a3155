// The board takes friction feed-forward back where friction is less than half of the curve, and gives it again where it
// is not; on the simulated board, both number types.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::MessageType;
using firmware::Status;

constexpr double kFriction_Nm = 1.6;

template <typename Scalar>
class FrictionWatch : public testing::Test {
 protected:
  using Bench = firmware_test::BoardOnABench<Scalar>;

  /// A machine with this friction and `others`; its curve on the board is `share` times the friction.
  void begin(double share, bool watches = true, const std::vector<sim::EffectEntry>& others = {}) {
    auto drives = Bench::machines();
    drives[0].effects.push_back({"coulomb", {{"level", kFriction_Nm}}, {}, {}});
    for (const sim::EffectEntry& one : others) drives[0].effects.push_back(one);
    bench.emplace(nullptr, drives);
    firmware::ParameterValues values = firmware_test::paper_values();
    for (const char* level : {"static_positive", "static_negative", "coulomb_positive", "coulomb_negative"})
      firmware_test::set(values, "x.friction." + std::string(level), share * kFriction_Nm);
    firmware_test::set(values, "x.feedforward.friction_watch", watches ? 1 : 0);
    firmware_test::set(values, "x.feedback.cancel_disturbance", cancels ? 1 : 0);
    ASSERT_EQ(bench->download(values).status, Status::ok);
    bench->run(200);
    ASSERT_EQ(bench->ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
    bench->run(5);
  }

  /// Returns the RMS of the following error, um.
  double jog(float speed, int periods = 300) {
    EXPECT_EQ(bench->ask(MessageType::jog, firmware::JogRequest{0, {}, speed}).status, Status::ok);
    double squares = 0.0;
    for (int period = 0; period < periods; ++period) {
      if (period % 20 == 0) bench->ask(MessageType::heartbeat);
      bench->run(1);
      const auto& seen = bench->application.axes()[0].telemetry();
      const auto error = static_cast<double>(seen.reference.counts - seen.encoder_counts);
      squares += std::pow(1e3 * firmware_test::kEncoderResolution_mm * error, 2) / periods;
    }
    return std::sqrt(squares);
  }
  /// Strokes forth and back; returns the error of the last.
  double strokes(int number) {
    double error_um = 0.0;
    for (int k = 0; k < number; ++k) error_um = jog(k % 2 == 0 ? 30.0F : -30.0F);
    return error_um;
  }
  bool is_taken_back() {
    firmware::TimingPayload timing;
    EXPECT_TRUE(bench->ask(MessageType::timing, firmware::TimingRequest{}).get(timing));
    return (timing.friction_taken_back & 1u) != 0;
  }

  bool cancels = true;
  std::optional<Bench> bench;
};

using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(FrictionWatch, Scalars);

/// Catches a watch that never acts, acts without its switch, or makes following worse, and a board that does not report
/// it.
TYPED_TEST(FrictionWatch, TakesBackACurveOfThreeTimesTheFriction) {
  for (const bool cancels : {true, false}) {
    this->cancels = cancels;
    this->begin(3.0);
    const double before_um = this->strokes(4);
    EXPECT_FALSE(this->is_taken_back()) << "three of four strokes are complete, too few to decide";
    this->strokes(2);
    EXPECT_TRUE(this->is_taken_back());
    const double after_um = this->strokes(4);
    std::printf("%s cancellation: following error of a stroke %.2f um RMS with the wrong curve, %.2f um without\n",
                cancels ? "with" : "without", before_um, after_um);
    EXPECT_LT(after_um, 0.8 * before_um);
  }
  this->begin(3.0, false);
  this->strokes(10);
  EXPECT_FALSE(this->is_taken_back());
}

/// Catches a watch that takes back a useful curve: one that is wrong by 30 %, and one on an axis with a weight.
TYPED_TEST(FrictionWatch, KeepsACurveThatHelps) {
  for (const double share : {0.7, 1.0, 1.3}) {
    this->begin(share);
    this->strokes(12);
    EXPECT_FALSE(this->is_taken_back()) << share;
  }
  for (const double weight_Nm : {1.4, -1.4}) {
    this->begin(1.0, true, {{"constant_torque", {{"torque", weight_Nm}}, {}, {}}});
    this->strokes(12);
    EXPECT_FALSE(this->is_taken_back()) << weight_Nm;
  }
}

/// Friction of 1.9 times the curve about the start, a tenth of it 40 mm further. Catches a curve that stays off where
/// it would help again.
TYPED_TEST(FrictionWatch, GivesItAgainWhereItHelps) {
  this->begin(1.0, true, {{"position_dependent_friction", {{"cosine", 0.9}, {"sine", 0.0}, {"period", 80.0}}, {}, {}}});
  this->strokes(8);
  EXPECT_FALSE(this->is_taken_back());
  this->jog(30.0F, 1200);
  this->strokes(10);
  EXPECT_TRUE(this->is_taken_back());
  this->jog(30.0F, 1300);
  this->strokes(10);
  EXPECT_FALSE(this->is_taken_back());
}

}  // namespace
