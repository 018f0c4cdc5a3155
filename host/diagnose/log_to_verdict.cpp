#include "host/diagnose/log_to_verdict.hpp"

#include <algorithm>
#include <filesystem>

#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/known_by_current.hpp"
#include "host/record/channel_checks.hpp"

namespace host {

namespace {

bool is_to_judge(const Record& record) {
  const std::string name = std::filesystem::path(record.path).filename().string();
  return std::ranges::any_of(std::initializer_list<std::string_view>{"valid", "test", "check"},
                             [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

}  // namespace

sim::DriveDescription sheet_of_constant(const std::vector<Record>& records, double motor_constant,
                                        double lead_mm_per_rad) {
  const Record& record = records.front();
  sim::DriveDescription sheet;
  sheet.name = record.drive.empty() ? "axis" : record.drive;
  sheet.data.kind = record.kind;
  sheet.data.torque_constant_Nm_per_A = motor_constant;
  know_by_current(sheet.data);
  sheet.data.lead = record.kind == sim::DriveKind::rotary && lead_mm_per_rad > 0.0 ? lead_mm_per_rad : 1.0;
  sheet.data.sample_period_s = record.sample_period_s;
  if (record.has_position()) {
    std::vector<const Record*> all;
    for (const Record& one : records) all.push_back(&one);
    sheet.data.encoder_resolution = with_measured_sensors(sheet, all).data.encoder_resolution;
  }
  return sheet;
}

std::unique_ptr<LogVerdict> verdict_of(std::vector<Record> records, const sim::DriveDescription& sheet,
                                       const std::vector<std::string>& accepted, const ShareDone& progress) {
  for (Record& record : records) adapt_to(record, sheet.data);
  std::vector<Record> training, validation;
  for (Record& record : records) (is_to_judge(record) ? validation : training).push_back(std::move(record));
  if (training.empty()) std::swap(training, validation);
  Measurements measured = MeasurementGate(sheet, {accepted}).admit(std::move(training), std::move(validation));
  Identification identification = identify_drive(measured, sheet, default_method(measured.training()));
  auto result = std::unique_ptr<LogVerdict>(new LogVerdict{std::move(measured), std::move(identification), {}});
  result->diagnosis = diagnose(result->identification.model, result->measured, progress);
  return result;
}

}  // namespace host
