#include "host/evidence/log_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/evidence/channel_relations.hpp"
#include "host/evidence/channel_shift.hpp"
#include "host/evidence/clipped_command.hpp"
#include "host/evidence/position_jumps.hpp"
#include "host/identify/rigid_estimate.hpp"
#include "host/record/columns.hpp"
#include "host/record/position_grid.hpp"
#include "host/record/record_origin.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

class FaultList {
 public:
  explicit FaultList(const Record& record) : record_(record) {}
  void add(LogFaultKind kind, std::vector<double> Record::*channel, double t_s, double size, const std::string& message,
           bool fatal = true) {
    const std::string column(name_in_file(record_, channel));
    faults_.push_back({kind, column, record_.path, t_s, size,
                       fmt::format("{}, column {}: {}", file_name(record_), column, message), fatal});
  }
  std::vector<LogFault> take() { return std::move(faults_); }

 private:
  const Record& record_;
  std::vector<LogFault> faults_;
};

void report_jumps(const Record& record, const PositionJumps& jumps, FaultList& faults) {
  const char* unit = record.kind == sim::DriveKind::rotary ? "mm" : "m";
  const auto times = [](std::size_t count) { return count == 1 ? std::string() : fmt::format(", {} times", count); };
  if (jumps.wraps > 0)
    faults.add(LogFaultKind::integer_wrap, &Record::x, jumps.first_wrap.t_s, jumps.first_wrap.size,
               fmt::format("jumps by {:.6g} {} against the motion at t = {:.4g} s{}: a counter or an angle wrapped; "
                           "unwrap it with axistool import {} --unwrap {}={:.10g} -o …",
                           jumps.first_wrap.size, unit, jumps.first_wrap.t_s, times(jumps.wraps), file_name(record),
                           name_in_file(record, &Record::x), jumps.wrap_range));
  if (jumps.new_zeros > 0)
    faults.add(
        LogFaultKind::new_zero, &Record::x, jumps.first_new_zero.t_s, jumps.first_new_zero.size,
        fmt::format("jumps by {:.6g} {} at t = {:.4g} s{}, far more than the drive can move in one sample: a new "
                    "zero (homing) or a disturbed encoder; split the record there",
                    jumps.first_new_zero.size, unit, jumps.first_new_zero.t_s, times(jumps.new_zeros)));
  if (jumps.late > 0)
    faults.add(LogFaultKind::uneven_clock, &Record::x, jumps.first_late.t_s, static_cast<double>(jumps.late),
               fmt::format("is late and catches up in one sample at t = {:.4g} s{}: the time stamps jitter, or samples "
                           "are missing; its acceleration is wrong there, so log the sampler's own counter",
                           jumps.first_late.t_s, times(jumps.late)),
               false);
  if (jumps.dropped > 0)
    faults.add(LogFaultKind::dropped_samples, &Record::x, jumps.first_drop.t_s, static_cast<double>(jumps.dropped),
               fmt::format("{} samples are missing or repeated although the time stamps continue, first at t = {:.4g} "
                           "s: log the sampler's own counter and import with its times",
                           jumps.dropped, jumps.first_drop.t_s));
}

void find_copies(const Record& record, const sim::DataSheet& data, FaultList& faults) {
  if (speed_is_differenced(record, data))
    faults.add(LogFaultKind::derived_channel, &Record::w, record.t_s.front(), 0.0,
               "is the difference of the position, not a separate measurement, and adds no information; leave the "
               "column out, or log the tachometer",
               false);
  if (const std::optional<ScaledCopy> copy = scaled_copy(record))
    faults.add(LogFaultKind::scaled_copy, copy->channel, record.t_s.front(), copy->factor,
               fmt::format("is {} times {:.6g} (plus a constant) in every row, not a separate measurement; log the "
                           "channel itself, or leave the column out",
                           name_in_file(record, copy->original), copy->factor),
               !copy->harmless);
}

void find_clipping(const Record& record, const sim::DriveDescription& model, FaultList& faults) {
  if (const std::optional<ClippedCommand> clipped = clipped_command(record, model))
    faults.add(LogFaultKind::clipped, &Record::u_V, clipped->t_s, clipped->level_V,
               fmt::format("is constant at {:.4g} V in {:.0f} % of the rows while the motion needs {:.0f} % more: the "
                           "log clips the command; log its whole range (the converter gives {:g} V)",
                           clipped->level_V, 100.0 * clipped->share, 100.0 * clipped->excess, model.data.dac_limit_V));
}

/// Inertia and friction from this record alone; empty if it is too short.
std::optional<RigidEstimate> rigid_estimate(const Record& record, const sim::DataSheet& data) {
  const std::optional<Motion> motion = motion_if_long_enough(record, data, {});
  constexpr std::ptrdiff_t kFewestRows = 50;
  if (!motion || std::ranges::count(motion->counts, true) < kFewestRows) return std::nullopt;
  RigidEstimate found = inverse_least_squares({*motion}, Coulomb::estimated);
  if (!found.positive || !found.negative) return std::nullopt;
  return found;
}

/// Whether half of the 95 % interval is below a fifth of the value.
bool sure(const Estimate& estimate) {
  constexpr double kSure = 0.2;
  return std::isfinite(estimate.value) && estimate.half_width() < kSure * std::abs(estimate.value);
}

/// Ratios of this record's base parameters to those of the model; empty if the record does not determine them.
struct BaseFactors {
  double inertia, viscous, forward, backward;
};

std::optional<BaseFactors> base_factors(const RigidEstimate& found, const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  if (!(drive.inertia > 0.0) || !(drive.friction[0].coulomb > 0.0) || !(drive.friction[1].coulomb > 0.0)) return {};
  if (!sure(found.inertia) || !sure(*found.positive) || !sure(*found.negative)) return {};
  const double viscous = drive.friction[0].viscous;
  return BaseFactors{found.inertia.value / drive.inertia, viscous > 0.0 ? found.viscous.value / viscous : 0.0,
                     found.positive->value / drive.friction[0].coulomb,
                     -found.negative->value / drive.friction[1].coulomb};
}

bool alike(double a, double b) {
  constexpr double kAlike = 1.5;  // friction and inertia change by less between records of one drive
  return a * b > 0.0 && a < kAlike * b && b < kAlike * a;
}

/// For a record without a model: reports a command that moves the axis at a few thousandths of the converter's range,
/// or that is beyond the range most of the time.
void find_odd_command(const Record& record, const sim::DataSheet& data, FaultList& faults) {
  constexpr double kTiny = 0.003;  // 30 mV of 10 V: below any drive's friction
  constexpr double kBeyond = 1.05, kMostBeyond = 0.3;
  if (record.u_V.empty() || !(data.dac_limit_V > 0.0)) return;
  double largest = 0.0;
  for (const double u_V : record.u_V) largest = std::max(largest, std::abs(u_V));
  const auto beyond =
      std::ranges::count_if(record.u_V, [&](double u_V) { return std::abs(u_V) > kBeyond * data.dac_limit_V; });
  if (static_cast<double>(beyond) > kMostBeyond * static_cast<double>(record.size()))
    faults.add(LogFaultKind::command_scale, &Record::u_V, record.t_s.front(), largest / data.dac_limit_V,
               fmt::format("reaches {:.3g} V and exceeds the converter's limit ({:g} V) in {:.0f} % of the rows: the "
                           "column is not in volts, or the data sheet's limit is wrong",
                           largest, data.dac_limit_V,
                           100.0 * static_cast<double>(beyond) / static_cast<double>(record.size())));
  if (largest > kTiny * data.dac_limit_V || !(largest > 0.0)) return;
  const std::optional<Motion> motion = motion_if_long_enough(record, data, {});
  if (!motion || std::ranges::find(motion->counts, true) == motion->counts.end()) return;
  faults.add(LogFaultKind::command_scale, &Record::u_V, record.t_s.front(), largest / data.dac_limit_V,
             fmt::format("the axis moves although the command never exceeds {:.3g} V, {:.2g} of the converter's limit: "
                         "the column is not in volts; scale it",
                         largest, largest / data.dac_limit_V));
}

void find_wrong_scales(const Record& record, const sim::DriveDescription& model, FaultList& faults) {
  sim::DataSheet unlimited = model.data;  // a command in a wrong unit must not be clipped
  unlimited.dac_limit_V = HUGE_VAL;
  const std::optional<RigidEstimate> found = rigid_estimate(record, unlimited);
  if (!found) return;
  const auto command = record.u_V.empty() ? &Record::i_A : &Record::u_V;
  const bool pushes =
      sure(*found->positive) && sure(*found->negative) && found->positive->value < 0.0 && found->negative->value > 0.0;
  const bool against = sure(found->inertia) && found->inertia.value < 0.0;
  if ((against || !sure(found->inertia)) && (pushes || (against && found->positive->value < found->negative->value))) {
    faults.add(LogFaultKind::command_sign, command, record.t_s.front(), -1.0,
               "the axis accelerates against its command, and friction drives it: invert the sign of the command or of "
               "position and speed");
    return;
  }
  const std::optional<BaseFactors> factors = base_factors(*found, model);
  if (!factors) {
    find_odd_command(record, model.data, faults);
    return;
  }
  const auto [inertia, viscous, forward, backward] = *factors;
  constexpr double kUnit = 4.0;  // no drive's inertia and friction are both wrong by this much
  const auto off = [](double factor) { return factor > kUnit || (factor > 0.0 && factor < 1.0 / kUnit); };
  const double level = std::sqrt(std::abs(forward * backward));
  if (off(inertia) && alike(inertia, level)) {
    const double factor = std::sqrt(inertia * level);
    faults.add(LogFaultKind::command_scale, command, record.t_s.front(), factor,
               fmt::format("inertia and friction are both {:.4g} times the model's: the column has the wrong unit "
                           "(or the model's gains are wrong); divide it by {:.4g}",
                           factor, factor));
  } else if (record.has_position() != record.has_speed() && off(inertia) && alike(inertia, viscous) &&
             alike(level, 1.0)) {
    faults.add(LogFaultKind::position_scale, record.has_position() ? &Record::x : &Record::w, record.t_s.front(),
               1.0 / inertia,
               fmt::format("inertia and viscous friction are {:.4g} times the model's, Coulomb friction is not: "
                           "the column has the wrong unit; multiply it by {:.4g}",
                           inertia, inertia));
  }
}

void find_time_shifts(const Record& record, const sim::DriveDescription& model, FaultList& faults) {
  if (const std::optional<double> samples = tachometer_shift(record, model.data)) {
    const double shift_s = *samples * record.sample_period_s;
    faults.add(LogFaultKind::time_shift, &Record::w, record.t_s.front(), shift_s,
               fmt::format("runs {:.3g} ms ({:.3g} samples) {} the position: shift it back before comparing",
                           1e3 * std::abs(shift_s), std::abs(*samples), shift_s > 0.0 ? "behind" : "ahead of"),
               false);
  }
  if (const std::optional<double> samples = command_shift(record, model)) {
    const double shift_s = *samples * record.sample_period_s;
    // A filtered current is logged late by whole samples. A late command or an early current is a fault.
    const bool late_current = record.u_V.empty() && shift_s > 0.0;
    faults.add(LogFaultKind::time_shift, record.u_V.empty() ? &Record::i_A : &Record::u_V, record.t_s.front(), shift_s,
               late_current
                   ? fmt::format("runs {:g} ms ({} samples) behind the motion that it causes", 1e3 * shift_s, *samples)
                   : fmt::format("the axis responds {:g} ms ({} samples) {} its command, which is physically "
                                 "impossible: shift the column",
                                 1e3 * std::abs(shift_s), std::abs(*samples), shift_s > 0.0 ? "before" : "after"),
               !late_current);
  }
}

}  // namespace

std::vector<LogFault> copied_channels(const Record& record, const sim::DataSheet& data) {
  FaultList faults(record);
  find_copies(record, data, faults);
  return faults.take();
}

namespace {

/// Faults of the data sheet: missing fields, or a data sheet of another drive.
void find_wrong_sheet(const Record& record, const sim::DriveDescription& model, FaultList& faults) {
  const char* unit = model.data.kind == sim::DriveKind::rotary ? "mm" : "m";
  if (!model.effects.empty() && !record.drive.empty() && !model.name.empty() && record.drive != model.name)
    faults.add(LogFaultKind::other_drive, record.has_position() ? &Record::x : &Record::w, record.t_s.front(), 0.0,
               fmt::format("from drive '{}', but the model is of '{}'", record.drive, model.name), false);
  const double told = model.data.encoder_resolution, step = position_grid(record.x);
  if (told > 0.0 && step > kCoarser * told)
    faults.add(LogFaultKind::no_encoder, &Record::x, record.t_s.front(), step,
               fmt::format("all positions are multiples of {0:.6g} {1}, {2:.3g} steps of the data sheet's encoder; "
                           "{0:.6g} {1} is taken: correct [drive.encoder] resolution_{1}, or log every count",
                           step, unit, step / told),
               false);
  else if (!(told > 0.0) && step > 0.0)
    faults.add(LogFaultKind::no_encoder, &Record::x, record.t_s.front(), step,
               fmt::format("all positions are multiples of {0:.6g} {1}, but the data sheet has no encoder, so the "
                           "noise floor is too low: add [drive.encoder] resolution_{1} = {0:.6g}",
                           step, unit),
               false);
}

}  // namespace

std::vector<LogFault> log_faults(const Record& record, const sim::DriveDescription& model) {
  FaultList faults(record);
  find_copies(record, model.data, faults);
  find_wrong_sheet(record, model, faults);
  const PositionJumps jumps = position_jumps(record, model);
  report_jumps(record, jumps, faults);
  // A record with jumps cannot show scales and shifts.
  if (jumps.none()) {
    find_wrong_scales(record, model, faults);
    find_clipping(record, model, faults);
    find_time_shifts(record, model, faults);
  }
  return faults.take();
}

nlohmann::json log_faults_json(const std::vector<LogFault>& faults) {
  nlohmann::json rows = nlohmann::json::array();
  for (const LogFault& fault : faults)
    rows.push_back({{"fault", log_fault_family(fault.kind)},
                    {"kind", log_fault_name(fault.kind)},
                    {"channel", fault.channel},
                    {"record", fault.record},
                    {"t_s", fault.t_s},
                    {"size", fault.size},
                    {"message", fault.message},
                    {"remedy", log_fault_remedy(fault.kind)},
                    {"fatal", fault.fatal},
                    {"accepted", fault.accepted}});
  return rows;
}

}  // namespace host
