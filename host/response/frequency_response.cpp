#include "host/response/frequency_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "host/exit_codes.hpp"
#include "host/identify/least_squares.hpp"
#include "host/record/drive_units.hpp"
#include "host/response/distortion.hpp"
#include "host/response/periodic_run.hpp"
#include "host/response/robust_method.hpp"
#include "host/response/welch_method.hpp"

namespace host {

namespace {

void require_comparable(const std::vector<Record>& records) {
  if (records.empty()) throw Failure(ExitCode::usage, "a frequency response needs a record");
  const Record& first = records.front();
  for (const Record& record : records) {
    if (record.u_V.empty() || (!record.has_position() && !record.has_speed()))
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: a frequency response needs the command u_V and a position or a speed", record.path));
    if (record.kind != first.kind || record.has_position() != first.has_position() ||
        record.has_speed() != first.has_speed() ||
        std::abs(record.sample_period_s - first.sample_period_s) > 1e-6 * first.sample_period_s)
      throw Failure(
          ExitCode::bad_input,
          fmt::format(
              "{} and {} differ in drive, channels or sample period: give records of one axis with the same settings",
              first.path, record.path));
  }
}

/// Groups runs with the same excited lines.
std::map<std::pair<std::size_t, std::vector<std::size_t>>, std::vector<PeriodicRun>> runs_by_lines(
    const std::vector<Record>& records) {
  std::map<std::pair<std::size_t, std::vector<std::size_t>>, std::vector<PeriodicRun>> runs;
  for (const Record& record : records) {
    const std::optional<MultisineHeader> excitation = multisine_of(record);
    if (!excitation)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{} is not of a multisine, but others are: analyse them separately", record.path));
    runs[{excitation->period, excitation->lines}].push_back(periodic_run(record, *excitation));
  }
  return runs;
}

/// Where bands overlap, averages their lines, weighted by inverse variance.
void merge_equal_lines(std::vector<ResponseLine>& lines) {
  std::ranges::stable_sort(lines, {}, &ResponseLine::f_Hz);
  std::vector<ResponseLine> merged;
  for (const ResponseLine& line : lines) {
    if (merged.empty() || line.f_Hz > merged.back().f_Hz * (1.0 + 1e-9)) {
      merged.push_back(line);
      continue;
    }
    ResponseLine& before = merged.back();
    const double a = 1.0 / before.covariance.trace().real(), b = 1.0 / line.covariance.trace().real();
    const double share = a / (a + b), rest = 1.0 - share;
    before.plant = share * before.plant + rest * line.plant;
    before.covariance = share * share * before.covariance + rest * rest * line.covariance;
    before.noise = std::hypot(share * before.noise, rest * line.noise);
    before.nonlinearity = share * before.nonlinearity + rest * line.nonlinearity;
    before.degrees = std::max(before.degrees, line.degrees);
  }
  lines = std::move(merged);
}

void analyse_periodic(const std::vector<Record>& records, FrequencyResponse& response) {
  response.realisations = response.periods = std::numeric_limits<std::size_t>::max();
  for (const auto& [key, runs] : runs_by_lines(records)) {
    response.is_indirect = response.is_indirect || runs.front().excitation.is_closed_loop;
    response.realisations = std::min(response.realisations, runs.size());
    for (const PeriodicRun& run : runs) response.periods = std::min(response.periods, run.period.size());
    const std::vector<ResponseLine> lines = robust_response(runs);
    response.lines.insert(response.lines.end(), lines.begin(), lines.end());
    const Distortion distortion = distortion_of(runs, lines, response.channel());
    response.even.insert(response.even.end(), distortion.even.begin(), distortion.even.end());
    response.odd.insert(response.odd.end(), distortion.odd.begin(), distortion.odd.end());
  }
  for (std::vector<DistortionLine>* lines : {&response.even, &response.odd})
    std::ranges::stable_sort(*lines, {}, &DistortionLine::f_Hz);
  if (response.realisations < 2)
    response.warnings.push_back(
        "only one realisation of the phases: the bands show noise, but not nonlinearity; repeat with another --seed");
  merge_equal_lines(response.lines);
}

void analyse_arbitrary(const std::vector<Record>& records, FrequencyResponse& response) {
  response.method = FrequencyResponse::Method::welch;
  const WelchResponse found = welch_response(records);
  response.is_indirect = found.is_indirect;
  response.realisations = 1;
  response.periods = found.stretches;
  response.lines = found.lines;
  if (response.lines.empty())
    throw Failure(ExitCode::refused,
                  fmt::format("{}: command and response are not significantly correlated at any frequency: make a "
                              "record with `axistool excite … multisine`, or `axistool bode AXIS`",
                              records.front().path));
  const auto has_reference = std::ranges::any_of(records, [](const Record& record) { return !record.w_ref.empty(); });
  if (!found.is_indirect && has_reference)
    response.warnings.push_back(
        "the loop was closed with a constant reference: the controller's response to noise biases the estimate");
}

}  // namespace

std::string plant_unit(const FrequencyResponse& response, Eigen::Index channel) {
  const DriveUnits units = units_of(response.kind);
  return fmt::format("{}/V", channel == 0 ? units.travel : units.speed);
}

namespace {

/// Standard deviation of the real and of the imaginary part.
double deviation(const ResponseLine& line, const Eigen::Vector2cd& weights) {
  const std::complex<double> power = weights.transpose() * line.covariance * weights.conjugate();
  return std::sqrt(0.5 * std::max(0.0, power.real()));
}

}  // namespace

double half_width_95(const ResponseLine& line, const Eigen::Vector2cd& weights) {
  return student_t_95(std::max(1.0, line.degrees)) * deviation(line, weights);
}

bool stands_out(const ResponseLine& line, const Eigen::Vector2cd& weights) {
  constexpr double kMost = 0.3;
  const std::complex<double> value = weights.transpose() * line.plant;
  return deviation(line, weights) < kMost * std::abs(value);
}

FrequencyResponse frequency_response(const std::vector<Record>& records) {
  require_comparable(records);
  FrequencyResponse response;
  response.kind = records.front().kind;
  response.sample_period_s = records.front().sample_period_s;
  response.has_position = records.front().has_position();
  response.has_speed = records.front().has_speed();
  if (std::ranges::any_of(records, [](const Record& record) { return multisine_of(record).has_value(); }))
    analyse_periodic(records, response);
  else
    analyse_arbitrary(records, response);
  return response;
}

}  // namespace host
