#include "host/plan/information.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "host/compare/prediction.hpp"
#include "host/dense_solutions.hpp"
#include "host/fit/model_fit.hpp"

namespace host {

Information& Information::operator+=(const Information& other) {
  if (other.slope.size() == 0) return *this;
  if (slope.size() == 0) return *this = other;
  curvature += other.curvature;
  slope += other.slope;
  square += other.square;
  return *this;
}

Information& Information::operator*=(double factor) {
  curvature *= factor;
  slope *= factor;
  square *= factor;
  return *this;
}

double Information::least() const {
  if (slope.size() == 0) return square;
  // A very small weight holds parameters that the data do not determine: a change by a parameter's own scale costs a
  // hundredth of one observation.
  constexpr double kLoose = 0.01;
  Eigen::MatrixXd held = curvature;
  held.diagonal().array() += kLoose;
  return std::max(0.0, square - slope.dot(symmetric_solution(held, slope)));
}

namespace {

/// Measured minus predicted x2 - x over the sensor noise, for the rows of all windows. The sum of the squares over a
/// window is their mean.
Eigen::VectorXd table_residuals(const sim::DriveDescription& model, const RecordSet& set) {
  const sim::Drive drive(model);
  std::vector<double> all;
  for (const ComparedRecord& compared : set.records) {
    const Record& record = *compared.prepared.record;
    if (!record.has_table_position()) continue;
    Prediction predicted;
    predict(drive, compared.prepared, predicted);
    const double noise = std::max(
        std::hypot(model.data.encoder_resolution, model.data.load_encoder_resolution) / std::sqrt(12.0), 1e-12);
    const std::size_t first = all.size();
    double mean = 0.0, weight = 0.0;
    std::vector<double> shares;
    for (const Window& window : compared.prepared.windows)
      for (std::size_t row = window.begin + 1; row <= window.begin + window.length; ++row) {
        const double reading =
            predicted.table[row] + model.data.load_encoder_error(predicted.table[row], warmer_K(record, row));
        all.push_back((record.x2[row] - record.x[row] - reading + predicted.x[row]) / noise);
        shares.push_back(1.0 / static_cast<double>(window.length));
        mean += shares.back() * all.back();
        weight += shares.back();
      }
    for (std::size_t k = 0; k < shares.size(); ++k)
      all[first + k] = std::sqrt(shares[k]) * (all[first + k] - mean / weight);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

}  // namespace

Information information_of_motion(const sim::DriveDescription& model, const RecordSet& set) {
  const Linearisation about = linearise(model, ParameterVector(model), set);
  if (about.residuals.size() == 0) return {};
  const double scale = chi_scale(set);
  return {scale * about.slopes.transpose() * about.slopes, scale * about.slopes.transpose() * about.residuals,
          scale * about.residuals.squaredNorm()};
}

std::size_t table_windows(const RecordSet& set) {
  std::size_t windows = 0;
  for (const ComparedRecord& compared : set.records)
    if (compared.prepared.record->has_table_position()) windows += compared.prepared.windows.size();
  return windows;
}

Information information_of_table(const sim::DriveDescription& model, const RecordSet& set) {
  if (table_windows(set) == 0) return {};
  const ParameterVector vector(model);
  const Eigen::VectorXd values = vector.read(model), here = table_residuals(model, set);
  Eigen::MatrixXd slopes(here.size(), values.size());
  constexpr double kStep = 1e-3;  // of a parameter's scale; large enough to show, small enough to be linear
  for (Eigen::Index column = 0; column < values.size(); ++column) {
    const FreeParameter& free = vector.parameters()[static_cast<std::size_t>(column)];
    const double step = values(column) + kStep * free.scale > free.upper ? -kStep : kStep;
    Eigen::VectorXd moved = values;
    moved(column) += step * free.scale;
    sim::DriveDescription other = model;
    vector.write(moved, other);
    slopes.col(column) = (table_residuals(other, set) - here) / step;
  }
  if (!here.allFinite() || !slopes.allFinite()) return {};
  return {slopes.transpose() * slopes, slopes.transpose() * here, here.squaredNorm()};
}

Information information_of(const sim::DriveDescription& model, const RecordSet& set) {
  Information both = information_of_motion(model, set);
  if (both.slope.size() > 0) both += information_of_table(model, set);
  return both;
}

double steps_of_information(const sim::DriveDescription& model, const RecordSet& set) {
  return steps_of(sim::Drive(model), set) * static_cast<double>(ParameterVector(model).size() + 1);
}

}  // namespace host
