// A motor with five orders of cogging (heitor-andrade/laas_anti_cogging, BSD-3), with records of two days. They are not
// part of the project; the test is skipped if they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "host/diagnose/improvement.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/model/model_file.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"
#include "sim/harmonic.hpp"
#include "tests/host/skip_unless_all_machines.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

const std::filesystem::path kMotor = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "real-2" / "bldc-cogging-2";

/// Catches a base that is biased by a noisy acceleration, and waves that one poor held-back record refutes by chance.
TEST(RealCogging, IsImprovedByItsOrders) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  AXIS_SKIP_UNLESS_ALL_MACHINES();
  if (!std::filesystem::exists(kMotor)) GTEST_SKIP() << kMotor << " is absent";
  const sim::DriveDescription model = host::read_model((kMotor / "model.toml").string());
  const auto read = [&](const char* name) {
    host::Record record = host::read_record((kMotor / name).string());
    host::adapt_to(record, model.data);
    return record;
  };
  const host::Measurements measured =
      host::MeasurementGate(model).admit({read("speed-6.3-run2-a.csv"), read("speed-6.3-run2-b.csv")},
                                         {read("speed-6.3-old-a.csv"), read("speed-6.3-old-b.csv")});
  const host::Improvement improvement = host::improve(model, measured);
  EXPECT_FALSE(improvement.kept_given);
  // RMS in rad/s and mm: both models leave over a hundred noise floors, and these floors differ between the models.
  const auto& given = improvement.first.given_error.validate.channels;
  const auto& improved = improvement.error.validate.channels;
  ASSERT_EQ(improved.size(), given.size());
  for (std::size_t k = 0; k < given.size(); ++k) EXPECT_LT(improved[k].rms, 0.7 * given[k].rms) << given[k].name;
  std::vector<double> orders;
  for (const sim::EffectEntry& entry : improvement.model.effects)
    if (entry.kind == "cogging")
      for (const sim::HarmonicTerm& term : sim::harmonics_of(entry))
        orders.push_back(std::round(term.order * 2.0 * std::numbers::pi / entry.at("period")));
  EXPECT_THAT(orders, testing::IsSupersetOf({72.0, 18.0, 12.0, 24.0}));
}

}  // namespace
