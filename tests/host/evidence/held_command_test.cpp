// A current that changes within a row, on a drive that friction stops within that row; computed by hand.
#include "host/evidence/held_command.hpp"

#include <gtest/gtest.h>

#include "sim/drive.hpp"

namespace {

constexpr double kPeriod_s = 1e-3;

sim::DriveDescription drive_with_friction() {
  sim::DriveDescription model;
  model.name = "x";
  model.data.kind = sim::DriveKind::rotary;
  model.data.amplifier_gain_A_per_V = 1.0;
  model.data.torque_constant_Nm_per_A = 1.0;
  model.data.lead = 1.0;
  model.data.sample_period_s = kPeriod_s;
  model.effects = {{"inertia", {{"J", 1e-3}}, {}, {}}, {"coulomb", {{"level", 0.5}}, {}, {}}};
  return model;
}

host::Record record_of(const std::vector<double>& current_A, const char* acts_after_samples) {
  host::Record record;
  record.sample_period_s = kPeriod_s;
  record.i_A = current_A;
  for (std::size_t k = 0; k < current_A.size(); ++k) record.t_s.push_back(static_cast<double>(k) * kPeriod_s);
  record.header["effort_timing_samples"] = acts_after_samples;
  return record;
}

std::vector<double> speeds(const host::Record& record) {
  const sim::DriveDescription model = drive_with_friction();
  const sim::Drive drive(model);
  const host::HeldCommand held(record, model.data);
  sim::DriveState state = drive.at(0.0, 0.0);
  std::vector<double> w{state.w};
  for (std::size_t row = 0; row + 1 < record.size(); ++row) {
    held.step(drive, state, row);
    w.push_back(state.w);
  }
  return w;
}

// 1 A until 1.75 ms: 500 rad/s^2 against the friction. Then -1 A: -1500 rad/s^2 until it stops at 2.333 ms, then -500
// rad/s^2. From 2.75 ms on no current: 500 rad/s^2 until it rests at 3.167 ms. The mean of the third row, -0.75 A,
// would give -0.15 rad/s at 3 ms.
TEST(HeldCommand, ChangesTheCurrentWhereItActs) {
  const std::vector<double> w = speeds(record_of({1.0, 1.0, -1.0, 0.0, 0.0, 0.0}, "0.25"));
  EXPECT_NEAR(w[1], 0.5, 1e-9);
  EXPECT_NEAR(w[2], 0.5 * 1.75 - 1.5 * 0.25, 1e-9);
  EXPECT_NEAR(w[3], -0.5 * (2.75 - 1.75 - 0.875 / 1.5) + 0.5 * 0.25, 1e-9);
  EXPECT_EQ(w[4], 0.0);
}

// 1.5 rows later than a held current: row 0 lasts until 2.5 ms.
TEST(HeldCommand, MovesALateCurrentByWholeRowsToo) {
  const std::vector<double> w = speeds(record_of({1.0, 0.0, 0.0, 0.0, 0.0}, "2.0"));
  EXPECT_NEAR(w[2], 1.0, 1e-9);
  EXPECT_NEAR(w[3], 1.25 - 0.25, 1e-9);
}

}  // namespace
