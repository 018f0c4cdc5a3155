#include "host/evidence/measurement_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/evidence/channel_relations.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/evidence/record_agreement.hpp"
#include "host/evidence/record_overlap.hpp"
#include "host/evidence/record_zeros.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"
#include "host/record/record_origin.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// Largest share of validation rows that may also be training rows. Above it, validation is meaningless.
constexpr double kMostInCommon = 0.1;

void require_known(const std::vector<std::string>& accepted) {
  constexpr auto kLast = static_cast<int>(LogFaultKind::no_encoder);
  for (const std::string& name : accepted) {
    bool known = false;
    std::string families;
    for (int kind = 0; kind <= kLast; ++kind) {
      const std::string_view family = log_fault_family(static_cast<LogFaultKind>(kind));
      known = known || name == family || name == log_fault_name(static_cast<LogFaultKind>(kind));
      if (families.find(family) == std::string::npos) families += fmt::format("{}{}", kind == 0 ? "" : ", ", family);
    }
    if (!known)
      throw Failure(ExitCode::usage, fmt::format("--accept {}: no fault has that name; there is {}", name, families));
  }
}

/// Shifts a channel that is late (> 0) or early by whole samples. Rows without a partner are removed.
void shift_back(Record& record, std::vector<double> Record::*channel, int late) {
  const auto cut = static_cast<std::size_t>(std::abs(late));
  if (record.size() <= cut) return;
  const auto drop = [cut](auto& values, bool at_front) {
    if (values.size() <= cut) return;
    const auto count = static_cast<std::ptrdiff_t>(cut);
    if (at_front)
      values.erase(values.begin(), values.begin() + count);
    else
      values.erase(values.end() - count, values.end());
  };
  for (const auto other : kChannelsInFileOrder) drop(record.*other, (other == channel) == (late > 0));
  for (ExtraChannel& extra : record.extra) {
    drop(extra.values, late < 0);
    drop(extra.text, late < 0);
  }
}

}  // namespace

MeasurementGate::MeasurementGate(const sim::DriveDescription& drive, GateOptions options)
    : drive_(drive), options_(std::move(options)) {
  require_known(options_.accepted);
}

bool MeasurementGate::is_accepted(const LogFault& fault) const {
  return std::ranges::any_of(options_.accepted, [&](const std::string& name) {
    return name == log_fault_family(fault.kind) || name == log_fault_name(fault.kind);
  });
}

bool MeasurementGate::any_stops(const std::vector<LogFault>& faults) const {
  return std::ranges::any_of(faults, [&](const LogFault& fault) { return fault.fatal && !is_accepted(fault); });
}

std::vector<LogFault> MeasurementGate::check(Record& record) const {
  adapt_to(record, drive_.data);
  if (position_and_speed_swapped(record) && !scaled_copy(record)) {
    const std::string column(name_in_file(record, &Record::w));
    return {{LogFaultKind::swapped, column, record.path, record.t_s.front(), 0.0,
             fmt::format("{}: the change of {} follows {}, as a position follows its speed: the two columns are "
                         "interchanged; exchange their names",
                         file_name(record), column, name_in_file(record, &Record::x))}};
  }
  std::vector<LogFault> faults;
  try {
    check_units(record, drive_.data);
  } catch (const FaultyLog& refused) {
    faults = refused.faults;
    if (!std::ranges::all_of(faults, [&](const LogFault& fault) { return is_accepted(fault); })) {
      std::ranges::move(copied_channels(record, drive_.data), std::back_inserter(faults));
      return faults;
    }
  }
  std::ranges::copy(log_faults(record, drive_), std::back_inserter(faults));
  if (options_.as_logged) return faults;
  for (LogFault& fault : faults) {
    if (fault.kind == LogFaultKind::derived_channel) {
      record.w.clear();
      fault.message += "; left out here";
    }
    if (fault.kind == LogFaultKind::time_shift && !fault.fatal && fault.channel == name_in_file(record, &Record::w)) {
      shift_back(record, &Record::w, static_cast<int>(std::lround(fault.size / record.sample_period_s)));
      fault.message += "; shifted back here";
    }
  }
  return faults;
}

void MeasurementGate::compare_roles(std::vector<Record>& training, std::vector<Record>& validation,
                                    std::vector<LogFault>& faults) const {
  const auto note = [&](const Record& first, const Record& second, const RecordOverlap& overlap, bool judges) {
    const double common_s = static_cast<double>(overlap.rows) * second.sample_period_s;
    const double share = static_cast<double>(overlap.rows) / static_cast<double>(second.size());
    std::string message = fmt::format(
        "{}: {} as {}: ", file_name(second),
        overlap.whole ? std::string("the same rows")
                      : fmt::format("{:.3g} s, from {:.4g} s on, are the same rows", common_s, overlap.begin_s),
        file_name(first));
    message += judges                                 ? "training data cannot validate; give a record of another motion"
               : overlap.whole && !options_.as_logged ? "it counts once"
                                                      : "they count twice";
    faults.push_back({LogFaultKind::same_record,
                      {},
                      second.path,
                      overlap.begin_s,
                      common_s,
                      message,
                      judges && (overlap.whole || share > kMostInCommon)});
  };
  for (auto* role : {&training, &validation}) {
    for (std::size_t second = 1; second < role->size();) {
      RecordOverlap overlap;
      for (std::size_t first = 0; first < second && overlap.rows == 0; ++first) {
        overlap = record_overlap((*role)[first], (*role)[second]);
        if (overlap.rows > 0) note((*role)[first], (*role)[second], overlap, false);
      }
      if (overlap.whole && !options_.as_logged)
        role->erase(role->begin() + static_cast<std::ptrdiff_t>(second));
      else
        ++second;
    }
  }
  for (const Record& judge : validation) {
    for (const Record& trainer : training) {
      const RecordOverlap overlap = record_overlap(trainer, judge);
      if (overlap.rows > 0) note(trainer, judge, overlap, true);
    }
  }
  if (any_stops(faults)) return;
  std::vector<const Record*> by, judged;
  for (const Record& record : training) by.push_back(&record);
  for (const Record& record : validation) judged.push_back(&record);
  const auto disagreement = record_disagreement(by, judged.empty() ? by : judged, drive_.data);
  if (!disagreement) return;
  const Record& odd = judged.empty() ? training[disagreement->record] : validation[disagreement->record];
  const std::string column(name_in_file(odd, disagreement->channel));
  const char* what = disagreement->channel == &Record::w ? "the tachometer's gain comes"
                     : disagreement->friction_too        ? "inertia and friction both come"
                                                         : "the inertia comes";
  const char* why = disagreement->channel == &Record::w || disagreement->friction_too
                        ? "a scale changed between the records"
                        : "another load, or another scale";
  faults.push_back({LogFaultKind::records_disagree, column, odd.path, odd.t_s.front(), disagreement->factor,
                    fmt::format("{}, column {}: {} out {:.4g} times as large as in the other records: {}; record again "
                                "under one setting, or leave the record out",
                                file_name(odd), column, what, disagreement->factor, why)});
}

void MeasurementGate::shift_late_currents(std::vector<Record>& training, std::vector<Record>& validation,
                                          std::vector<LogFault>& faults) const {
  const std::string current(name_in_file(Record{}, &Record::i_A));
  const auto is_late = [&](const LogFault& fault) {
    return fault.kind == LogFaultKind::time_shift && !fault.fatal && fault.channel == current;
  };
  std::vector<double> shifts_s;
  for (const LogFault& fault : faults)
    if (is_late(fault)) shifts_s.push_back(fault.size);
  if (shifts_s.empty()) return;
  const double shared_s = median(std::move(shifts_s));
  for (auto* role : {&training, &validation})
    for (Record& record : *role) {
      if (!record.u_V.empty() || record.i_A.empty()) continue;
      const auto own = std::ranges::find_if(
          faults, [&](const LogFault& fault) { return is_late(fault) && fault.record == record.path; });
      const double shift_s = own != faults.end() ? own->size : shared_s;
      shift_back(record, &Record::i_A, static_cast<int>(std::lround(shift_s / record.sample_period_s)));
      if (own != faults.end())
        own->message += "; shifted back here";
      else
        faults.push_back({LogFaultKind::time_shift, current, record.path, record.t_s.front(), shift_s,
                          fmt::format("{}, column {}: it is {:g} ms late in another record of this logger, and this "
                                      "record cannot show it; shifted back by the same time",
                                      file_name(record), current, 1e3 * shift_s),
                          false});
    }
}

void MeasurementGate::share_zero(std::vector<Record>& training, std::vector<Record>& validation,
                                 std::vector<LogFault>& faults) const {
  std::vector<Record*> records;
  for (auto* role : {&training, &validation})
    for (Record& record : *role) records.push_back(&record);
  for (const AnotherZero& other : other_zeros({records.begin(), records.end()}, drive_.data)) {
    Record& record = *records[other.record];
    const bool rotary = drive_.data.kind == sim::DriveKind::rotary;
    std::string message = fmt::format(
        "{}: periodic effects are shifted by {:.4g} {} from {}, with equal amplitude: the axis was homed again between "
        "them. Effects that depend on position are compared by amplitude only",
        file_name(record), other.shift, rotary ? "mm" : "m", file_name(*records[other.reference]));
    if (!options_.as_logged) {
      for (auto* column : {&record.x, &record.x2, &record.x_ref})
        for (double& x : *column) x += other.shift;
      message += "; moved to that zero here";
    }
    faults.push_back({LogFaultKind::another_zero, std::string(name_in_file(record, &Record::x)), record.path,
                      record.t_s.front(), other.shift, message, false});
  }
}

Measurements MeasurementGate::admit(std::vector<Record> training, std::vector<Record> validation) const {
  std::vector<LogFault> faults;
  for (auto* role : {&training, &validation})
    for (Record& record : *role) std::ranges::move(check(record), std::back_inserter(faults));
  if (!options_.as_logged && !any_stops(faults)) shift_late_currents(training, validation, faults);
  compare_roles(training, validation, faults);
  if (!any_stops(faults)) {
    share_zero(training, validation, faults);
    std::vector<Record*> all;
    for (auto* role : {&training, &validation})
      for (Record& record : *role) all.push_back(&record);
    settle_effort_timing(all, drive_);
  }
  std::string fatal;
  for (LogFault& fault : faults) {
    fault.accepted = fault.fatal && is_accepted(fault);
    if (!fault.fatal || fault.accepted) continue;
    fatal += fmt::format(
        "{}{}\n"
        "  fault of the log: {}; --accept {} continues anyway",
        fatal.empty() ? "" : "\n", fault.message, log_fault_family(fault.kind), log_fault_family(fault.kind));
  }
  if (!fatal.empty()) throw FaultyLog(fatal, faults);
  return {std::move(training), std::move(validation), std::move(faults)};
}

Measurements MeasurementGate::read(const std::vector<std::string>& training,
                                   const std::vector<std::string>& validation) const {
  std::vector<Record> train, judge;
  for (const std::string& path : training) train.push_back(read_record(path));
  for (const std::string& path : validation) judge.push_back(read_record(path));
  return admit(std::move(train), std::move(judge));
}

}  // namespace host
