#include "host/effort/effort_rows.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/effort/effort_terms.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/encoder_step.hpp"
#include "host/identify/motion.hpp"
#include "host/identify/repeated_counts.hpp"
#include "host/identify/smooth_acceleration.hpp"
#include "host/identify/zero_phase_filter.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// At speeds below this part of a record's 95 % quantile the axis may stick, and the force balance does not hold.
constexpr double kSlidingShare = 0.01;
/// The speed is steady if it changes within a record by less than this part of its median. Friction then hardly
/// changes.
constexpr double kSteadyShare = 0.5;
/// The acceleration is negligible if it needs less than this part of the torque or force.
constexpr double kIdleShare = 0.3;
constexpr double kBlock_s = 0.5;
/// Least total time of sliding motion, s.
constexpr double kLeastSliding_s = 0.2;

/// Whether a record has one speed per direction, so that the inertia hardly matters. Starts and reversals take at most
/// a tenth at either end of the distribution of speeds; a second speed or a slow run-up takes more.
bool is_steady(const std::vector<double>& speed, double slow, double inertia, const std::vector<double>& acceleration,
               const std::vector<double>& effort) {
  std::vector<double> speeds[2];
  double inertial = 0.0, efforts = 0.0;
  for (std::size_t k = 0; k < speed.size(); ++k) {
    if (std::abs(speed[k]) <= slow) continue;
    speeds[speed[k] > 0.0 ? 0 : 1].push_back(std::abs(speed[k]));
    inertial += std::pow(inertia * acceleration[k], 2);
    efforts += effort[k] * effort[k];
  }
  constexpr double kStarts = 0.1;
  for (const std::vector<double>& side : speeds)
    if (!side.empty() && quantile(side, 1.0 - kStarts) - quantile(side, kStarts) > kSteadyShare * quantile(side, 0.5))
      return false;
  return inertial <= kIdleShare * kIdleShare * efforts;
}

/// Cut-off frequency: as high as the sampling allows, but lowered until the sensor noise is a hundredth of the torque
/// or force.
double cutoff_of(const Record& record, const AccelerationNoise& sensor, double inertia, double effort) {
  constexpr double kHighest_Hz = 120.0, kRateShare = 0.125, kNoiseShare = 0.01, kStep = 0.85, kLowest_Hz = 10.0;
  const double rate_Hz = 1.0 / record.sample_period_s;
  double cutoff_Hz = std::min(kHighest_Hz, kRateShare * rate_Hz);
  while (cutoff_Hz * kStep >= std::min(kLowest_Hz, rate_Hz / 50.0) &&
         inertia * std::sqrt(sensor.variance_below(cutoff_Hz)) > kNoiseShare * effort)
    cutoff_Hz *= kStep;
  return cutoff_Hz;
}

/// Response of the smoothed acceleration to one reading, one value per sample.
std::vector<double> acceleration_of_a_reading(const ZeroPhaseLowPass& low_pass, double rate_Hz, double cutoff_Hz) {
  constexpr double kReach = 2.0;  // periods of the cut-off
  const auto reach = static_cast<std::size_t>(std::ceil(kReach * rate_Hz / cutoff_Hz));
  std::vector<double> reading(2 * reach + 1, 0.0);
  reading[reach] = 1.0;
  const std::vector<double> low = low_pass(reading);
  std::vector<double> response(low.size(), 0.0);
  for (std::size_t k = 1; k + 1 < low.size(); ++k) response[k] = low[k + 1] - 2.0 * low[k] + low[k - 1];
  return response;
}

struct Builder {
  const sim::DriveDescription& model;
  const sim::Drive* path;  ///< the model's effects in the command path
  bool by_speed;
  double inertia;
  std::vector<std::vector<double>> columns = std::vector<std::vector<double>>(6);
  EffortRows rows{};
  double noise = 0.0;
  std::size_t blocks = 0;

  void add(const RecordSet& set, bool judges, std::size_t stride) {
    for (const ComparedRecord& compared : set.records)
      if (!compared.prepared.windows.empty()) add(compared.prepared, judges, stride);
  }

  void add(const PreparedRecord& prepared, bool judges, std::size_t extra_stride) {
    const Record& record = *prepared.record;
    const double rate_Hz = 1.0 / record.sample_period_s;
    const double size = root_mean_square(motor_effort(record, model.data));
    const AccelerationNoise sensor(record, model.data, by_speed);
    EffortSignals signals{&record, record.sample_period_s, cutoff_of(record, sensor, inertia, size), {}, {}, {},
                          {},      columns[0].size()};
    const auto low_pass = ZeroPhaseLowPass::butterworth(signals.cutoff_Hz, rate_Hz);
    const std::vector<double> speed = smooth_speed(record, model.data, signals.cutoff_Hz, by_speed);
    const std::vector<double> travel =
        record.has_position() ? low_pass(record.x) : std::vector<double>(record.size(), 0.0);
    const std::vector<double> effort = delivered_effort(record, model.data, signals.cutoff_Hz, true, path).effort;
    const double timing_deviation = effort_timing_of(record).deviation;
    const bool is_timed = timing_deviation == 0.0;
    rows.timing_deviation = std::max(rows.timing_deviation, timing_deviation);
    rows.commanded = rows.commanded && !record.u_V.empty();
    signals.motion = record.has_position() ? travel : speed;
    signals.speed = speed;
    signals.acceleration = smooth_acceleration(record, model.data, signals.cutoff_Hz, by_speed, speed);

    std::vector<double> sizes(speed.size());
    std::ranges::transform(speed, sizes.begin(), [](double w) { return std::abs(w); });
    const double step = by_speed ? 0.0 : encoder_step(record, model.data) * signals.cutoff_Hz / model.data.lead;
    const double high = quantile(sizes, 0.95), slow = std::max(kSlidingShare * high, step);
    const auto reach = static_cast<std::size_t>(std::ceil(0.5 * rate_Hz / signals.cutoff_Hz)) + 2;
    const auto stride =
        extra_stride * std::max<std::size_t>(1, static_cast<std::size_t>(rate_Hz / (4.0 * signals.cutoff_Hz)));
    std::vector<std::size_t> run(speed.size(), 0);
    for (std::size_t k = 1; k < speed.size(); ++k)
      run[k] = sizes[k] > slow ? (speed[k] * speed[k - 1] > 0.0 ? run[k - 1] : 0) + 1 : 0;
    std::size_t in_block = 0;
    const auto rows_a_block =
        std::max<std::size_t>(4, static_cast<std::size_t>(kBlock_s * rate_Hz / static_cast<double>(stride)));
    for (const Window& window : prepared.windows) {
      for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k) {
        if (k % stride != 0 || k < reach || k + reach >= speed.size() || run[k + reach] <= 2 * reach) continue;
        signals.kept.push_back(k);
        const double change = is_timed ? 0.0 : 0.5 * (effort[k + 1] - effort[k - 1]);
        const double values[] = {record.t_s[k], travel[k], speed[k], signals.acceleration[k], effort[k], change};
        for (std::size_t c = 0; c < 6; ++c) columns[c].push_back(values[c]);
        rows.judges.push_back(judges);
        rows.record.push_back(rows.signals.size());
        if (in_block++ % rows_a_block == 0) ++blocks;
        rows.block.push_back(blocks);
      }
    }
    ++blocks;
    if (!judges && !is_steady(speed, slow, inertia, signals.acceleration, effort)) rows.steady = false;
    const double variance = inertia * inertia * sensor.variance_below(signals.cutoff_Hz);
    std::vector<double> alike(record.size(), 1.0);
    if (const double count = by_speed ? 0.0 : encoder_step(record, model.data); count > 0.0)
      alike = repeated_counts(travel, count, acceleration_of_a_reading(low_pass, rate_Hz, signals.cutoff_Hz));
    for (const std::size_t k : signals.kept) noise += variance * alike[k];
    const double cutoff_Hz = signals.cutoff_Hz;
    rows.lowest_cutoff_Hz = rows.signals.empty() ? cutoff_Hz : std::min(rows.lowest_cutoff_Hz, cutoff_Hz);
    rows.signals.push_back(std::move(signals));
  }

  EffortRows finish() {
    Eigen::VectorXd* const targets[] = {&rows.t_s,          &rows.x,      &rows.w,
                                        &rows.acceleration, &rows.effort, &rows.effort_per_sample};
    for (std::size_t c = 0; c < 6; ++c)
      *targets[c] = Eigen::Map<const Eigen::VectorXd>(columns[c].data(), static_cast<Eigen::Index>(columns[c].size()));
    rows.by_speed = by_speed;
    if (!columns[0].empty()) rows.noise = std::sqrt(noise / static_cast<double>(columns[0].size()));
    return std::move(rows);
  }
};

/// Relative training residual that inertia and friction leave.
double left_by_base(const EffortRows& rows) {
  const auto n = static_cast<Eigen::Index>(std::ranges::count(rows.judges, false));
  Eigen::MatrixXd phi(n, 4);
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0, at = 0; k < rows.w.size(); ++k) {
    if (rows.judges[static_cast<std::size_t>(k)]) continue;
    phi.row(at) << rows.acceleration(k), rows.w(k), rows.w(k) > 0.0 ? 1.0 : 0.0, rows.w(k) > 0.0 ? 0.0 : 1.0;
    y(at++) = rows.effort(k);
  }
  const Eigen::VectorXd theta = least_norm_solution(phi, y);
  return (y - phi * theta).norm() / std::max(y.norm(), 1e-300);
}

EffortRows built(const sim::DriveDescription& model, bool by_speed, const RecordSet& training,
                 const RecordSet& validation, std::size_t most_rows) {
  const sim::EffectEntry* inertia = model.find("inertia");
  const sim::Drive path(standing_part(model));
  std::size_t stride = 1;
  while (true) {
    Builder builder{model, &path, by_speed, inertia == nullptr ? 0.0 : inertia->at("J")};
    builder.add(training, false, stride);
    builder.add(validation, true, stride);
    if (builder.columns[0].size() <= most_rows) {
      EffortRows rows = builder.finish();
      rows.first_stamp_s = first_stamp_s(training);
      rows.lead = model.data.lead;
      return rows;
    }
    stride *= 1 + builder.columns[0].size() / most_rows;
  }
}

bool enough(const EffortRows& rows, bool judges) {
  double seconds = 0.0;
  for (std::size_t r = 0; r < rows.signals.size(); ++r) {
    const auto& kept = rows.signals[r].kept;
    if (kept.size() < 2 || rows.judges[rows.signals[r].first_row] != judges) continue;
    const std::size_t stride = kept[1] - kept[0];
    seconds += static_cast<double>(kept.size() * stride) * rows.signals[r].period_s;
  }
  constexpr std::ptrdiff_t kFewest = 20;
  return seconds >= kLeastSliding_s && std::ranges::count(rows.judges, judges) >= kFewest;
}

}  // namespace

double most_noise(const EffortRows& rows, bool judges) {
  // The spacing of the rows is a quarter of the cut-off's period, so two rows make one independent value. The RMS of n
  // such values has a relative standard deviation of 1/sqrt(2 n).
  const auto count = static_cast<double>(std::ranges::count(rows.judges, judges));
  return rows.noise * (1.0 + 2.0 / std::sqrt(std::max(count, 1.0)));
}

double root_mean_square(const EffortRows& rows, const Eigen::VectorXd& values, bool judges) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (rows.judges[row] != judges) continue;
    sum += values(k) * values(k);
    count += 1.0;
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

Eigen::VectorXd travel_since_reversal(const EffortRows& rows) {
  Eigen::VectorXd travelled = Eigen::VectorXd::Zero(rows.w.size());
  for (const EffortSignals& signals : rows.signals) {
    std::size_t next = 0;
    double turned = signals.motion.empty() ? 0.0 : signals.motion.front(), heading = 0.0;
    for (std::size_t k = 1; k < signals.motion.size() && next < signals.kept.size(); ++k) {
      const double step = signals.motion[k] - signals.motion[k - 1];
      if (step * heading < 0.0) turned = signals.motion[k - 1];
      if (step != 0.0) heading = step > 0.0 ? 1.0 : -1.0;
      if (signals.kept[next] == k)
        travelled(static_cast<Eigen::Index>(signals.first_row + next++)) = std::abs(signals.motion[k] - turned);
    }
  }
  return travelled;
}

EffortRows effort_rows(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                       std::size_t most_rows) {
  bool position = true, speed = true;
  for (const RecordSet* set : {&training, &validation})
    for (const ComparedRecord& compared : set->records) {
      position = position && compared.prepared.record->has_position();
      speed = speed && compared.prepared.record->has_speed();
    }
  EffortRows rows;
  if (!position && !speed) return {};
  try {
    rows = built(model, !position, training, validation, most_rows);
    if (position && speed && enough(rows, false)) {
      EffortRows other = built(model, true, training, validation, most_rows);
      if (enough(other, false) && left_by_base(other) < kClearlyBetterBySpeed * left_by_base(rows))
        rows = std::move(other);
    }
  } catch (const Failure&) {  // no torque or force, or too short for the filter
    return {};
  }
  rows.has_position = position;
  if (!enough(rows, false) || !enough(rows, true)) return {};
  return rows;
}

ThinnedRows thinned(const EffortRows& rows, std::size_t stride) {
  ThinnedRows thin;
  thin.rows = rows;
  thin.rows.judges.clear();
  thin.rows.block.clear();
  thin.rows.record.clear();
  for (EffortSignals& signals : thin.rows.signals) {
    std::vector<std::size_t> kept;
    const std::size_t first = thin.from.size();
    for (std::size_t k = 0; k < signals.kept.size(); k += stride) {
      kept.push_back(signals.kept[k]);
      thin.from.push_back(static_cast<Eigen::Index>(signals.first_row + k));
    }
    signals.kept = std::move(kept);
    signals.first_row = first;
  }
  for (const Eigen::Index k : thin.from) {
    const auto row = static_cast<std::size_t>(k);
    thin.rows.judges.push_back(rows.judges[row]);
    thin.rows.block.push_back(rows.block[row]);
    thin.rows.record.push_back(rows.record[row]);
  }
  for (auto* values : {&thin.rows.t_s, &thin.rows.x, &thin.rows.w, &thin.rows.acceleration, &thin.rows.effort,
                       &thin.rows.effort_per_sample})
    *values = thin.of(*values);
  return thin;
}

Eigen::VectorXd ThinnedRows::spread(const Eigen::VectorXd& values, Eigen::Index all) const {
  Eigen::VectorXd spread(all);
  for (std::size_t n = 0; n < from.size(); ++n) {
    const Eigen::Index next = n + 1 < from.size() ? from[n + 1] : all;
    spread.segment(from[n], next - from[n]).setConstant(values(static_cast<Eigen::Index>(n)));
  }
  return spread;
}

void take_mean_speeds(EffortRows& rows) {
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> sums(rows.signals.size(), 0.0), counts(rows.signals.size(), 0.0);
    const auto each = [&](auto use) {
      for (Eigen::Index k = 0; k < rows.w.size(); ++k)
        if (rows.w(k) * sign > 0.0) use(k, rows.record[static_cast<std::size_t>(k)]);
    };
    each([&](Eigen::Index k, std::size_t r) {
      sums[r] += rows.w(k);
      counts[r] += 1.0;
    });
    each([&](Eigen::Index k, std::size_t r) { rows.w(k) = sums[r] / counts[r]; });
  }
  rows.acceleration.setZero();
  rows.effort_per_sample.setZero();
}

}  // namespace host
