// Benefit of a scale on the table for a planned run: it separates a gap from a spring, which the motor hardly shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "host/model/model_file.hpp"
#include "host/plan/decision.hpp"
#include "host/plan/experiment_plan.hpp"
#include "host/plan/information.hpp"
#include "host/plan/primitives.hpp"
#include "host/plan/simulated_run.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

constexpr host::ExcitationLimits kBox{40.0, 150.0, 3.0, 6.0};

class TableInformation : public testing::Test {
 protected:
  static sim::DriveDescription drive() {
    sim::DriveDescription model = host::read_model(AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml");
    model.data.load_encoder_resolution = 0.0005;
    return model;
  }
  static host::Rival rival(const std::string& kind, std::map<std::string, double> parameters) {
    host::Rival made{{kind}, drive(), 0.5};
    made.model.effects.push_back({.kind = kind, .parameters = std::move(parameters), .ci95 = {}, .from = {}});
    return made;
  }

  /// A small gap with a stiff contact, and a spring with the same deflection due to the table's friction.
  const std::vector<host::Rival> rivals_ = {
      rival("backlash", {{"gap", 0.01}, {"load_fraction", 0.2}, {"resonance", 200.0}, {"damping_ratio", 0.1}}),
      rival("compliance", {{"load_fraction", 0.2}, {"resonance", 80.0}, {"damping_ratio", 0.1}})};
  const firmware::ParameterValues board_ = host::design_values(drive());

  host::Record run(const host::RunPiece& piece, std::size_t truth, std::uint64_t seed) const {
    return host::simulate_run({{piece}, kBox, {}, 0.0}, rivals_[truth].model, board_, seed).record;
  }
  host::RunPiece piece_of(const std::string& kind) const {
    for (const host::RunPiece& piece : host::candidate_pieces(drive(), kBox))
      if (piece.kind == kind) return piece;
    throw std::runtime_error("no piece is called " + kind);
  }
};

/// Catches a table that is compared with the prediction for the motor, and an offset of the scale that counts as an
/// error. At the restart of a window the motion is known to one step of the motor's encoder, which is five steps of the
/// scale: dispersion.
TEST_F(TableInformation, TellsTheTruthFromItsRivalByOneRun) {
  const host::Record record = run(piece_of("reversals"), 0, 3);
  ASSERT_EQ(record.x2.size(), record.size());
  const host::RecordSet set = host::common_ground({&record}, rivals_);
  const auto windows = static_cast<double>(host::table_windows(set));
  const double truth = host::information_of_table(rivals_[0].model, set).least(),
               other = host::information_of_table(rivals_[1].model, set).least();
  const double dispersion = std::max(1.0, truth / windows);
  EXPECT_LT(dispersion, 25.0) << "of a step of the encoder over one of the scale, squared";
  EXPECT_GT(0.5 * (other - truth) / dispersion, std::log(host::kDecided / (1.0 - host::kDecided)));
}

TEST_F(TableInformation, IsEmptyWithoutAScale) {
  host::Record record = run(piece_of("reversals"), 0, 3);
  record.x2.clear();
  const host::RecordSet set = host::common_ground({&record}, rivals_);
  EXPECT_EQ(host::table_windows(set), 0u);
  EXPECT_EQ(host::information_of_table(rivals_[0].model, set).slope.size(), 0);
}

/// Catches a plan that evaluates a run only by the motor, and odds of a decision that ignore the table.
TEST_F(TableInformation, RaisesTheOddsOfAPlanAndOfItsDecision) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  for (const std::size_t truth : {0u, 1u}) {
    const host::Record training = run(piece_of("steps"), truth, 5), made = run(piece_of("reversals"), truth, 6);
    host::Record blind_training = training, blind = made;
    blind_training.x2.clear();
    blind.x2.clear();
    const host::Decision seen = host::decide(rivals_, {&blind_training}, made),
                         unseen = host::decide(rivals_, {&blind_training}, blind);
    EXPECT_EQ(seen.best, truth);
    EXPECT_GE(seen.odds, unseen.odds);
    EXPECT_GT(seen.chi_square[1 - truth] - seen.chi_square[truth],
              10.0 + unseen.chi_square[1 - truth] - unseen.chi_square[truth]);
  }
  const host::Record training = run(piece_of("steps"), 0, 5);
  std::vector<host::Rival> without = rivals_;
  for (host::Rival& one : without) one.model.data.load_encoder_resolution = 0.0;
  sim::DriveDescription motor_alone = drive();
  motor_alone.data.load_encoder_resolution = 0.0;
  host::Record blind_training = training;
  blind_training.x2.clear();
  const host::Plan with_scale = host::plan_run(drive(), {&blind_training}, rivals_, kBox),
                   with_motor = host::plan_run(motor_alone, {&blind_training}, without, kBox);
  ASSERT_FALSE(with_scale.considered.empty());
  EXPECT_TRUE(with_scale.separable);
  EXPECT_GE(with_scale.expected_odds, with_motor.expected_odds);
  EXPECT_GT(with_scale.considered.front().expected_log_odds,
            10.0 + (with_motor.considered.empty() ? 0.0 : with_motor.considered.front().expected_log_odds));
}

}  // namespace
