#include "host/scale/dial_readings.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/infer/posterior.hpp"
#include "host/number.hpp"
#include "host/record/table_layout.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kFewestPoints = 4, kMostReadings = 500;

struct DialColumn {
  std::size_t place = 0;
  double mm = 0.0;  ///< mm per unit
};

class DialFile {
 public:
  DialFile(std::string_view text, std::string_view name) : rest_(text), name_(name) {}

  DialReadings read() {
    std::optional<DialColumn> x, dial;
    while (take_line(rest_, line_)) {
      ++number_;
      if (trim_blanks(line_).empty() || is_remark(line_)) continue;
      if (!layout_) layout_ = find_layout(line_);
      layout_->split(line_, fields_);
      if (!x) {
        x = column("x");
        dial = column("dial");
        continue;
      }
      if (readings_.x_mm.size() == kMostReadings) fail(fmt::format("more than {} readings", kMostReadings));
      readings_.x_mm.push_back(number(*x));
      readings_.dial_mm.push_back(number(*dial));
    }
    if (readings_.x_mm.size() < kFewestPoints)
      fail(fmt::format("{} readings: give {} or more, with the columns x_mm and dial_mm", readings_.x_mm.size(),
                       kFewestPoints));
    turn();
    return std::move(readings_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}:{}: {}", name_, number_, what));
  }

  DialColumn column(std::string_view wanted) const {
    for (std::size_t place = 0; place < fields_.size(); ++place)
      for (const auto& [unit, mm] : {std::pair{"_mm", 1.0}, {"_um", 1e-3}, {"_m", 1e3}})
        if (fields_[place] == fmt::format("{}{}", wanted, unit)) return {place, mm};
    fail(fmt::format("no column {0}_mm (nor {0}_um, {0}_m): name the columns in the first row", wanted));
  }

  double number(const DialColumn& column) const {
    if (column.place >= fields_.size()) fail("fewer fields than the header has: one per column");
    const std::optional<double> value = parse_number(fields_[column.place]);
    constexpr double kFarthest_mm = 1e5;
    if (!value || !(std::abs(*value * column.mm) <= kFarthest_mm))
      fail(fmt::format("'{}' is not a number within 100 m", fields_[column.place].substr(0, 40)));
    return *value * column.mm;
  }

  void turn() {
    const Index n = static_cast<Index>(readings_.x_mm.size());
    const VectorXd x = Eigen::Map<const VectorXd>(readings_.x_mm.data(), n),
                   dial = Eigen::Map<const VectorXd>(readings_.dial_mm.data(), n);
    const VectorXd moved = (x.array() - x.mean()).matrix();
    if (!(moved.squaredNorm() > 0.0)) fail("x never changes: read the gauge at several positions");
    const double slope = moved.dot(dial) / moved.squaredNorm();
    if (slope < 0.0)
      for (double& one : readings_.dial_mm) one = -one;
    // Backlash may be a large part of a move of a few hundredths of a millimetre.
    if (!(std::abs(slope) > 0.2) || std::abs(slope) > 2.0)
      fail(fmt::format("the gauge moves {:.3g} times as far as the axis; check the unit", slope));
  }

  std::string_view rest_, name_, line_;
  std::size_t number_ = 0;
  std::optional<TableLayout> layout_;
  std::vector<std::string_view> fields_;
  DialReadings readings_;
};

/// Lag in um of a table with this play (mm) behind the motor. `first`: its initial position in the play, -1 to 1.
VectorXd play(const DialReadings& readings, double width, double first) {
  VectorXd behind(static_cast<Index>(readings.x_mm.size()));
  const double half = 0.5 * width;
  double table = readings.x_mm[0] + first * half;
  for (Index k = 0; k < behind.size(); ++k) {
    const double x = readings.x_mm[static_cast<std::size_t>(k)];
    table = std::clamp(table, x - half, x + half);
    behind(k) = 1e3 * (table - x);
  }
  return behind;
}

struct DialFit {
  VectorXd factors;  ///< offset, um; lead, um/m, if it is free
  double square = 0.0, lead_deviation = 0.0;
};

DialFit fitted_from(const DialReadings& readings, double width, double first, bool lead) {
  const VectorXd behind = play(readings, width, first);
  MatrixXd columns = MatrixXd::Ones(behind.size(), lead ? 2 : 1);
  VectorXd y(behind.size());
  for (Index k = 0; k < y.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    y(k) = 1e3 * (readings.dial_mm[at] - readings.x_mm[at]) - behind(k);
    if (lead) columns(k, 1) = 1e-3 * (readings.x_mm[at] - readings.x_mm[0]);
  }
  const MatrixXd normal = gram(columns);
  DialFit fit{symmetric_solution(normal, VectorXd(columns.transpose() * y)), 0.0, 0.0};
  fit.square = (y - columns * fit.factors).squaredNorm();
  const double noise = fit.square / std::max<double>(1.0, static_cast<double>(y.size() - columns.cols() - 1));
  if (lead) fit.lead_deviation = std::sqrt(noise * symmetric_inverse(normal)(1, 1));
  return fit;
}

/// The best fit over the initial position of the table in its play, which is unknown.
DialFit fitted(const DialReadings& readings, double width, bool lead) {
  if (width == 0.0) return fitted_from(readings, width, 0.0, lead);
  DialFit best;
  constexpr int kPlaces = 4;
  for (int place = -kPlaces; place <= kPlaces; ++place) {
    DialFit fit = fitted_from(readings, width, static_cast<double>(place) / kPlaces, lead);
    if (place == -kPlaces || fit.square < best.square) best = std::move(fit);
  }
  return best;
}

double smallest_step(std::vector<double> values) {
  std::ranges::sort(values);
  double least = HUGE_VAL;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (values[k] - values[k - 1] > 1e-9) least = std::min(least, values[k] - values[k - 1]);
  return std::isfinite(least) ? least : 0.0;
}

std::size_t reversals_of(const std::vector<double>& x) {
  std::size_t count = 0;
  double heading = 0.0;
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double move = x[k] - x[k - 1];
    if (move * heading < 0.0) ++count;
    if (move != 0.0) heading = move;
  }
  return count;
}

}  // namespace

DialReadings parse_dial_readings(std::string_view text, std::string_view name) { return DialFile(text, name).read(); }

DialStudy study_dial(const DialReadings& readings) {
  DialStudy study;
  study.reversals = reversals_of(readings.x_mm);
  const auto n = static_cast<double>(readings.x_mm.size());
  const auto [low, high] = std::ranges::minmax(readings.x_mm);
  // Upper bound of the play: with a play as wide as the travel the table would not move at all, and no machine loses 5
  // mm.
  constexpr double kWidest_mm = 5.0;
  const double widest = study.reversals > 0 ? std::min(kWidest_mm, high - low) : 0.0;
  constexpr int kWidths = 1500;
  const auto width_at = [&](int step) { return widest * std::pow(static_cast<double>(step) / kWidths, 3); };
  // The resolution of the readings is the step of the gauge.
  const double least = n * std::pow(1e3 * smallest_step(readings.dial_mm), 2) / 12.0 + 1e-12;
  std::vector<double> squares[2];
  for (const bool lead : {false, true})
    for (int step = 0; step <= (widest > 0.0 ? kWidths : 0); ++step)
      squares[lead ? 1 : 0].push_back(fitted(readings, width_at(step), lead).square + least);
  const auto best = [&](bool lead) {
    const std::vector<double>& of = squares[lead ? 1 : 0];
    return static_cast<int>(std::ranges::min_element(of) - of.begin());
  };
  const auto log_odds = [&](double square, int parameters) {
    return -0.5 * n * std::log(square) - 0.5 * parameters * std::log(n);
  };
  const std::vector<double> probable =
      posterior({log_odds(squares[0][0], 1), log_odds(squares[0][static_cast<std::size_t>(best(false))], 2),
                 log_odds(squares[1][0], 2), log_odds(squares[1][static_cast<std::size_t>(best(true))], 3)});
  study.lost_um.probability = study.reversals > 0 ? probable[1] + probable[3] : 0.0;
  study.lead_um_per_m.probability = probable[2] + probable[3];
  const bool has_lead = study.lead_um_per_m.probability >= 0.5;
  const std::vector<double>& of = squares[has_lead ? 1 : 0];
  const int at = best(has_lead);
  const DialFit fit = fitted(readings, width_at(at), has_lead);
  study.noise_um = std::sqrt(of[static_cast<std::size_t>(at)] / n);
  // Widths with a likelihood within the 95 % interval.
  const double limit = of[static_cast<std::size_t>(at)] * std::exp(kNormal95 * kNormal95 / n);
  int first = at, last = at;
  while (first > 0 && of[static_cast<std::size_t>(first - 1)] <= limit) --first;
  while (last + 1 < static_cast<int>(of.size()) && of[static_cast<std::size_t>(last + 1)] <= limit) ++last;
  study.lost_um.value = 1e3 * width_at(at);
  study.lost_um.ci95 = {1e3 * width_at(std::max(0, first - 1)), 1e3 * width_at(std::min(kWidths, last + 1))};
  if (has_lead) {
    const double off = kNormal95 * fit.lead_deviation;
    study.lead_um_per_m = {
        fit.factors(1), {fit.factors(1) - off, fit.factors(1) + off}, study.lead_um_per_m.probability};
  }
  return study;
}

std::string dial_words(const DialStudy& study) {
  std::string words;
  const DialValue& lost = study.lost_um;
  if (study.reversals == 0)
    words =
        "The axis never reverses in these readings, so they do not show the lost motion. Approach some positions from "
        "both sides.";
  else if (lost.probability >= kClaimed)
    words = fmt::format(
        "At a reversal the table loses {:.3g} um (95 %: {:.3g} to {:.3g}) of the motor's travel. That is the sum of "
        "the gap and twice the deflection by the table's friction: backlash, compliance, or both. Pushing the table by "
        "hand tells them apart: a gap moves freely, a spring needs force.",
        lost.value, lost.ci95[0], lost.ci95[1]);
  else if (lost.probability <= 1.0 - kClaimed)
    words = fmt::format("At a reversal the table follows the motor within {:.3g} um: neither backlash nor compliance.",
                        lost.ci95[1]);
  else
    words = fmt::format(
        "At a reversal the table loses between 0 and {:.3g} um: too uncertain to decide. Take more readings.",
        lost.ci95[1]);
  if (study.lead_um_per_m.probability >= kClaimed)
    words += fmt::format(" The table moves {:.3g} um per metre (95 %: {:.3g} to {:.3g}) too far: a pitch error.",
                         study.lead_um_per_m.value, study.lead_um_per_m.ci95[0], study.lead_um_per_m.ci95[1]);
  return words + fmt::format(" Readings scatter by {:.2g} um.", study.noise_um);
}

nlohmann::json dial_json(const DialStudy& study) {
  const auto value = [](const DialValue& one) -> nlohmann::json {
    return {{"value", one.value}, {"ci95", one.ci95}, {"probability", one.probability}};
  };
  return {{"format", "axis-dial/1"},
          {"lost_motion_um", value(study.lost_um)},
          {"lead_error_um_per_m", value(study.lead_um_per_m)},
          {"reversals", study.reversals},
          {"noise_um", study.noise_um}};
}

}  // namespace host
