#include "host/scale/table_terms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/statistics.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double size_of(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / std::max<double>(1.0, static_cast<double>(values.size())));
}

/// A value at every sample of a record, between those of its rows, each at its row's middle.
std::vector<double> at_samples(const TableRecord& one, const VectorXd& of_rows) {
  std::vector<double> values(one.x.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double place = (static_cast<double>(k) + 0.5) / static_cast<double>(one.stride) - 0.5;
    const double within = std::clamp(place, 0.0, static_cast<double>(one.rows - 1));
    const Index left = std::min(static_cast<Index>(within), one.rows - 2);
    const double share = within - static_cast<double>(left);
    values[k] = (1.0 - share) * of_rows(one.first_row + left) + share * of_rows(one.first_row + left + 1);
  }
  return values;
}

/// The table in a gap, pushed at either side by what stands at `pusher`, mm, and slowed by its own friction between:
/// its travel less the pusher's, over the gap. Starts in the middle.
std::vector<double> in_the_gap(const std::vector<double>& pusher, double period_s, double gap, double deceleration) {
  const double half = 0.5 * gap;
  std::vector<double> share(pusher.size());
  double table = pusher.front(), speed = 0.0;
  for (std::size_t k = 0; k < share.size(); ++k) {
    const double at = pusher[k], pusher_speed = k == 0 ? 0.0 : (at - pusher[k - 1]) / period_s;
    if (std::isfinite(deceleration)) {
      table += speed * period_s;
      const double slower = std::max(std::abs(speed) - deceleration * period_s, 0.0);
      speed = std::copysign(slower, speed);
    }
    if (table < at - half) {
      table = at - half;
      speed = std::max(speed, pusher_speed);
    } else if (table > at + half) {
      table = at + half;
      speed = std::min(speed, pusher_speed);
    }
    share[k] = (table - at) / gap;
  }
  return share;
}

/// Gap and spring stand in series: the gap begins to close once the spring has unwound.
VectorXd beside_a_spring(const std::vector<double>& shape, const TableRows& rows) {
  VectorXd twist;
  if (shape.size() > kPlainGap) {
    const MatrixXd spring = TableTerm{"compliance", {shape[kPlainGap]}}.columns(rows);
    twist = 1e-3 * spring * Eigen::Map<const VectorXd>(shape.data() + kPlainGap + 1, spring.cols());
  }
  return rows.means([&](const TableRecord& one) {
    std::vector<double> pusher = one.x;
    if (twist.size() > 0) {
      const std::vector<double> twisted = at_samples(one, twist);
      for (std::size_t k = 0; k < pusher.size(); ++k) pusher[k] += twisted[k];
    }
    return in_the_gap(pusher, one.record->sample_period_s, shape[0], shape[1]);
  });
}

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

/// Each knot's share in each row: piecewise linear functions that sum to 1.
MatrixXd hats_over(const VectorXd& at, double low, double high, int count, bool by_factor) {
  MatrixXd columns = MatrixXd::Zero(at.size(), count);
  const double scale = by_factor ? std::log(high / low) : high - low;
  for (Index k = 0; k < at.size(); ++k) {
    const double q = std::clamp(at(k), low, high);
    const double place = (by_factor ? std::log(q / low) : q - low) / scale * (count - 1);
    const Index left = std::min<Index>(static_cast<Index>(place), count - 2);
    columns(k, left + 1) = place - static_cast<double>(left);
    columns(k, left) = 1.0 - columns(k, left + 1);
  }
  return columns;
}

}  // namespace

MatrixXd TableTerm::columns(const TableRows& rows) const {
  if (kind == "backlash") return beside_a_spring(shape, rows);
  if (kind == "compliance") {
    // Of the motor's effort its own inertia and friction do not reach the table. Without a measured force, the table's
    // inertia and its friction, whose size nobody knows.
    MatrixXd columns(rows.size(), 3);
    columns.col(0) = rows.has_effort() ? VectorXd(-rows.effort) : VectorXd(-shape[0] * rows.a);
    columns.col(1) = rows.has_effort() ? rows.way : VectorXd(-rows.way);
    columns.col(2) = shape[0] * rows.a;
    return rows.has_effort() && shape[0] > 0.0 ? columns : MatrixXd(columns.leftCols(2));
  }
  if (kind == "encoder_cyclic_error") return waves(rows, shape[0], 0.0, 1);
  if (kind == "thermal_growth") return growth(rows, shape[0]);
  MatrixXd columns(rows.size(), 1 + 2 * kPitchOrders);
  columns << 1e-3 * (rows.x.array() - shape[0]).matrix(), waves(rows, kPitchPeriod * shape[1], shape[0], kPitchOrders);
  return columns;
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
  for (Index c = 0; c < columns.cols(); ++c) deviations(c) = usual / std::max(size_of(columns.col(c)), 1e-12);
  // Bearings and seals of the motor take a tenth of a drive's friction, give or take as much (textbook).
  constexpr double kMotorsFriction = 0.1;
  const bool is_measured = columns.cols() > 2 || !(shape[0] > 0.0);  // the force: see columns()
  if (kind == "compliance" && is_measured) deviations(1) *= kMotorsFriction;
  // Curves are smooth: a wave's amplitude falls with its order.
  if (kind == "pitch_error")
    for (Index c = 1; c < columns.cols(); ++c) deviations(c) /= static_cast<double>((c + 1) / 2);
  return deviations;
}

std::vector<TableTerm> table_forms(std::string_view kind, const TableRows& rows, double inertia, double deceleration) {
  std::vector<TableTerm> forms;
  const std::string name(kind);
  const double low = rows.x.minCoeff(), high = rows.x.maxCoeff(), travel = high - low;
  if (kind == "backlash") {
    constexpr double kLeast_mm = 0.001, kMost_mm = 0.6;
    for (double gap = kLeast_mm; gap < std::min(kMost_mm, 0.5 * travel); gap *= std::numbers::sqrt2)
      for (const double part : {0.0, 0.25, 0.5, 1.0})  // of the inertia in front of the gap
        if (part == 0.0 || deceleration > 0.0)
          forms.push_back({name, {gap, part == 0.0 ? HUGE_VAL : deceleration / part}});
  } else if (kind == "compliance") {
    if (rows.has_effort() || inertia > 0.0) forms.push_back({name, {inertia}});
  } else if (kind == "pitch_error") {
    if (travel > 0.0) forms.push_back({name, {0.5 * (low + high), travel}});
  } else if (kind == "thermal_growth") {
    double longest_s = 0.0;
    for (const TableRecord& one : rows.records)
      longest_s = std::max(longest_s, rows.t_s(one.first_row + one.rows - 1) - rows.t_s(one.first_row));
    for (const double part : {0.1, 0.3, 1.0, 10.0}) forms.push_back({name, {part * longest_s}});
    if (rows.temp_C.size() > 0 && rows.temp_C.maxCoeff() > rows.temp_C.minCoeff()) forms.push_back({name, {0.0}});
  } else if (travel > 0.0) {
    // From where the pitch curve ends down to what the slower half of the rows resolves.
    constexpr double kRowsAPeriod = 3.0, kMostPeriods = 4000.0;
    std::vector<double> steps;
    for (Index k = 1; k < rows.size(); ++k)
      if (const double step = std::abs(rows.x(k) - rows.x(k - 1)); step > 0.1e-3) steps.push_back(step);
    if (steps.empty()) return forms;
    const double shortest = std::max(kRowsAPeriod * quantile(std::move(steps), 0.25), travel / kMostPeriods);
    const double longest = kPitchPeriod * travel / (kPitchOrders + 1);
    for (double waves = travel / longest; waves < travel / shortest; waves += 0.5)
      forms.push_back({name, {travel / waves}});
  }
  return forms;
}

MatrixXd table_base(const TableRows& rows) {
  MatrixXd base = MatrixXd::Zero(rows.size(), static_cast<Index>(rows.records.size()) + 1);
  for (std::size_t r = 0; r < rows.records.size(); ++r)
    base.col(static_cast<Index>(r)).segment(rows.records[r].first_row, rows.records[r].rows).setOnes();
  base.rightCols(1) = rows.v;
  return base;
}

Memory table_memory(const TableRows& rows, double usual) {
  const MatrixXd base = table_base(rows);
  MatrixXd plain(rows.size(), base.cols() + 4);
  plain << base, rows.way, rows.a, rows.x, (rows.has_effort() ? rows.effort : VectorXd(rows.v.cwiseAbs()));
  const Eigen::ColPivHouseholderQR<MatrixXd> others(plain);
  Memory memory;
  memory.columns.resize(rows.size(), 0);
  memory.usual = usual;
  const auto add = [&](const char* coordinate, const MatrixXd& columns) {
    // What the effects themselves can explain is none of the memory's: Plumlee, JASA 112 (2017), eq. (5).
    const MatrixXd left = columns - plain * others.solve(columns);
    const Index first = memory.columns.cols();
    memory.columns.conservativeResize(rows.size(), first + left.cols());
    memory.columns.rightCols(left.cols()) = left;
    memory.groups.push_back({coordinate, first, left.cols()});
  };
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff(), top = rows.v.cwiseAbs().maxCoeff();
  const auto by_way = rows.way.asDiagonal();
  if (top > 0.0) add("speed", by_way * hats_over(rows.v.cwiseAbs(), 0.02 * top, top, 6, true));
  if (travel > 0.0) {
    add("position", by_way * hats_over(rows.x, rows.x.minCoeff(), rows.x.maxCoeff(), 8, false));
    add("travel_since_reversal", by_way * hats_over(rows.since, 1e-4 * travel, 0.3 * travel, 8, true));
  }
  if (rows.has_effort() && rows.effort.maxCoeff() > rows.effort.minCoeff())
    add("current", hats_over(rows.effort, rows.effort.minCoeff(), rows.effort.maxCoeff(), 7, false));
  return memory;
}

}  // namespace host
