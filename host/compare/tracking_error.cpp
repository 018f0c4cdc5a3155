#include "host/compare/tracking_error.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

constexpr std::size_t kPeriods = 3;
/// A period is named if it explains at least this share of the residual. Noise explains less.
constexpr double kNamedShare = 0.1;

bool by_position(const Record& record) { return record.has_position() && !record.x_ref.empty(); }
bool by_speed(const Record& record) { return record.has_speed() && !record.w_ref.empty(); }

/// Central differences; the first and last values repeat their neighbours.
Eigen::VectorXd rate_of(const Eigen::VectorXd& values, double period_s) {
  Eigen::VectorXd rate(values.size());
  for (Eigen::Index k = 1; k + 1 < values.size(); ++k) rate(k) = (values(k + 1) - values(k - 1)) / (2.0 * period_s);
  rate(0) = rate(1);
  rate(values.size() - 1) = rate(values.size() - 2);
  return rate;
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Fits the regressors in order. Each gets the additional share of the squared error that it explains.
Eigen::VectorXd take_parts(const Eigen::VectorXd& error, const std::vector<Eigen::VectorXd>& columns,
                           TrackingError& result) {
  const double whole = error.squaredNorm();
  double left = whole;
  Eigen::VectorXd rest = error;
  for (std::size_t count = 1; count <= columns.size(); ++count) {
    Eigen::MatrixXd regressors(error.size(), static_cast<Eigen::Index>(count));
    for (std::size_t c = 0; c < count; ++c) regressors.col(static_cast<Eigen::Index>(c)) = columns[c];
    const Eigen::VectorXd found = least_squares_solution(regressors, error);
    rest = error - regressors * found;
    result.parts[count - 1].share = whole > 0.0 ? (left - rest.squaredNorm()) / whole : 0.0;
    left = rest.squaredNorm();
    for (std::size_t c = 0; c < count; ++c) result.parts[c].coefficient = found(static_cast<Eigen::Index>(c));
  }
  return rest;
}

std::vector<PeriodPeak> periods_of(const Record& record, const Eigen::VectorXd& rest) {
  const auto [low, high] = std::ranges::minmax(record.x);
  const double travel = high - low;
  constexpr double kFinest = 200.0;  // periods over the travel; shorter ones come from the sensor
  if (!(travel > 0.0)) return {};
  TravelSignal signal{record.x, {rest.begin(), rest.end()}, std::vector<double>(record.size(), 1.0)};
  std::vector<PeriodPeak> peaks = find_periods(signal, travel / kFinest, travel / 2.0, kPeriods);
  std::erase_if(peaks, [](const PeriodPeak& peak) { return !(peak.share >= kNamedShare); });
  return peaks;
}

}  // namespace

bool has_reference_only(const Record& record) {
  return record.u_V.empty() && record.i_A.empty() && (by_position(record) || by_speed(record));
}

std::vector<Record> tracking_records(const std::vector<std::string>& paths, const sim::DataSheet& data) {
  std::vector<Record> records;
  for (const std::string& path : paths) {
    records.push_back(read_record(path));
    if (!has_reference_only(records.back())) return {};
    adapt_to(records.back(), data);
  }
  return records;
}

TrackingError tracking_error(const Record& record) {
  if (!has_reference_only(record))
    throw Failure(ExitCode::bad_input, record.path + ": not a record of only position or speed and reference");
  const bool position = by_position(record);
  const auto channel = position ? &Record::x : &Record::w;
  const Eigen::VectorXd reference = vector_of(position ? record.x_ref : record.w_ref);
  const Eigen::VectorXd error = reference - vector_of(record.*channel);
  TrackingError result;
  result.path = record.path;
  result.channel = column_name(channel, record.kind);
  Eigen::Index worst = 0;
  result.largest = error.cwiseAbs().maxCoeff(&worst);
  result.largest_at_s = record.t_s[static_cast<std::size_t>(worst)];
  result.rms = std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));

  const bool rotary = record.kind == sim::DriveKind::rotary;
  const std::string unit = position ? (rotary ? "mm" : "m") : (rotary ? "rad/s" : "m/s");
  const Eigen::VectorXd rate = rate_of(reference, record.sample_period_s);
  std::vector<Eigen::VectorXd> columns{Eigen::VectorXd::Ones(error.size())};
  result.parts = {{"constant", 0.0, unit, 0.0}};
  if (position) {
    const double standing = 1e-3 * rate.cwiseAbs().maxCoeff();
    columns.push_back(rate);
    columns.push_back(rate.unaryExpr([standing](double v) { return v > standing ? 1.0 : v < -standing ? -1.0 : 0.0; }));
    columns.push_back(rate_of(rate, record.sample_period_s));
    result.parts.push_back({"speed", 0.0, "s", 0.0});
    result.parts.push_back({"direction", 0.0, unit, 0.0});
    result.parts.push_back({"acceleration", 0.0, "s²", 0.0});
  } else {
    columns.push_back(reference);
    columns.push_back(rate);
    result.parts.push_back({"speed", 0.0, "1", 0.0});
    result.parts.push_back({"acceleration", 0.0, "s", 0.0});
  }
  const Eigen::VectorXd rest = take_parts(error, columns, result);
  if (record.has_position()) result.periods = periods_of(record, rest);
  return result;
}

std::string tracking_text(const std::vector<TrackingError>& errors) {
  std::string text =
      "The record has no command or current (u_V or i_A), so it cannot be compared with a model.\n"
      "Tracking error from measurement and reference:\n";
  const auto out = std::back_inserter(text);
  for (const TrackingError& error : errors) {
    fmt::format_to(out,
                   "\n"
                   "{}: reference minus {}: {:.4g} rms, {:.4g} at worst (t = {:.3f} s)\n",
                   error.path, error.channel, error.rms, error.largest, error.largest_at_s);
    for (const TrackingPart& part : error.parts)
      fmt::format_to(out, "  {:5.1f} % of its square follows {:<13} {:.4g} {}\n", 100.0 * part.share,
                     part.with == "constant" ? "an offset:" : part.with + ":", part.coefficient, part.unit);
    for (const PeriodPeak& peak : error.periods)
      fmt::format_to(out, "  {:5.1f} % of the rest repeats every {:.4g} along the travel, amplitude {:.3g}\n",
                     100.0 * peak.share, peak.period, std::hypot(peak.cosine, peak.sine));
  }
  text +=
      "\n"
      "Next: also log the command (u_V) or the motor current (i_A), so that compare and diagnose can find the cause.\n";
  return text;
}

nlohmann::json tracking_json(const std::vector<TrackingError>& errors) {
  nlohmann::json records = nlohmann::json::array();
  for (const TrackingError& error : errors) {
    nlohmann::json parts = nlohmann::json::array(), periods = nlohmann::json::array();
    for (const TrackingPart& part : error.parts)
      parts.push_back(
          {{"with", part.with}, {"coefficient", part.coefficient}, {"unit", part.unit}, {"share", part.share}});
    for (const PeriodPeak& peak : error.periods)
      periods.push_back(
          {{"period", peak.period}, {"amplitude", std::hypot(peak.cosine, peak.sine)}, {"share", peak.share}});
    records.push_back({{"record", error.path},
                       {"channel", error.channel},
                       {"rms", error.rms},
                       {"largest", error.largest},
                       {"largest_at_s", error.largest_at_s},
                       {"parts", parts},
                       {"periods", periods}});
  }
  return {{"format", "axis-tracking/1"}, {"records", records}};
}

}  // namespace host
