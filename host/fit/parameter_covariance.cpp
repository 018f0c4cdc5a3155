#include "host/fit/parameter_covariance.hpp"

#include <Eigen/Core>

#include "host/dense_solutions.hpp"
#include "host/fit/model_fit.hpp"

namespace host {

ParameterCovariance covariance_of(const sim::DriveDescription& model, const RecordSet& training) {
  ParameterCovariance result{ParameterVector(model), {}, {}};
  const auto columns = static_cast<Eigen::Index>(result.vector.size());
  if (columns == 0) return result;
  result.values = result.vector.read(model);
  const auto [here, jacobian] = linearise(model, result.vector, training);
  const Eigen::Index rows = here.size();
  if (rows == 0) return result;

  // Cluster-robust: residuals of one window of one channel are correlated, those of different windows are not.
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::Index row = 0;
  for (const ComparedRecord& compared : training.records) {
    const auto channels = static_cast<Eigen::Index>(channel_count(compared, training.measure));
    for (std::size_t index = 0; index < compared.prepared.windows.size(); index += training.stride) {
      const auto length = channels * static_cast<Eigen::Index>(compared.prepared.windows[index].length);
      const Eigen::VectorXd score = jacobian.middleRows(row, length).transpose() * here.segment(row, length);
      meat += score * score.transpose();
      row += length;
    }
  }
  for (; row < rows; ++row) meat += jacobian.row(row).transpose() * jacobian.row(row);  // priors
  const Eigen::MatrixXd bread = pseudo_inverse(gram(jacobian));
  Eigen::VectorXd scales(columns);
  for (Eigen::Index k = 0; k < columns; ++k) scales(k) = result.vector.parameters()[static_cast<std::size_t>(k)].scale;
  result.matrix = scales.asDiagonal() * bread * meat * bread * scales.asDiagonal();
  return result;
}

}  // namespace host
