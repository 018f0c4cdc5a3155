// Which orders of a period the effort holds along the travel: chosen one by one on training rows, as long as the rows
// that judge agree.
#pragma once

#include <vector>

#include "host/effort/effort_rows.hpp"

namespace host {

/// Orders of one period and what they leave.
struct OrderChoice {
  double period = 0.0;                           ///< mm or m
  std::vector<double> orders;                    ///< strongest first
  double left_train = 1.0, left_validate = 1.0;  ///< of the base's squared error
};

/// Whether the travel shows that these orders are of a period: it comes back within it. What does not is a series for
/// anything that goes with the position. A turn of the shaft is known to come back.
bool comes_back(const OrderChoice& choice, const sim::DataSheet& data, const EffortRows& rows);

/// cos and sin of each order, times `weight`: two columns an order.
Eigen::MatrixXd order_columns(const EffortRows& rows, const Eigen::VectorXd& weight, double period,
                              const std::vector<double>& orders);

/// Whether a wave must come back several times over the travel, or may be as long as that.
enum class Waves { short_ones, any };

/// Best orders beside `base`, over all periods tried: a turn of the shaft where the travel holds one, and what stands
/// out of the spectrum of `left` over the travel, with its multiples. Empty where nothing lowers both errors.
OrderChoice choose_orders(const sim::DataSheet& data, const EffortRows& rows, const Eigen::MatrixXd& base,
                          const Eigen::VectorXd& weight, const Eigen::VectorXd& left, Waves waves = Waves::short_ones);

}  // namespace host
