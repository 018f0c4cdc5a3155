// From a fitted term to what a person reads and a model holds.
#pragma once

#include "host/scale/table_study.hpp"

namespace host {

/// Whether the model has this kind already.
bool stands_in(const sim::DriveDescription& model, std::string_view kind);

/// Takes out of the rows what the model says of its scale, its encoder, its screw and its growth.
void take_out_known(const sim::DriveDescription& model, TableRows& rows);

/// Whose a cyclic error is: "motor", "scale", "scale or motor".
std::string place_of(const TableTerm& term, const TableRows& rows, const sim::DriveDescription& model);

/// Of the factors of Search::fit_slopes(), base columns first, in their own units.
Eigen::MatrixXd factor_covariance(const EvidenceFit& fit, Eigen::Index base, const std::vector<TableTerm>& terms,
                                  const TableRows& rows, double usual);

/// Sizes with their intervals, curve, place, entry of a model and words of one term, whose columns begin at `first`.
TableEffect table_effect(const TableTerm& term, const EvidenceFit& fit, const Eigen::MatrixXd& covariance,
                         Eigen::Index first, const TableRows& rows, const sim::DriveDescription& model);

}  // namespace host
