// The free parameters of a drive as one vector for solvers.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// One free number. It may stand for several entries of the model: parameters of one direction that had the same
/// magnitude (eq. 19 with W1 = W2) stay equal, so that a fit keeps the form of the model.
struct FreeParameter {
  std::size_t effect;                                   ///< index into DriveDescription::effects
  std::vector<std::pair<std::string, double>> entries;  ///< parameter id and the sign it carries
  double scale;                                         ///< typical size, > 0
  double lower, upper;                                  ///< bounds of the value
  std::optional<sim::Belief> believed = {};             ///< the model file's prior

  std::string name(const sim::DriveDescription& description) const;  ///< "cogging.cosine"
};

enum class Freedom {
  everything,  ///< all parameters of all effects
  last_effect  ///< those of the last effect, but not its period along the travel
};

class ParameterVector {
 public:
  /// The scales are the magnitudes of the values; for a value of zero, the scale comes from the catalogue.
  explicit ParameterVector(const sim::DriveDescription& description, Freedom freedom = Freedom::everything);

  const std::vector<FreeParameter>& parameters() const { return parameters_; }
  std::size_t size() const { return parameters_.size(); }

  Eigen::VectorXd read(const sim::DriveDescription& description) const;
  /// Writes values, clamped to their bounds.
  void write(const Eigen::VectorXd& values, sim::DriveDescription& description) const;

 private:
  std::vector<FreeParameter> parameters_;
};

}  // namespace host
