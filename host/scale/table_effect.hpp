// Converts a fitted term to text and to an entry of a model.
#pragma once

#include "host/scale/table_study.hpp"

namespace host {

/// Whether the model already has an effect of this kind.
bool stands_in(const sim::DriveDescription& model, std::string_view kind);

/// Subtracts the errors of scale, encoder and screw and the thermal growth in the model from the rows.
void take_out_known(const sim::DriveDescription& model, TableRows& rows);

/// The sensor with a cyclic error: "motor", "scale" or "scale or motor".
std::string place_of(const TableTerm& term, const TableRows& rows, const sim::DriveDescription& model);

/// Covariance of the factors of Search::fit_slopes(), base columns first, in their own units.
Eigen::MatrixXd factor_covariance(const EvidenceFit& fit, Eigen::Index base, const std::vector<TableTerm>& terms,
                                  const TableRows& rows, double usual);

/// Sizes with intervals, curve, place, model entry and text of one term, whose columns begin at `first`.
TableEffect table_effect(const TableTerm& term, const EvidenceFit& fit, const Eigen::MatrixXd& covariance,
                         Eigen::Index first, const TableRows& rows, const sim::DriveDescription& model);

}  // namespace host
