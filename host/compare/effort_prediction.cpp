#include "host/compare/effort_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/inverse_model.hpp"
#include "host/identify/zero_phase_filter.hpp"

namespace host {

namespace {

bool slides_only(const Motion& motion) { return motion.deadband > 0.0; }

/// Applies the guard filter of a record that a regression decimates.
void guard(const Motion& motion, std::vector<double>& signal) {
  if (motion.decimation > 1)
    signal = ZeroPhaseLowPass::chebyshev(guard_cutoff_Hz(motion), motion.sample_rate_Hz)(signal);
}

void pad(std::vector<double>& signal) {
  signal.insert(signal.begin(), kMotionMargin, 0.0);
  signal.insert(signal.end(), kMotionMargin, 0.0);
}

}  // namespace

EffortRecord prepare_effort(const Record& record, const sim::DriveDescription& base) {
  EffortRecord prepared{&record, base.data, prepare_motion(record, base.data, {}), {}, 0.0};
  const Motion& motion = prepared.motion;
  const double bandwidth_Hz = motion.decimation > 1 ? guard_cutoff_Hz(motion) : motion.cutoff_Hz;
  prepared.floor = std::max(
      sim::Drive(base).inertia * std::sqrt(AccelerationNoise(record, base.data).variance_below(bandwidth_Hz)), 1e-12);
  prepared.counts.assign(record.size(), false);
  const auto reach = static_cast<std::size_t>(std::ceil(motion.sample_rate_Hz / bandwidth_Hz));
  for (std::size_t k = reach; k + reach < motion.speed.size(); ++k)
    prepared.counts[k + kMotionMargin] = slides_only(motion) ? motion.counts[k] : true;
  return prepared;
}

void predict_effort(const sim::Drive& drive, const EffortRecord& prepared, EffortPrediction& out) {
  const Motion& motion = prepared.motion;
  out.needed = inverse_effort(drive, motion);
  out.given = delivered_effort(*prepared.record, prepared.data, motion.cutoff_Hz, slides_only(motion), &drive).effort;
  guard(motion, out.given);
  guard(motion, out.needed);
  pad(out.needed);
}

}  // namespace host
