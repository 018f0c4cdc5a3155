// Records without a multisine.
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/response/frequency_response.hpp"
#include "tests/host/response/two_mass_experiment.hpp"

namespace {

/// White noise as the command of a machine without friction, in open loop.
host::Record shaken(const TwoMassMachine& machine, double noise_V, unsigned seed, std::size_t samples) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  host::Record record;
  record.path = "shaken";
  record.sample_period_s = machine.period_s;
  Eigen::Vector4d state = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < samples; ++k) {
    record.t_s.push_back(static_cast<double>(k) * machine.period_s);
    record.u_V.push_back(noise_V * normal(random));
    record.x.push_back(std::floor(machine.lead * state(2) / machine.count) * machine.count);
    record.w.push_back(state(1) + machine.tachometer_noise * normal(random));
    machine.advance(state, record.u_V.back());
  }
  return record;
}

TwoMassMachine machine_without_friction() {
  TwoMassMachine machine;
  machine.coulomb = machine.stribeck = 0.0;
  machine.damping = 0.1;  // lines 1 Hz apart resolve such a resonance
  return machine;
}

/// Catches a missing hold, which shifts the phase by 36 degrees at 100 Hz, and a window that is not corrected, which
/// scales the response.
TEST(ArbitraryRecord, GivesTheResponseWhereCommandAndAnswerAreCoherent) {
  const TwoMassMachine machine = machine_without_friction();
  const auto response = host::frequency_response({shaken(machine, 3.0, 1, 60000)});
  EXPECT_EQ(response.method, host::FrequencyResponse::Method::welch);
  EXPECT_FALSE(response.is_indirect);
  int good = 0, inside = 0, all = 0;
  for (const host::ResponseLine& line : response.lines) {
    if (line.f_Hz < 5.0 || line.f_Hz > 100.0) continue;
    const std::complex<double> off = line.plant(1) / machine.response(line.f_Hz)(1) - 1.0;
    const double reach = host::half_width_95(line, {0.0, 1.0}) / std::abs(line.plant(1));
    ++all;
    good += std::abs(off) < 0.1;
    inside += std::abs(off.real()) < 1.5 * reach;
  }
  EXPECT_GT(all, 80);
  EXPECT_GT(good, 0.95 * all);
  EXPECT_GT(inside, 0.9 * all);
}

TEST(ArbitraryRecord, HasItsCoherenceFallWithNoise) {
  TwoMassMachine machine = machine_without_friction();
  const auto mean_coherence = [&] {
    const auto response = host::frequency_response({shaken(machine, 0.3, 2, 30000)});
    double sum = 0.0;
    for (const host::ResponseLine& line : response.lines) sum += line.f_Hz < 100.0 ? line.coherence / 100.0 : 0.0;
    return sum;
  };
  machine.count = 1e-5;
  const double calm = mean_coherence();
  machine.count = 0.05;
  EXPECT_LT(mean_coherence(), 0.8 * calm);
}

TEST(ArbitraryRecord, IsRefusedWhereNothingAnswers) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  host::Record record = shaken(machine_without_friction(), 1.0, 3, 20000);
  for (std::size_t k = 0; k < record.size(); ++k) record.x[k] = record.w[k] = 0.0;
  try {
    host::frequency_response({record});
    ADD_FAILURE() << "a standing axis has no response";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
  }
  record.u_V.clear();
  try {
    host::frequency_response({record});
    ADD_FAILURE() << "without a command there is no response";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
  }
}

}  // namespace
