// Torque that a model leaves unexplained, on a record made from a force balance.
#include "host/compare/effort_residual.hpp"

#include <gtest/gtest.h>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

// For motions that are slow compared with its resonance, a load moves with its motor, so both models have the same
// residual.
TEST(ResidualSamples, ALoadOnASpringOrBehindAGapMovesWithItsMotor) {
  const host::Record record = HandMade::record();
  const sim::DriveDescription rigid = HandMade::model();
  const host::PreparedRecord prepared = host::prepare(record, rigid);
  const host::ResidualSamples expected = host::residual_samples(rigid, prepared, 5);
  ASSERT_FALSE(expected.missing.empty());
  for (const char* kind : {"compliance", "backlash"}) {
    sim::DriveDescription pair = rigid;
    pair.effects.push_back({kind, {{"load_fraction", 0.4}, {"resonance", 120.0}, {"damping_ratio", 0.05}}, {}, {}});
    if (std::string_view(kind) == "backlash") pair.effects.back().parameters["gap"] = 0.05;
    EXPECT_EQ(host::residual_samples(pair, prepared, 5).missing, expected.missing) << kind;
  }
}

}  // namespace
