#include "host/scale/driven_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace host {

namespace {

/// Values at every sample, mm: table minus motor, and the part of it in the spring.
struct DrivenSamples {
  std::vector<double> all, spring;
};

/// Number of tables that are simulated in parallel (SIMD). The code has no branches, because their directions would
/// differ.
constexpr std::size_t kAbreast = 8;
using Abreast = Eigen::Array<double, kAbreast, 1>;

/// The values of one member for drives[first] and the following ones. If there are too few, the last one is repeated.
Abreast abreast(std::span<const TableDrive> drives, std::size_t first, double TableDrive::*member) {
  Abreast values;
  for (std::size_t lane = 0; lane < kAbreast; ++lane)
    values(static_cast<Eigen::Index>(lane)) = drives[std::min(first + lane, drives.size() - 1)].*member;
  return values;
}

/// The part of a value outside a band about zero.
[[gnu::always_inline]] inline Abreast beyond(const Abreast& value, const Abreast& band) {
  return value - value.min(band).max(-band);
}

/// A contact without a spring: while they touch, the table has the speed of the motor. It slides on when the motor
/// decelerates more than the table.
void rigid(std::span<const TableDrive> drives, std::size_t first, const std::vector<double>& motor, double period_s,
           std::span<DrivenSamples> found) {
  const Abreast half = 0.5 * abreast(drives, first, &TableDrive::gap),
                deceleration = abreast(drives, first, &TableDrive::deceleration),
                drag = abreast(drives, first, &TableDrive::drag);
  Abreast table = Abreast::Constant(motor.front()), speed = Abreast::Zero();
  for (std::size_t k = 0; k < motor.size(); ++k) {
    const std::size_t low = k == 0 ? 0 : k - 1, high = std::min(k + 1, motor.size() - 1);
    const double at = motor[k], motor_speed = (motor[high] - motor[low]) / (static_cast<double>(high - low) * period_s);
    const Abreast before = speed;
    if (k > 0) speed = beyond(before, period_s * (deceleration + drag * before.abs()));
    const Abreast free = table + 0.5 * period_s * (before + speed) - at, pushed = beyond(free, half);
    table = at + free - pushed;
    speed = (pushed < 0.0).select(speed.max(motor_speed), (pushed > 0.0).select(speed.min(motor_speed), speed));
    for (std::size_t lane = 0; lane < found.size(); ++lane)
      found[lane].all[k] = table(static_cast<Eigen::Index>(lane)) - at;
  }
}

/// Semi-implicit steps of at most a quarter of a radian. Friction can only reduce the speed to zero and then holds the
/// table.
void sprung(std::span<const TableDrive> drives, std::size_t first, const std::vector<double>& motor, double period_s,
            std::span<DrivenSamples> found) {
  constexpr double kRadians = 0.25, kAnyPull = 1e30;
  const Abreast half = 0.5 * abreast(drives, first, &TableDrive::gap),
                stiffness = abreast(drives, first, &TableDrive::lag).inverse(), omega = stiffness.sqrt(),
                damping = 2.0 * omega * abreast(drives, first, &TableDrive::damping),
                deceleration = abreast(drives, first, &TableDrive::deceleration),
                drag = abreast(drives, first, &TableDrive::drag);
  // With a gap, the contact only pushes; a bolted connection also pulls.
  const Abreast bolted = (half > 0.0).select(Abreast::Zero(), Abreast::Constant(kAnyPull));
  const int parts = std::max(1, static_cast<int>(std::ceil(omega.maxCoeff() * period_s / kRadians)));
  const double step = period_s / parts;
  Abreast table = Abreast::Constant(motor.front()), speed = Abreast::Zero();
  for (std::size_t k = 0; k < motor.size(); ++k) {
    const Abreast ahead = motor[k] - table, bent = beyond(ahead, half);
    for (std::size_t lane = 0; lane < found.size(); ++lane) {
      found[lane].all[k] = -ahead(static_cast<Eigen::Index>(lane));
      found[lane].spring[k] = -bent(static_cast<Eigen::Index>(lane));
    }
    if (k + 1 == motor.size()) break;
    const double motor_speed = (motor[k + 1] - motor[k]) / period_s;
    for (int part = 0; part < parts; ++part) {
      const Abreast bends = beyond(motor[k] + motor_speed * step * part - table, half), limit = kAnyPull * bends;
      const Abreast pull =
          (stiffness * bends + damping * (motor_speed - speed)).min(limit.max(bolted)).max(limit.min(-bolted));
      speed = beyond(speed + step * pull, step * (deceleration + drag * speed.abs()));
      table += step * speed;
    }
  }
}

/// Delays the values by this time, mm.
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
  // The table has the larger part of the friction and any part of the inertia, so its deceleration is up to several
  // times that of the whole drive. Guideways decelerate a table by a few 1/s; a bolted contact has a damping ratio of
  // some hundredths (textbook).
  const bool is_known = deceleration > 0.0;
  std::vector<DriveRange> ranges = {{DriveNumber::deceleration, std::log(1.0), std::log(1e5), 0.03,
                                     std::log(is_known ? 2.0 * deceleration : 1e3), is_known ? 0.7 : 2.0},
                                    {DriveNumber::drag, 0.0, 50.0, 0.3, 0.0, 5.0}};
  if (!(drive.lag > 0.0)) return ranges;
  ranges.push_back({DriveNumber::damping, std::log(0.005), std::log(1.0), 0.03, std::log(0.05), 0.7});
  ranges.push_back({DriveNumber::late, -1.0, 1.0, 0.03, 0.0, 0.3});
  return ranges;
}

double prior_cost(const TableDrive& drive, const std::vector<DriveRange>& numbers) {
  double cost = 0.0;
  for (const DriveRange& one : numbers) cost += std::pow((number_of(drive, one.which) - one.middle) / one.deviation, 2);
  return cost;
}

std::vector<DrivenRows> drive_tables(std::span<const TableDrive> drives, const TableRows& rows) {
  std::vector<DrivenRows> found(drives.size());
  const bool has_spring = drives.front().lag > 0.0;
  for (std::size_t first = 0; first < drives.size(); first += kAbreast) {
    const std::size_t count = std::min(kAbreast, drives.size() - first);
    std::array<Eigen::VectorXd, kAbreast> spring;
    for (std::size_t lane = 0; lane < count; ++lane) {
      found[first + lane].all.resize(rows.size());
      spring[lane].setZero(rows.size());
    }
    for (const TableRecord& one : rows.records) {
      const double period_s = one.record->sample_period_s;
      std::array<DrivenSamples, kAbreast> samples;
      for (std::size_t lane = 0; lane < count; ++lane)
        samples[lane] = {std::vector<double>(one.pusher.size()),
                         std::vector<double>(has_spring ? one.pusher.size() : 0)};
      (has_spring ? sprung : rigid)(drives, first, one.pusher, period_s, std::span(samples).first(count));
      for (std::size_t lane = 0; lane < count; ++lane) {
        const double late_s = drives[first + lane].late_s;
        delay(samples[lane].all, late_s, period_s);
        one.put_means(samples[lane].all, found[first + lane].all);
        if (!has_spring) continue;
        delay(samples[lane].spring, late_s, period_s);
        one.put_means(samples[lane].spring, spring[lane]);
      }
    }
    for (std::size_t lane = 0; lane < count; ++lane) {
      const TableDrive& drive = drives[first + lane];
      DrivenRows& of_drive = found[first + lane];
      if (drive.gap > 0.0) of_drive.gap = (of_drive.all - spring[lane]) / drive.gap;
      if (has_spring) of_drive.pull = spring[lane] / drive.lag;
      of_drive.all *= 1e3;
    }
  }
  return found;
}

}  // namespace host
