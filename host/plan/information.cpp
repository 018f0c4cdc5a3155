#include "host/plan/information.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "host/dense_solutions.hpp"
#include "host/diagnose/model_fit.hpp"

namespace host {

Information& Information::operator+=(const Information& other) {
  if (other.slope.size() == 0) return *this;
  if (slope.size() == 0) return *this = other;
  curvature += other.curvature;
  slope += other.slope;
  square += other.square;
  return *this;
}

double Information::least() const {
  if (slope.size() == 0) return square;
  // A parameter that nothing determines is held by the smallest of weights: a change as large as its own scale costs
  // one observation in a hundred.
  constexpr double kLoose = 0.01;
  Eigen::MatrixXd held = curvature;
  held.diagonal().array() += kLoose;
  return std::max(0.0, square - slope.dot(symmetric_solution(held, slope)));
}

Information information_of(const sim::DriveDescription& model, const RecordSet& set) {
  const ParameterVector vector(model);
  const Linearisation about = linearise(model, vector, set);
  if (about.residuals.size() == 0) return {};
  const double scale = chi_scale(set);
  return {scale * about.slopes.transpose() * about.slopes, scale * about.slopes.transpose() * about.residuals,
          scale * about.residuals.squaredNorm()};
}

double steps_of_information(const sim::DriveDescription& model, const RecordSet& set) {
  return steps_of(sim::Drive(model), set) * static_cast<double>(ParameterVector(model).size() + 1);
}

}  // namespace host
