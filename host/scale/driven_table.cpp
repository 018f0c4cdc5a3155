#include "host/scale/driven_table.hpp"

#include <algorithm>
#include <cmath>

namespace host {

namespace {

/// At every sample, mm: the table less the motor, and what of it is the spring's.
struct DrivenSamples {
  std::vector<double> all, spring;
};

double slowed(double speed, double by) { return std::copysign(std::max(std::abs(speed) - by, 0.0), speed); }

/// A contact without a spring: the table has the motor's speed where they touch, and slides on from there when the
/// motor slows down more.
DrivenSamples rigid(const TableDrive& drive, const std::vector<double>& motor, double period_s) {
  DrivenSamples found{std::vector<double>(motor.size()), {}};
  const double half = 0.5 * drive.gap;
  double table = motor.front(), speed = 0.0;
  for (std::size_t k = 0; k < motor.size(); ++k) {
    const std::size_t low = k == 0 ? 0 : k - 1, high = std::min(k + 1, motor.size() - 1);
    const double at = motor[k], motor_speed = (motor[high] - motor[low]) / (static_cast<double>(high - low) * period_s);
    const double before = speed;
    if (k > 0) speed = slowed(speed, period_s * (drive.deceleration + drive.drag * std::abs(speed)));
    table += 0.5 * (before + speed) * period_s;
    if (table < at - half) {
      table = at - half;
      speed = std::max(speed, motor_speed);
    } else if (table > at + half) {
      table = at + half;
      speed = std::min(speed, motor_speed);
    }
    found.all[k] = table - at;
  }
  return found;
}

/// Semi-implicit steps of a quarter of a radian at most; friction takes speed away at most, and then holds.
DrivenSamples sprung(const TableDrive& drive, const std::vector<double>& motor, double period_s) {
  DrivenSamples found{std::vector<double>(motor.size()), std::vector<double>(motor.size())};
  constexpr double kRadians = 0.25;
  const double stiffness = 1.0 / drive.lag, omega = std::sqrt(stiffness), damping = 2.0 * drive.damping * omega;
  const int parts = std::max(1, static_cast<int>(std::ceil(omega * period_s / kRadians)));
  const double step = period_s / parts, half = 0.5 * drive.gap;
  double table = motor.front(), speed = 0.0;
  for (std::size_t k = 0; k < motor.size(); ++k) {
    const double ahead = motor[k] - table;
    found.all[k] = -ahead;
    found.spring[k] = std::clamp(ahead, -half, half) - ahead;
    if (k + 1 == motor.size()) break;
    const double motor_speed = (motor[k + 1] - motor[k]) / period_s;
    for (int part = 0; part < parts; ++part) {
      const double bend = motor[k] + motor_speed * step * part - table, bent = bend - std::clamp(bend, -half, half);
      double pull = 0.0;
      if (bent != 0.0) {
        pull = stiffness * bent + damping * (motor_speed - speed);
        if (half > 0.0 && pull * bent < 0.0) pull = 0.0;
      }
      const double pulled = speed + step * pull;
      speed = slowed(pulled, step * (drive.deceleration + drive.drag * std::abs(speed)));
      table += step * speed;
    }
  }
  return found;
}

/// What is read so much later, mm.
void delay(std::vector<double>& values, double late_s, double period_s) {
  if (late_s == 0.0 || values.size() < 3) return;
  const std::vector<double> before = values;
  for (std::size_t k = 1; k + 1 < values.size(); ++k)
    values[k] -= late_s * (before[k + 1] - before[k - 1]) / (2.0 * period_s);
}

}  // namespace

double number_of(const TableDrive& drive, DriveNumber which) {
  switch (which) {
    case DriveNumber::gap:
      return std::log(drive.gap);
    case DriveNumber::lag:
      return std::log(drive.lag);
    case DriveNumber::deceleration:
      return std::log(drive.deceleration);
    case DriveNumber::damping:
      return std::log(drive.damping);
    case DriveNumber::drag:
      return drive.drag;
    default:
      return 1e3 * drive.late_s;
  }
}

void set_number(TableDrive& drive, DriveNumber which, double value) {
  switch (which) {
    case DriveNumber::gap:
      drive.gap = std::exp(value);
      break;
    case DriveNumber::lag:
      drive.lag = std::exp(value);
      break;
    case DriveNumber::deceleration:
      drive.deceleration = std::exp(value);
      break;
    case DriveNumber::damping:
      drive.damping = std::exp(value);
      break;
    case DriveNumber::drag:
      drive.drag = value;
      break;
    default:
      drive.late_s = 1e-3 * value;
  }
}

std::vector<DriveRange> shape_ranges(const TableDrive& drive, double deceleration) {
  // A table has the larger part of the friction and any part of the inertia: its deceleration is within some times that
  // of the whole drive. Guideways slow a table by a few 1/s; a bolted contact is damped by some hundredths (textbook).
  const bool is_known = deceleration > 0.0;
  std::vector<DriveRange> ranges = {{DriveNumber::deceleration, std::log(1.0), std::log(1e5), 0.03,
                                     std::log(is_known ? 2.0 * deceleration : 1e3), is_known ? 0.7 : 2.0},
                                    {DriveNumber::drag, 0.0, 50.0, 0.3, 0.0, 5.0}};
  if (!(drive.lag > 0.0)) return ranges;
  ranges.push_back({DriveNumber::damping, std::log(0.005), std::log(1.0), 0.03, std::log(0.05), 0.7});
  ranges.push_back({DriveNumber::late, -1.0, 1.0, 0.03, 0.0, 0.3});
  return ranges;
}

DrivenRows drive_table(const TableDrive& drive, const TableRows& rows) {
  DrivenRows found;
  found.all.resize(rows.size());
  Eigen::VectorXd spring = Eigen::VectorXd::Zero(rows.size());
  for (const TableRecord& one : rows.records) {
    const double period_s = one.record->sample_period_s;
    DrivenSamples samples = drive.lag > 0.0 ? sprung(drive, one.pusher, period_s) : rigid(drive, one.pusher, period_s);
    delay(samples.all, drive.late_s, period_s);
    delay(samples.spring, drive.late_s, period_s);
    one.put_means(samples.all, found.all);
    if (drive.lag > 0.0) one.put_means(samples.spring, spring);
  }
  if (drive.gap > 0.0) found.gap = (found.all - spring) / drive.gap;
  if (drive.lag > 0.0) found.pull = spring / drive.lag;
  found.all *= 1e3;
  return found;
}

Eigen::VectorXd slope_of(const TableDrive& drive, DriveNumber which, double step, const TableRows& rows,
                         const Eigen::VectorXd& all) {
  TableDrive moved = drive;
  set_number(moved, which, number_of(drive, which) + step);
  return (drive_table(moved, rows).all - all) / step;
}

}  // namespace host
