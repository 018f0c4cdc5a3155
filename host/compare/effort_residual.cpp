#include "host/compare/effort_residual.hpp"

#include <cmath>

#include "sim/second_mass.hpp"

namespace host {

namespace {

/// The drive with a rigid connection, so that the load moves with the motor.
sim::DriveDescription moving_as_one(sim::DriveDescription model) {
  std::erase_if(model.effects, [](const sim::EffectEntry& entry) { return sim::is_second_mass(entry.kind); });
  return model;
}

/// The smoothed motion of the machine, corrected for the encoder error of the model.
struct TrueMotion {
  std::vector<double> x, w;

  TrueMotion(const sim::Drive& drive, const PreparedRecord& prepared) : x(prepared.motion().x), w(prepared.motion().w) {
    if (drive.encoder_error.empty()) return;
    const std::vector<double> read = x;
    for (double& travel : x) travel = drive.travel_at_reading(travel);
    const double per_difference = 0.5 / (prepared.period_s * drive.lead);
    for (std::size_t k = 1; k + 1 < x.size(); ++k)
      w[k] += per_difference * ((x[k + 1] - read[k + 1]) - (x[k - 1] - read[k - 1]));
  }
};

}  // namespace

ResidualSamples residual_samples(const sim::DriveDescription& model, const PreparedRecord& prepared,
                                 std::size_t stride) {
  const sim::Drive drive(moving_as_one(model));
  const TrueMotion motion(drive, prepared);
  const bool tach = prepared.record->has_speed();
  ResidualSamples samples;
  sim::DriveState state = drive.at(motion.x[0], motion.w[0]);
  for (std::size_t k = 0; k + 1 < motion.x.size(); ++k) {
    const double t_s = prepared.record->t_s[k];
    const double effort =
        drive.follow(state, prepared.u_V[k], motion.x[k + 1], motion.w[k + 1], t_s, prepared.period_s);
    if (k % stride != 0 || motion.w[k] * motion.w[k + 1] <= 0.0) continue;
    const double w = 0.5 * (motion.w[k] + motion.w[k + 1]);
    const double acceleration = (motion.w[k + 1] - motion.w[k]) / prepared.period_s;
    sim::DriveState here = state;
    here.x = 0.5 * (motion.x[k] + motion.x[k + 1]);
    here.w = w;
    samples.row.push_back(k);
    samples.t_s.push_back(t_s);
    samples.x.push_back(here.x);
    samples.w.push_back(w);
    samples.acceleration.push_back(acceleration);
    samples.effort.push_back(effort);
    samples.missing.push_back(drive.inertia * acceleration + drive.sliding_effort(here, effort, t_s) - effort);
    if (tach) samples.tach_error.push_back(prepared.record->w[k + 1] - drive.tachometer(state));
  }
  return samples;
}

ResidualSamples residual_samples(const sim::DriveDescription& model, const RecordSet& set, std::size_t stride) {
  ResidualSamples all;
  for (const ComparedRecord& compared : set.records) {
    const ResidualSamples part = residual_samples(model, compared.prepared, stride);
    all.row.insert(all.row.end(), part.row.begin(), part.row.end());
    for (const auto channel :
         {&ResidualSamples::t_s, &ResidualSamples::x, &ResidualSamples::w, &ResidualSamples::acceleration,
          &ResidualSamples::effort, &ResidualSamples::missing, &ResidualSamples::tach_error})
      (all.*channel).insert((all.*channel).end(), (part.*channel).begin(), (part.*channel).end());
  }
  return all;
}

}  // namespace host
