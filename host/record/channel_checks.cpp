#include "host/record/channel_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "host/record/columns.hpp"
#include "host/record/log_fault.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// Least travel that counts as motion, in encoder steps. It is larger than dither of a count or two at rest, and larger
/// than the elastic travel before breakaway in steps of a fine encoder.
constexpr double kMovedSteps = 20.0;
/// If the tachometer shows this travel, any encoder on the axis must show motion: with 0.1 mm/rad (a fine screw) it is
/// 0.05 mm.
constexpr double kSeenTravel_rad = 0.5;
constexpr double kSeenTravel_m = 1e-3;
/// Least speed that counts as motion, in standard deviations of its noise (a tachometer at rest stays within six).
constexpr double kMovedNoise = 10.0;
/// Tachometers and screws agree within a few per cent, so a larger factor than this is a wrong unit.
constexpr double kUnitFactor = 1.5;

[[noreturn]] void fail(const Record& record, const std::string& what) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", record.path, what));
}

std::string_view name_of(const Record& record, std::vector<double> Record::*channel) {
  return name_in_file(record, channel);
}

[[noreturn]] void fail(const Record& record, LogFaultKind kind, std::vector<double> Record::*channel,
                       const std::string& what) {
  const std::string message = fmt::format("{}: {}", record.path, what);
  throw FaultyLog(message, {{kind, std::string(name_of(record, channel)), record.path, 0.0, 0.0, message}});
}

/// "line 4, column x_mm": the place of a channel, or of its value in a row, for messages.
std::string where(const Record& record, std::vector<double> Record::*channel, std::size_t rows_below = 0) {
  if (record.names_line == 0) return fmt::format("column {}", name_of(record, channel));
  return fmt::format("line {}, column {}", record.names_line + rows_below, name_of(record, channel));
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return *high - *low;
}

/// The smallest change of a channel, which is the encoder's step; 0 for a constant channel.
double smallest_step(const std::vector<double>& values) {
  double smallest = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = std::abs(values[k] - values[k - 1]);
    if (step > 0.0 && (smallest == 0.0 || step < smallest)) smallest = step;
  }
  return smallest;
}

/// The coarsest possible step of the position's counter: the smallest change, or the smallest difference between two
/// changes if that is smaller. At a steady speed all changes are large, but they differ by single steps.
double coarsest_step(const std::vector<double>& values) {
  double coarsest = smallest_step(values);
  // Rounds to the digits that the text contains, because finer digits are rounding errors.
  constexpr double kRounding = 1e-6;
  for (std::size_t k = 2; k < values.size(); ++k) {
    const double change = values[k] - values[k - 1], before = values[k - 1] - values[k - 2];
    const double difference = std::abs(change - before);
    if (difference > kRounding * std::max({std::abs(values[k]), std::abs(change), std::abs(before)}))
      coarsest = std::min(coarsest, difference);
  }
  return coarsest;
}

double largest_step(const std::vector<double>& values) {
  double largest = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) largest = std::max(largest, std::abs(values[k] - values[k - 1]));
  return largest;
}

/// Standard deviation of white noise on a channel, from second differences, which motion hardly affects.
double noise_of(const std::vector<double>& values) {
  double squares = 0.0;
  for (std::size_t k = 2; k < values.size(); ++k) {
    const double second = values[k] - 2.0 * values[k - 1] + values[k - 2];
    squares += second * second;
  }
  constexpr double kGain = 6.0;  // 1 + 4 + 1: variance of the second difference of white noise
  return values.size() < 3 ? 0.0 : std::sqrt(squares / kGain / static_cast<double>(values.size() - 2));
}

/// Means over blocks of `length` rows. Rows left over at the end are not used.
std::vector<double> block_means(const std::vector<double>& values, std::size_t length) {
  std::vector<double> means;
  for (std::size_t start = 0; start + length <= values.size(); start += length) {
    double sum = 0.0;
    for (std::size_t k = start; k < start + length; ++k) sum += values[k];
    means.push_back(sum / static_cast<double>(length));
  }
  return means;
}

constexpr std::size_t kBlockRows = 10;

/// Travel by the tachometer relative to its median (an offset is not motion), rad or m: largest minus smallest.
double travel_by_speed(const Record& record) {
  const double rest = median(record.w);
  double travel = 0.0, low = 0.0, high = 0.0;
  for (const double w : record.w) {
    travel += (w - rest) * record.sample_period_s;
    low = std::min(low, travel);
    high = std::max(high, travel);
  }
  return high - low;
}

bool speed_stands_out_of_noise(const Record& record) {
  return record.w.size() >= 2 * kBlockRows &&
         range_of(block_means(record.w, kBlockRows)) > kMovedNoise * noise_of(record.w);
}

bool speed_moves(const Record& record) {
  const double seen = record.kind == sim::DriveKind::rotary ? kSeenTravel_rad : kSeenTravel_m;
  return speed_stands_out_of_noise(record) && travel_by_speed(record) > seen;
}

bool position_moves(const Record& record) {
  return record.has_position() && range_of(record.x) >= kMovedSteps * smallest_step(record.x) && !is_constant(record.x);
}

/// Largest distance of the position from the straight line through its first sample with the slope `slope` per row.
double departure_from_line(const std::vector<double>& x, double slope) {
  double largest = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
    largest = std::max(largest, std::abs(x[k] - x[0] - slope * static_cast<double>(k)));
  return largest;
}

void fail_dead(const Record& record, std::vector<double> Record::*channel, const std::string& contradiction) {
  fail(record, LogFaultKind::dead_channel, channel,
       fmt::format("{}: dead channel: constant at {} in all {} rows while {}; check the wiring and the channel "
                   "assignment, or leave the column out",
                   where(record, channel), (record.*channel)[0], record.size(), contradiction));
}

void check_position_and_speed_alive(const Record& record) {
  if (!record.has_position() || !record.has_speed()) return;
  if (is_constant(record.x) && speed_moves(record))
    fail_dead(record, &Record::x, fmt::format("{} shows motion", name_of(record, &Record::w)));
  if (!is_constant(record.w) || !position_moves(record)) return;
  const double steady =
      record.w[0] == 0.0 ? 0.0 : (record.x.back() - record.x.front()) / static_cast<double>(record.x.size() - 1);
  if (departure_from_line(record.x, steady) >= kMovedSteps * smallest_step(record.x))
    fail_dead(record, &Record::w, fmt::format("{} shows motion", name_of(record, &Record::x)));
}

/// The table's sensor may be mounted in either direction and may have any unit. Backlash, wind-up and pitch errors are
/// much smaller than its travel.
void check_table_position(const Record& record) {
  if (!record.has_table_position() || !position_moves(record)) return;
  if (is_constant(record.x2))
    fail_dead(record, &Record::x2, fmt::format("{} shows motion", name_of(record, &Record::x)));
  const std::vector<double> motor = block_means(record.x, kBlockRows), table = block_means(record.x2, kBlockRows);
  if (motor.size() < 2) return;
  double mm = 0.0, mt = 0.0, tt = 0.0;
  for (std::size_t k = 1; k < motor.size(); ++k) {
    const double by_motor = motor[k] - motor[0], by_table = table[k] - table[0];
    mm += by_motor * by_motor;
    mt += by_motor * by_table;
    tt += by_table * by_table;
  }
  constexpr double kSameMotion = 0.9;
  if (!(mm > 0.0) || !(tt > 0.0) || std::abs(mt) < kSameMotion * std::sqrt(mm) * std::sqrt(tt)) return;
  const double factor = mt / mm;
  if (factor > 1.0 / kUnitFactor && factor < kUnitFactor) return;
  const std::string pair = fmt::format("{}, and {}", where(record, &Record::x2), name_of(record, &Record::x));
  if (factor < 0.0)
    fail(record, LogFaultKind::table_sign, &Record::x2,
         fmt::format("{}: the table's position runs against the motor's (factor {:.4g}); turn the sign of one of them",
                     pair, factor));
  fail(record, LogFaultKind::wrong_unit, &Record::x2,
       fmt::format("{}: a unit cannot be right: the table moves {:.4g} times as far as the motor's position says; "
                   "multiply the column by {:.4g}",
                   pair, factor, 1.0 / factor));
}

bool axis_moves(const Record& record) { return record.has_position() ? position_moves(record) : speed_moves(record); }

/// The path of the axis: its position or, without one, the sum of its speed. Only the shape matters, not the unit.
std::vector<double> path_of(const Record& record) {
  if (record.has_position()) return record.x;
  std::vector<double> path(record.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) path[k] = sum += record.w[k];
  return path;
}

/// The largest rise and the largest fall of a path.
struct Ways {
  double up = 0.0, down = 0.0;
};

Ways longest_ways(const std::vector<double>& path) {
  Ways ways;
  double lowest = path[0], highest = path[0];
  for (const double x : path) {
    lowest = std::min(lowest, x);
    highest = std::max(highest, x);
    ways.up = std::max(ways.up, x - lowest);
    ways.down = std::max(ways.down, highest - x);
  }
  return ways;
}

/// With a constant torque a drive moves in one direction, and without torque it only slows down.
bool motion_contradicts_constant_effort(const Record& record, double effort) {
  const std::vector<double> path = path_of(record);
  const Ways ways = longest_ways(path);
  constexpr double kBothWays = 0.3;  // of the longer way; more than the spring-back of an end stop
  if (std::min(ways.up, ways.down) > kBothWays * std::max(ways.up, ways.down)) return true;
  if (effort != 0.0) return false;
  const std::size_t block = std::max(kBlockRows, path.size() / 20);  // a twentieth of the record
  const double first = std::abs(path[std::min(block, path.size() - 1)] - path[0]);
  double fastest = 0.0;
  for (std::size_t k = block; k < path.size(); ++k) fastest = std::max(fastest, std::abs(path[k] - path[k - block]));
  return first < kBothWays * fastest;
}

void check_effort_alive(const Record& record) {
  if (!axis_moves(record)) return;
  const bool command_is_constant = !record.u_V.empty() && is_constant(record.u_V);
  const bool current_is_constant = !record.i_A.empty() && is_constant(record.i_A);
  if (command_is_constant && motion_contradicts_constant_effort(record, record.u_V[0]))
    fail_dead(record, &Record::u_V, "the axis accelerates or moves in both directions");
  if (current_is_constant && !record.u_V.empty() && !command_is_constant)
    fail_dead(record, &Record::i_A, "u_V varies and the axis moves");
  if (current_is_constant && motion_contradicts_constant_effort(record, record.i_A[0]))
    fail_dead(record, &Record::i_A, "the axis accelerates or moves in both directions");
}

/// Fails if a value is impossible in its unit.
void check_range(const Record& record, std::vector<double> Record::*channel, double low, double high,
                 std::string_view suspicion) {
  const std::vector<double>& values = record.*channel;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k] < low || values[k] > high)
      fail(record, LogFaultKind::wrong_unit, channel,
           fmt::format("{} (t_s = {}): {} cannot be right (range {} … {}): {}; scale it with "
                       "axistool import --map",
                       where(record, channel, k + 1), record.t_s[k], values[k], low, high, suspicion));
}

struct UnitMistake {
  double factor;  ///< recorded speed over true speed
  std::string_view what;
};

using std::numbers::pi;
constexpr UnitMistake kRotaryMistakes[] = {
    {30.0 / pi, "the speed looks like rev/min; multiply it by 2 pi/60 = 0.10472"},
    {0.5 / pi, "the speed looks like rev/s; multiply it by 2 pi = 6.2832"},
    {180.0 / pi, "the speed looks like deg/s; multiply it by pi/180 = 0.017453"},
    {1000.0, "the position looks like m under a name in mm (or the speed like mrad/s); multiply x by 1000"},
    {0.001, "the position looks like um under a name in mm; multiply x by 0.001"},
    {2.0 * pi, "the lead looks like mm/rev instead of mm/rad (or the speed is 2 pi too large); divide by 2 pi"},
};
constexpr UnitMistake kLinearMistakes[] = {
    {1000.0, "one of them is in mm and the other in m; scale the wrong one by 1000"},
    {0.001, "one of them is in mm and the other in m; scale the wrong one by 1000"},
    {1.0 / 60.0, "the speed looks like a value per minute, or x is off by 60; check the time unit"},
    {60.0, "the speed looks like m/min; divide it by 60"},
    {60000.0, "the speed looks like mm/min; divide it by 60000"},
    {1000.0 / 60.0, "the speed looks like m/min under a name in mm/s, or the like; check both units"},
};

std::string_view nearest_mistake(double factor, sim::DriveKind kind) {
  constexpr double kNear = 1.15;  // leads and tachometers are more accurate than this
  const auto nearest = [&](auto& mistakes) -> std::string_view {
    for (const UnitMistake& mistake : mistakes)
      if (std::abs(std::log(factor / mistake.factor)) < std::log(kNear)) return mistake.what;
    return "no common unit error explains it; check both columns and the lead";
  };
  return kind == sim::DriveKind::rotary ? nearest(kRotaryMistakes) : nearest(kLinearMistakes);
}

/// Compares the speed with the derivative of the position (travel = lead * speed * time), block by block.
void check_speed_against_position(const Record& record, double lead) {
  if (!record.has_speed() || !position_moves(record) || !speed_stands_out_of_noise(record)) return;
  std::vector<double> by_position, by_speed;
  for (std::size_t k = kBlockRows; k < record.size(); k += kBlockRows) {
    double sum = 0.5 * (record.w[k - kBlockRows] + record.w[k]);
    for (std::size_t j = k - kBlockRows + 1; j < k; ++j) sum += record.w[j];
    by_speed.push_back(lead * sum * record.sample_period_s);
    by_position.push_back(record.x[k] - record.x[k - kBlockRows]);
  }
  double xx = 0.0, xs = 0.0, ss = 0.0;
  for (std::size_t k = 0; k < by_speed.size(); ++k) {
    xx += by_position[k] * by_position[k];
    xs += by_position[k] * by_speed[k];
    ss += by_speed[k] * by_speed[k];
  }
  constexpr double kClearlyRelated = 0.9;
  if (!(xx > 0.0) || !(ss > 0.0) || std::abs(xs) < kClearlyRelated * std::sqrt(xx) * std::sqrt(ss)) return;
  const double factor = ss / xs;
  if (factor > 1.0 / kUnitFactor && factor < kUnitFactor) return;
  const std::string pair = fmt::format("{}, and {}", where(record, &Record::w), name_of(record, &Record::x));
  if (factor < 0.0)
    fail(record, LogFaultKind::speed_sign, &Record::w,
         fmt::format("{}: the speed runs against the position (factor {:.4g}); invert the sign of one of them", pair,
                     factor));
  fail(record, LogFaultKind::wrong_unit, &Record::w,
       fmt::format("{}: a unit cannot be right: the speed is {:.4g} times the derivative of the position; {}", pair,
                   factor, nearest_mistake(factor, record.kind)));
}

void scale(std::vector<double>& values, sim::DriveKind from, sim::DriveKind to) {
  if (from == to) return;
  for (double& value : values) value = to == sim::DriveKind::rotary ? value * 1000.0 : value / 1000.0;
}

}  // namespace

void check_channels(const Record& record) {
  check_range(record, &Record::u_V, -kLargestCommand_V, kLargestCommand_V,
              "D/A converters and amplifiers accept less; the numbers look like counts or mV");
  check_range(record, &Record::i_A, -kLargestCurrent_A, kLargestCurrent_A, "the numbers look like mA or counts");
  check_range(record, &Record::x, -kFarthest, kFarthest, "no axis is that long; the numbers look like an overflow");
  check_range(record, &Record::x2, -kFarthest, kFarthest, "no axis is that long; the numbers look like an overflow");
  check_range(record, &Record::w, -kFastest, kFastest, "no drive is that fast; the numbers look like an overflow");
  check_range(record, &Record::temp_C, kLowestTemperature_C, kHighestTemperature_C,
              "the numbers look like kelvins or counts");
  check_position_and_speed_alive(record);
  check_table_position(record);
  check_effort_alive(record);
  if (record.kind == sim::DriveKind::linear) check_speed_against_position(record, 1.0);
}

void adapt_to(Record& record, const sim::DataSheet& sheet) {
  if (record.kind != sheet.kind && !record.kind_is_presumed) {
    const auto speed = record.has_speed() ? &Record::w : &Record::w_ref;
    fail(record,
         fmt::format("{}: the speed of a {} drive, but the model is of a {} one; name the right model, or give "
                     "the speed as {}",
                     where(record, speed), record.kind == sim::DriveKind::rotary ? "rotary" : "linear",
                     sheet.kind == sim::DriveKind::rotary ? "rotary" : "linear", column_name(speed, sheet.kind)));
  }
  if (sheet.kind == sim::DriveKind::linear && record.u_V.empty() && !record.i_A.empty() &&
      !(sheet.torque_constant_Nm_per_A > 0.0))
    fail(record,
         "missing column: u_V; the record holds only the current i_A, but this drive's data sheet gives the force per "
         "volt of the command: add force_constant_N_per_A to [drive], or log u_V");
  if (is_known_by_current(sheet)) {
    if (record.i_A.empty() && !record.u_V.empty())
      fail(record,
           fmt::format("missing column: i_A; the record holds the command u_V, but this drive's data sheet gives "
                       "torque or force only for the current: add {} to [drive], or log i_A",
                       sheet.kind == sim::DriveKind::rotary ? "amplifier_gain_A_per_V" : "force_constant_N_per_V"));
    record.u_V.clear();  // its command in volts is unknown
  }
  scale(record.x, record.kind, sheet.kind);
  scale(record.x2, record.kind, sheet.kind);
  scale(record.x_ref, record.kind, sheet.kind);
  record.kind = sheet.kind;
  record.kind_is_presumed = false;
}

void check_units(const Record& record, const sim::DataSheet& sheet) {
  constexpr double kBeyondRange = 20.0;  // a command may exceed the converter's range, but not by that much
  if (sheet.dac_limit_V > 0.0)
    check_range(record, &Record::u_V, -kBeyondRange * sheet.dac_limit_V, kBeyondRange * sheet.dac_limit_V,
                "far beyond the range of the model's D/A converter; the numbers look like counts or mV");
  check_speed_against_position(record, sheet.lead);
  if (!(sheet.encoder_resolution > 0.0) || !position_moves(record)) return;
  const std::string_view unit = sheet.kind == sim::DriveKind::rotary ? "mm" : "m";
  if (largest_step(record.x) < 0.5 * sheet.encoder_resolution)
    fail(record, LogFaultKind::wrong_unit, &Record::x,
         fmt::format("{}: a unit cannot be right: the position changes by at most {:.3g} {} per row, less than half a "
                     "step of the model's encoder ({:.3g} {}); the numbers look like a larger unit",
                     where(record, &Record::x), largest_step(record.x), unit, sheet.encoder_resolution, unit));
  constexpr double kCoarse = 200.0;  // encoder steps; shows a unit that is 1000 times too small
  const double step = coarsest_step(record.x);
  if (step > kCoarse * sheet.encoder_resolution)
    fail(record, LogFaultKind::wrong_unit, &Record::x,
         fmt::format("{}: a unit cannot be right: the position never changes by less than {:.3g} {}, "
                     "{:.0f} steps of the model's encoder ({:.3g} {}); the numbers look like a smaller unit",
                     where(record, &Record::x), step, unit, step / sheet.encoder_resolution, sheet.encoder_resolution,
                     unit));
}

void require_rate(const Record& record, double lowest_Hz, std::string_view purpose) {
  const double rate_Hz = 1.0 / record.sample_period_s;
  if (rate_Hz < lowest_Hz)
    fail(record, fmt::format("{}: sampled at {:.4g} Hz (every {:.4g} s), too slow to {}; record at {:.4g} Hz "
                             "or faster",
                             where(record, &Record::t_s), rate_Hz, record.sample_period_s, purpose, lowest_Hz));
}

void require_duration(const Record& record, double shortest_s, std::string_view purpose) {
  const double length_s = record.sample_period_s * static_cast<double>(record.size());
  if (length_s < shortest_s)
    fail(record, fmt::format("{}: the record lasts {:.4g} s, too short to {}; record {:.4g} s or more",
                             where(record, &Record::t_s), length_s, purpose, shortest_s));
}

}  // namespace host
