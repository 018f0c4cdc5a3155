// Waves over the travel as columns of the force balance: the periods to try, and waves as effects of a model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// Order `order` of a period in mm or m.
struct Wave {
  double period;
  double order;
};

/// Shortest period, mm or m: the filter removes shorter waves, or the encoder's steps cause them.
double shortest_wave(const sim::DataSheet& data, const EffortRows& rows);

/// All waves that the rows can show: orders of a turn of the shaft, if the travel covers a quarter of a turn, and free
/// periods that repeat within the travel. `longest`: longest free period, in travels.
std::vector<Wave> waves_over(const sim::DataSheet& data, const EffortRows& rows, double longest);

/// Natural logarithm of the prior probability of each of these waves. Screw and motor cause most periods, so their
/// orders have half of the probability, in proportion to 1/order, which prefers no scale. The free periods share the
/// other half equally.
std::vector<double> log_priors(const std::vector<Wave>& waves, const sim::DataSheet& data);

/// cos and sin of a wave, times `weight`: two columns.
Eigen::MatrixXd wave_columns(const EffortRows& rows, const Eigen::VectorXd& weight, const Wave& wave);

/// Torque of an inertia that varies along the travel as one wave (a crank, an arm). By conservation of energy, T = J(x)
/// a + w^2/2 dJ/dx. Two columns, for the cosine and the sine of J. Not in the catalogue.
Eigen::MatrixXd varying_inertia_columns(const EffortRows& rows, const Wave& wave);

/// Apparent torque or force of an encoder error that is one wave of the reading. The reading contains the speed and
/// acceleration of the error, the motion of the drive does not. Two columns, for the cosine and the sine of the error
/// in mm or m, with the model's inertia and viscous friction.
Eigen::MatrixXd encoder_error_columns(const sim::DriveDescription& model, const EffortRows& rows, const Wave& wave);

/// The factors of these columns are divided by this to give an error in mm or m. The columns use the given inertia, but
/// the error acts on the fitted one.
double encoder_error_unit(const sim::DriveDescription& given, const sim::DriveDescription& fitted);

using WaveColumns = std::function<Eigen::MatrixXd(const Wave&)>;

/// A periodic effect of one wave, with its columns at every row. If the model already has an entry of that kind and
/// period, the wave becomes a further order of it.
EffortTerm wave_term(const sim::DriveDescription& model, const EffortRows& rows, const std::string& kind,
                     const WaveColumns& columns_of, const Wave& wave);

/// All waves of a kind in a model: "orders 72, 18 of 6.283 mm".
std::string words_of_waves(const sim::DriveDescription& model, const std::string& kind);

}  // namespace host
