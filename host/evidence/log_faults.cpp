#include "host/evidence/log_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "host/evidence/channel_shift.hpp"
#include "host/evidence/position_jumps.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/encoder_step.hpp"
#include "host/identify/rigid_estimate.hpp"
#include "host/record/columns.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

std::string file_name(const Record& record) { return std::filesystem::path(record.path).filename().string(); }

class FaultList {
 public:
  explicit FaultList(const Record& record) : record_(record) {}
  void add(LogFaultKind kind, std::vector<double> Record::*channel, double t_s, double size,
           const std::string& message) {
    const std::string column(name_in_file(record_, channel));
    faults_.push_back(
        {kind, column, record_.path, t_s, size, fmt::format("{}, column {}: {}", file_name(record_), column, message)});
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
               fmt::format("jumps by {:.6g} {} = 2^{} encoder steps at t = {:.4g} s{}: a counter ran over; add 2^{} "
                           "steps from there on (axistool import) and log with a wider counter",
                           jumps.first_wrap.size, unit, jumps.wrap_bits, jumps.first_wrap.t_s, times(jumps.wraps),
                           jumps.wrap_bits));
  if (jumps.new_zeros > 0)
    faults.add(
        LogFaultKind::new_zero, &Record::x, jumps.first_new_zero.t_s, jumps.first_new_zero.size,
        fmt::format("jumps by {:.6g} {} at t = {:.4g} s{}, far more than the drive can move in one sample: a new "
                    "zero (homing) or a disturbed encoder; split the record there",
                    jumps.first_new_zero.size, unit, jumps.first_new_zero.t_s, times(jumps.new_zeros)));
  if (jumps.dropped > 0)
    faults.add(LogFaultKind::dropped_samples, &Record::x, jumps.first_drop.t_s, static_cast<double>(jumps.dropped),
               fmt::format("{} samples are missing or repeated though the time stamps go on, first at t = {:.4g} s: "
                           "log the sampler's own counter and import with its times",
                           jumps.dropped, jumps.first_drop.t_s));
}

void find_derived_speed(const Record& record, const sim::DataSheet& data, FaultList& faults) {
  if (!record.has_position() || !record.has_speed() || record.size() < 4) return;
  constexpr double kSame = 1e-3;  // of one encoder step a sample: a tachometer's noise is no multiple of the step
  const double unit = encoder_step(record, data) / (data.lead * record.sample_period_s);
  if (!(unit > 0.0)) return;
  const auto departs = [&](std::size_t back, std::size_t ahead) {
    const double span_s = static_cast<double>(back + ahead) * record.sample_period_s;
    double travel = 0.0;
    for (std::size_t k = back; k + ahead < record.size(); ++k) {
      const double difference = (record.x[k + ahead] - record.x[k - back]) / (data.lead * span_s);
      travel = std::max(travel, std::abs(difference));
      if (std::abs(record.w[k] - difference) > kSame * unit) return true;
    }
    return travel == 0.0;
  };
  if (!departs(1, 0) || !departs(0, 1) || !departs(1, 1))
    faults.add(
        LogFaultKind::derived_channel, &Record::w, record.t_s.front(), 0.0,
        "is the difference of the position, not a measurement of its own: it tells nothing new; leave the column "
        "out, or log the tachometer");
}

/// Factors between what this record says of the base parameters and what the model says; empty where the record
/// cannot tell.
struct BaseFactors {
  double inertia, viscous, forward, backward;
};

std::optional<BaseFactors> base_factors(const Record& record, const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  if (!(drive.inertia > 0.0) || !(drive.friction[0].coulomb > 0.0) || !(drive.friction[1].coulomb > 0.0)) return {};
  const RigidEstimate found = inverse_least_squares({prepare_motion(record, model.data, {})}, Coulomb::estimated);
  constexpr double kSure = 0.2;  // half of the 95 % interval over the value
  const auto sure = [](const Estimate& estimate) {
    return std::isfinite(estimate.value) && estimate.half_width() < kSure * std::abs(estimate.value);
  };
  if (!sure(found.inertia) || !found.positive || !sure(*found.positive) || !found.negative || !sure(*found.negative))
    return {};
  const double viscous = drive.friction[0].viscous;
  return BaseFactors{found.inertia.value / drive.inertia, viscous > 0.0 ? found.viscous.value / viscous : 0.0,
                     found.positive->value / drive.friction[0].coulomb,
                     -found.negative->value / drive.friction[1].coulomb};
}

bool alike(double a, double b) {
  constexpr double kAlike = 1.5;  // friction and inertia change by less between records of one drive
  return a * b > 0.0 && a < kAlike * b && b < kAlike * a;
}

void find_wrong_scales(const Record& record, const sim::DriveDescription& model, FaultList& faults) {
  const std::optional<BaseFactors> factors = base_factors(record, model);
  if (!factors) return;
  const auto command = record.u_V.empty() ? &Record::i_A : &Record::u_V;
  const auto [inertia, viscous, forward, backward] = *factors;
  if (inertia < 0.0 && forward < 0.0 && backward < 0.0) {
    faults.add(LogFaultKind::command_sign, command, record.t_s.front(), -1.0,
               "the axis accelerates against its command, and friction pushes it: turn the sign of the command or of "
               "position and speed");
    return;
  }
  constexpr double kUnit = 4.0;  // no drive's inertia and friction are both off by so much
  const auto off = [](double factor) { return factor > kUnit || (factor > 0.0 && factor < 1.0 / kUnit); };
  const double level = std::sqrt(std::abs(forward * backward));
  if (off(inertia) && alike(inertia, level)) {
    const double factor = std::sqrt(inertia * level);
    faults.add(LogFaultKind::command_scale, command, record.t_s.front(), factor,
               fmt::format("inertia and friction both come out {:.4g} times the model's: the column is not in its unit "
                           "(or the drive's gains in the model are not right); divide it by {:.4g}",
                           factor, factor));
  } else if (record.has_position() != record.has_speed() && off(inertia) && alike(inertia, viscous) &&
             alike(level, 1.0)) {
    faults.add(LogFaultKind::position_scale, record.has_position() ? &Record::x : &Record::w, record.t_s.front(),
               1.0 / inertia,
               fmt::format("inertia and viscous friction come out {:.4g} times the model's, Coulomb friction does not: "
                           "the column is not in its unit; multiply it by {:.4g}",
                           inertia, inertia));
  }
}

void find_time_shifts(const Record& record, const sim::DriveDescription& model, FaultList& faults) {
  if (const std::optional<double> samples = tachometer_shift(record, model.data)) {
    const double shift_s = *samples * record.sample_period_s;
    faults.add(LogFaultKind::time_shift, &Record::w, record.t_s.front(), shift_s,
               fmt::format("runs {:g} ms ({} samples) {} the position: shift it back before comparing",
                           1e3 * std::abs(shift_s), std::abs(*samples), shift_s > 0.0 ? "behind" : "ahead of"));
  }
  if (const std::optional<double> samples = command_shift(record, model)) {
    const double shift_s = *samples * record.sample_period_s;
    faults.add(
        LogFaultKind::time_shift, record.u_V.empty() ? &Record::i_A : &Record::u_V, record.t_s.front(), shift_s,
        fmt::format("the axis answers {:g} ms ({} samples) {} its command, which no drive does: shift the column",
                    1e3 * std::abs(shift_s), std::abs(*samples), shift_s > 0.0 ? "before" : "after"));
  }
}

}  // namespace

std::string log_fault_name(LogFaultKind kind) {
  constexpr const char* kNames[] = {"integer_wrap", "new_zero",      "dropped_samples", "derived_channel",
                                    "command_sign", "command_scale", "position_scale",  "time_shift"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<LogFault> log_faults(const Record& record, const sim::DriveDescription& model) {
  FaultList faults(record);
  find_derived_speed(record, model.data, faults);
  const PositionJumps jumps = position_jumps(record, model);
  report_jumps(record, jumps, faults);
  // A record that jumps tells nothing about scales and shifts.
  if (jumps.none()) {
    find_wrong_scales(record, model, faults);
    find_time_shifts(record, model, faults);
  }
  return faults.take();
}

nlohmann::json log_faults_json(const std::vector<LogFault>& faults) {
  nlohmann::json rows = nlohmann::json::array();
  for (const LogFault& fault : faults)
    rows.push_back({{"kind", log_fault_name(fault.kind)},
                    {"channel", fault.channel},
                    {"record", fault.record},
                    {"t_s", fault.t_s},
                    {"size", fault.size},
                    {"message", fault.message}});
  return rows;
}

}  // namespace host
