#include "host/scale/table_rows.hpp"

#include <algorithm>
#include <cmath>

#include "host/evidence/smoothed_motion.hpp"
#include "host/identify/encoder_step.hpp"
#include "host/identify/motion.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// More rows add no information about some dozen factors.
constexpr std::size_t kMostTableRows = 2400;

double mm_of(const Record& record) { return record.kind == sim::DriveKind::linear ? 1e3 : 1.0; }

/// The smallest change of a sensor, mm; 0 if it never changes.
double step_of(const std::vector<double>& values, double mm) {
  double step = HUGE_VAL;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (const double change = std::abs(values[k] - values[k - 1]) * mm; change > 1e-9) step = std::min(step, change);
  return std::isfinite(step) ? step : 0.0;
}

/// The travel of the motor.
struct MotorTravel {
  std::vector<double> x;   ///< mm
  double deviation = 0.0;  ///< mm RMS
};

/// The smoothed travel, at most half a count from the reading, because a simulated contact would oscillate at every
/// step of the counts. If record and model give no force, the readings themselves.
MotorTravel travel_between_counts(const Record& record, const sim::DriveDescription& model, double step) {
  MotorTravel travel{record.x, step / std::sqrt(12.0)};
  if (model.find("inertia") != nullptr && model.data.effort_per_volt() > 0.0 &&
      !(record.u_V.empty() && record.i_A.empty())) {
    const MotionSmoother smoother(record, model);
    const SmoothedMotion& motion = smoother.motion();
    double variance = 0.0;
    for (std::size_t k = 0; k < travel.x.size(); ++k) {
      travel.x[k] = std::clamp(motion.x[k], record.x[k] - 0.5 * step, record.x[k] + 0.5 * step);
      variance += motion.x_variance[k] / static_cast<double>(travel.x.size());
    }
    travel.deviation = std::min(travel.deviation, std::sqrt(variance));
  }
  for (double& x : travel.x) x *= mm_of(record);
  travel.deviation *= mm_of(record);
  return travel;
}

/// Mean speed and acceleration of each row, from the values at its two ends. The interval is the row itself, because
/// the torque or force of the row is also a mean over it.
void differentiate(TableRows& rows, const TableRecord& one) {
  const std::vector<double>& x = one.pusher;
  const double period_s = one.record->sample_period_s, row_s = period_s * static_cast<double>(one.stride);
  const std::size_t half = std::max<std::size_t>(1, one.stride / 4), last = x.size() - 1;
  const auto speed_at = [&](std::size_t sample) {
    const std::size_t low = sample - std::min(sample, half), high = std::min(sample + half, last);
    return (x[high] - x[low]) / (static_cast<double>(high - low) * period_s);
  };
  for (Index k = 0; k < one.rows; ++k) {
    const std::size_t begin = static_cast<std::size_t>(k) * one.stride, end = std::min(begin + one.stride, last);
    rows.v(one.first_row + k) = (x[end] - x[begin]) / (static_cast<double>(end - begin) * period_s);
    rows.a(one.first_row + k) = (speed_at(end) - speed_at(begin)) / row_s;
  }
}

/// A reversal counts after two steps of the encoder.
void note_travel(TableRows& rows, const TableRecord& one, double step) {
  double turned = rows.x(one.first_row), farthest = turned, way = 0.0;
  for (Index k = one.first_row; k < one.first_row + one.rows; ++k) {
    const double x = rows.x(k);
    if (way == 0.0 && std::abs(x - turned) > 2.0 * step) way = x > turned ? 1.0 : -1.0;
    if (way * (x - farthest) > 0.0) farthest = x;
    if (way != 0.0 && way * (farthest - x) > 2.0 * step) {
      turned = std::exchange(farthest, x);
      way = -way;
    }
    rows.since(k) = std::abs(x - turned);
    rows.way(k) = way == 0.0 ? 1.0 : way;
  }
}

}  // namespace

void TableRecord::put_means(const std::vector<double>& samples, VectorXd& of_all_rows) const {
  const Eigen::Map<const Eigen::MatrixXd> by_row(samples.data(), static_cast<Index>(stride), rows);
  of_all_rows.segment(first_row, rows) = by_row.colwise().mean().transpose();
}

VectorXd TableRows::means(const std::function<std::vector<double>(const TableRecord&)>& of) const {
  VectorXd all(size());
  for (const TableRecord& one : records) one.put_means(of(one), all);
  return all;
}

void TableRows::differentiate_pusher() {
  for (const TableRecord& one : records) differentiate(*this, one);
}

double rms(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / std::max<double>(1.0, static_cast<double>(values.size())));
}

TableRows table_rows(const std::vector<const Record*>& records, const sim::DriveDescription& model) {
  const sim::DataSheet& data = model.data;
  TableRows rows;
  std::size_t samples = 0;
  bool all_have_temperature = true;
  const auto has_effort = [](const Record* record) { return !record->u_V.empty() || !record->i_A.empty(); };
  const bool wants_effort = std::ranges::any_of(records, has_effort);
  for (const Record* record : records)
    if (record->has_position() && record->has_table_position()) samples += record->size();
  const std::size_t stride = std::max<std::size_t>(1, (samples + kMostTableRows - 1) / kMostTableRows);
  Index count = 0;
  for (const Record* record : records) {
    if (!record->has_position() || !record->has_table_position() || record->size() < 4 * stride) continue;
    if (has_effort(record) != wants_effort) continue;
    TableRecord one{record, record->x, {}, count, static_cast<Index>((record->size() - 1) / stride), stride, {}, {}};
    const double mm = mm_of(*record);
    for (double& x : one.x) x *= mm;
    MotorTravel travel = travel_between_counts(*record, model, encoder_step(*record, data));
    one.motor = std::move(travel.x);
    one.pusher = one.motor;
    if (wants_effort) one.effort = motor_effort(*record, data);
    all_have_temperature = all_have_temperature && !record->temp_C.empty();
    const double steps = std::hypot(std::sqrt(12.0) * travel.deviation, step_of(record->x2, mm));
    rows.step_um = std::max(rows.step_um, 1e3 * steps);
    rows.runs.push_back({count, count + one.rows});
    count += one.rows;
    rows.records.push_back(std::move(one));
  }
  rows.y.resize(count);
  rows.since = rows.way = VectorXd::Zero(count);
  if (count == 0) return rows;
  rows.noise_um = std::max(rows.step_um / std::sqrt(12.0 * static_cast<double>(stride)), 1e-3);
  rows.x = rows.means([](const TableRecord& one) { return one.x; });
  rows.t_s = rows.means([](const TableRecord& one) { return one.record->t_s; });
  rows.y = rows.means([](const TableRecord& one) {
    const double mm = mm_of(*one.record);
    std::vector<double> y(one.x.size());
    for (std::size_t k = 0; k < y.size(); ++k)
      y[k] = 1e3 * (mm * (one.record->x2[k] - one.record->x2[0]) - (one.motor[k] - one.motor[0]));
    return y;
  });
  rows.v = rows.a = VectorXd::Zero(count);
  rows.differentiate_pusher();
  if (wants_effort) rows.effort = rows.means([](const TableRecord& one) { return one.effort; });
  if (all_have_temperature) rows.temp_C = rows.means([](const TableRecord& one) { return one.record->temp_C; });
  for (const TableRecord& one : rows.records)
    note_travel(rows, one, encoder_step(*one.record, data) * mm_of(*one.record));
  return rows;
}

}  // namespace host
