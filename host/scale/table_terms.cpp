#include "host/scale/table_terms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/infer/memory_builder.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd waves(const TableRows& rows, double period, double zero, int orders) {
  MatrixXd columns(rows.size(), 2 * orders);
  for (int order = 1; order <= orders; ++order)
    for (const int part : {0, 1})
      columns.col(2 * (order - 1) + part) = rows.means([&](const TableRecord& one) {
        std::vector<double> wave(one.x.size());
        for (std::size_t k = 0; k < wave.size(); ++k) {
          const double at = 2.0 * std::numbers::pi * order * (one.x[k] - zero) / period;
          wave[k] = part == 0 ? std::cos(at) : std::sin(at);
        }
        return wave;
      });
  return columns;
}

MatrixXd growth(const TableRows& rows, double time_s) {
  if (!(time_s > 0.0)) return rows.temp_C.array() - rows.temp_C.mean();
  MatrixXd columns = MatrixXd::Zero(rows.size(), static_cast<Index>(rows.records.size()));
  for (std::size_t r = 0; r < rows.records.size(); ++r) {
    const TableRecord& one = rows.records[r];
    for (Index k = one.first_row; k < one.first_row + one.rows; ++k)
      columns(k, static_cast<Index>(r)) = -std::expm1(-(rows.t_s(k) - rows.t_s(one.first_row)) / time_s);
  }
  return columns;
}

/// Hats with knots in equal ratios, linear over the logarithm.
MatrixXd log_hats(const VectorXd& at, double low, double high, int count) {
  return hats(at.cwiseMax(low).array().log(), even_knots(std::log(low), std::log(high), count));
}

/// If there is a spring, the shape is part of the spring's term and not of the gap's.
bool has_shape(const TableTerm& term) { return term.kind == "compliance" || !(term.drive.lag > 0.0); }

/// Change of x2 - x for a change of the drive's parameters by 1, um. The drive and all changes are simulated in
/// parallel.
struct DrivenSlopes {
  DrivenRows at;
  MatrixXd slopes;
};
DrivenSlopes slopes_of(const TableDrive& drive, const std::vector<std::pair<DriveNumber, double>>& steps,
                       const TableRows& rows) {
  std::vector<TableDrive> drives(1 + steps.size(), drive);
  for (std::size_t k = 0; k < steps.size(); ++k)
    set_number(drives[k + 1], steps[k].first, number_of(drive, steps[k].first) + steps[k].second);
  std::vector<DrivenRows> driven = drive_tables(drives, rows);
  DrivenSlopes found{std::move(driven.front()), MatrixXd(rows.size(), static_cast<Index>(steps.size()))};
  for (std::size_t k = 0; k < steps.size(); ++k)
    found.slopes.col(static_cast<Index>(k)) = (driven[k + 1].all - found.at.all) / steps[k].second;
  return found;
}

/// Parameters of the shape with their difference steps.
std::vector<std::pair<DriveNumber, double>> shape_steps(const TableTerm& term) {
  std::vector<std::pair<DriveNumber, double>> steps;
  if (has_shape(term))
    for (const DriveRange& range : shape_ranges(term.drive, term.deceleration))
      steps.emplace_back(range.which, range.step);
  return steps;
}

}  // namespace

MatrixXd TableTerm::columns(const TableRows& rows) const {
  if (is_driven()) {
    const DrivenSlopes driven = slopes_of(drive, shape_steps(*this), rows);
    MatrixXd columns(rows.size(), 1 + driven.slopes.cols());
    columns << (kind == "backlash" ? driven.at.gap : driven.at.pull), driven.slopes;
    return columns;
  }
  if (kind == "encoder_cyclic_error") return waves(rows, shape[0], 0.0, 1);
  if (kind == "thermal_growth") return growth(rows, shape[0]);
  MatrixXd columns(rows.size(), 1 + 2 * kPitchOrders);
  columns << 1e-3 * (rows.x.array() - shape[0]).matrix(), waves(rows, kPitchPeriod * shape[1], shape[0], kPitchOrders);
  return columns;
}

MatrixXd TableTerm::slopes(const TableRows& rows) const {
  if (!is_driven()) return columns(rows);
  constexpr double kStep = 0.02;  // relative
  const bool is_gap = kind == "backlash";
  std::vector<std::pair<DriveNumber, double>> steps = shape_steps(*this);
  steps.insert(steps.begin(), {is_gap ? DriveNumber::gap : DriveNumber::lag, kStep});
  MatrixXd columns = slopes_of(drive, steps, rows).slopes;
  columns.col(0) /= 1e3 * (is_gap ? drive.gap : drive.lag);
  return columns;
}

Index TableTerm::count(const TableRows& rows) const {
  if (is_driven()) return 1 + (has_shape(*this) ? static_cast<Index>(shape_ranges(drive, 0.0).size()) : 0);
  if (kind == "encoder_cyclic_error") return 2;
  if (kind == "thermal_growth") return shape[0] > 0.0 ? static_cast<Index>(rows.records.size()) : 1;
  return 1 + 2 * kPitchOrders;
}

MatrixXd TableTerm::quick_columns(const TableRows& rows) const {
  if (kind != "encoder_cyclic_error") return columns(rows);
  MatrixXd quick(rows.size(), 2);
  for (const TableRecord& one : rows.records) {
    const double row_s = one.record->sample_period_s * static_cast<double>(one.stride);
    for (Index k = one.first_row; k < one.first_row + one.rows; ++k) {
      const double at = 2.0 * std::numbers::pi * rows.x(k) / shape[0];
      const double half = std::numbers::pi * rows.v(k) * row_s / shape[0];
      const double left = std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0;
      quick(k, 0) = left * std::cos(at);
      quick(k, 1) = left * std::sin(at);
    }
  }
  return quick;
}

VectorXd TableTerm::deviations(const MatrixXd& columns, double usual) const {
  VectorXd deviations(columns.cols());
  for (Index c = 0; c < columns.cols(); ++c) deviations(c) = usual / std::max(rms(columns.col(c)), 1e-12);
  if (is_driven() && columns.cols() > 1) {
    Index next = 1;
    for (const DriveRange& range : shape_ranges(drive, deceleration)) deviations(next++) = range.deviation;
  }
  // Curves are smooth, so the amplitude of a wave decreases with its order.
  if (kind == "pitch_error")
    for (Index c = 1; c < columns.cols(); ++c) deviations(c) /= static_cast<double>((c + 1) / 2);
  return deviations;
}

std::vector<TableTerm> table_forms(std::string_view kind, const TableRows& rows) {
  std::vector<TableTerm> forms;
  const std::string name(kind);
  const double low = rows.x.minCoeff(), high = rows.x.maxCoeff(), travel = high - low;
  if (kind == "pitch_error") {
    if (travel > 0.0) forms.push_back({name, {0.5 * (low + high), travel}, {}});
  } else if (kind == "thermal_growth") {
    double longest_s = 0.0;
    for (const TableRecord& one : rows.records)
      longest_s = std::max(longest_s, rows.t_s(one.first_row + one.rows - 1) - rows.t_s(one.first_row));
    for (const double part : {0.1, 0.3, 1.0, 10.0}) forms.push_back({name, {part * longest_s}, {}});
    if (rows.temp_C.size() > 0 && rows.temp_C.maxCoeff() > rows.temp_C.minCoeff()) forms.push_back({name, {0.0}, {}});
  } else if (travel > 0.0) {
    // From the shortest wave of the pitch curve to the shortest period of which the rows resolve kWaves periods. A few
    // rows of slow motion suffice for that.
    constexpr double kRowsAPeriod = 3.0, kMostPeriods = 4000.0, kWaves = (kPitchOrders + 1) / kPitchPeriod;
    std::vector<double> steps;
    for (Index k = 1; k < rows.size(); ++k)
      if (const double step = std::abs(rows.x(k) - rows.x(k - 1)); step > 1e-3 * rows.step_um) steps.push_back(step);
    std::ranges::sort(steps);
    double shortest = HUGE_VAL, resolved = 0.0;
    for (std::size_t k = 0; k < steps.size() && !std::isfinite(shortest); ++k) {
      resolved += steps[k];
      if (resolved >= kWaves * kRowsAPeriod * steps[k])
        shortest = std::max(kRowsAPeriod * steps[k], travel / kMostPeriods);
    }
    const double longest = travel / kWaves;
    for (double waves = travel / longest; waves < travel / shortest; waves += 0.5)
      forms.push_back({name, {travel / waves}, {}});
  }
  return forms;
}

std::vector<TableDrive> drive_starts(bool gap, bool spring, const TableRows& rows, double deceleration) {
  // Gaps from good to worn ball screws, but not larger than the measured difference; springs from 10 to 400 Hz with the
  // motor held.
  constexpr double kLeastGap_mm = 0.001, kMostGap_mm = 0.6, kLeastLag = 1.6e-7, kMostLag = 2.6e-4, kNoSlide = 1e5;
  const double whole = 1e-3 * (rows.y.maxCoeff() - rows.y.minCoeff());
  const double usual = deceleration > 0.0 ? deceleration : 500.0;
  std::vector<double> gaps = {0.0}, lags = {0.0}, slower = {usual, 2.0 * usual, 4.0 * usual};
  if (!spring) slower.push_back(kNoSlide);
  if (gap) gaps.clear();
  for (double free = kLeastGap_mm; gap && free < std::max(2.0 * kLeastGap_mm, std::min(kMostGap_mm, whole));
       free *= 1.41)
    gaps.push_back(free);
  if (spring) lags.clear();
  for (double lag = kLeastLag; spring && lag <= kMostLag; lag *= 1.6) lags.push_back(lag);
  std::vector<TableDrive> starts;
  for (const double lag : lags)
    for (const double one : slower)
      for (const double free : gaps) starts.push_back({.gap = free, .lag = lag, .deceleration = one});
  return starts;
}

std::vector<TableDrive> drives_of_equal_loss(const TableDrive& drive) {
  std::vector<TableDrive> drives = {drive};
  const double loss = drive.gap + 2.0 * drive.lag * drive.deceleration;
  if (!(drive.gap > 0.0) || !(drive.lag > 0.0)) return drives;
  for (const double factor : {0.5, 0.65, 0.8, 1.25, 1.5, 2.0}) {
    TableDrive other = drive;
    other.gap *= factor;
    other.deceleration = (loss - other.gap) / (2.0 * drive.lag);
    if (other.deceleration > 0.0) drives.push_back(other);
  }
  return drives;
}

MatrixXd table_base(const TableRows& rows) {
  MatrixXd base = MatrixXd::Zero(rows.size(), static_cast<Index>(rows.records.size()) + 1);
  for (std::size_t r = 0; r < rows.records.size(); ++r)
    base.col(static_cast<Index>(r)).segment(rows.records[r].first_row, rows.records[r].rows).setOnes();
  base.rightCols(1) = rows.v - 0.5 * rows.late_s * rows.a;
  return base;
}

Memory table_memory(const TableRows& rows, double usual) {
  const MatrixXd base = table_base(rows);
  MatrixXd plain(rows.size(), base.cols() + 4);
  plain << base, rows.way, rows.a, rows.x, (rows.has_effort() ? rows.effort : VectorXd(rows.v.cwiseAbs()));
  MemoryBuilder memory;
  const auto add = [&](const char* coordinate, const MatrixXd& columns) {
    memory.add(coordinate, beside(columns, plain));
  };
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff(), top = rows.v.cwiseAbs().maxCoeff();
  const auto by_way = rows.way.asDiagonal();
  if (top > 0.0) add("speed", by_way * log_hats(rows.v.cwiseAbs(), 0.02 * top, top, 6));
  if (travel > 0.0) {
    add("position", by_way * hats(rows.x, even_knots(rows.x.minCoeff(), rows.x.maxCoeff(), 8)));
    add("travel_since_reversal", by_way * log_hats(rows.since, 1e-4 * travel, 0.3 * travel, 8));
  }
  if (rows.has_effort() && rows.effort.maxCoeff() > rows.effort.minCoeff())
    add("current", hats(rows.effort, even_knots(rows.effort.minCoeff(), rows.effort.maxCoeff(), 7)));
  return memory.take(usual);
}

}  // namespace host
