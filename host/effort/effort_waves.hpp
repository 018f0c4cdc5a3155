// Waves over the travel as columns of the force balance: which periods are tried, and what a wave makes of a model.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// Order `order` of a period, mm or m.
struct Wave {
  double period;
  double order;
};

/// Travel of one turn of the shaft, mm; 0 for a linear drive.
double turn_of(const sim::DataSheet& data);

/// Below this period, mm or m, waves pass faster than the filter lets through, or are made by the encoder's steps.
double shortest_wave(const sim::DataSheet& data, const EffortRows& rows);

/// All waves that rows of a drive can tell: orders of a shaft's turn, where the travel holds a quarter of one, and any
/// period that comes back within the travel; `longest`: in travels, of the free ones.
std::vector<Wave> waves_over(const sim::DataSheet& data, const EffortRows& rows, double longest);

/// cos and sin of a wave, times `weight`: two columns.
Eigen::MatrixXd wave_columns(const EffortRows& rows, const Eigen::VectorXd& weight, const Wave& wave);

/// What an inertia asks for that varies along the travel by one wave (a crank, an arm): energy is kept, so that
/// T = J(x) a + w^2/2 dJ/dx. Two columns, of J's cosine and sine. No effect of the catalogue.
Eigen::MatrixXd varying_inertia_columns(const EffortRows& rows, const Wave& wave);

/// A periodic effect of one wave. A model that has an entry of that kind and period gets one order more.
EffortTerm wave_term(const sim::DriveDescription& model, const EffortRows& rows, const std::string& kind,
                     const Eigen::VectorXd& weight, const Wave& wave);

/// All waves that a model holds of a kind: "orders 72, 18 of 6.283 mm".
std::string words_of_waves(const sim::DriveDescription& model, const std::string& kind);

}  // namespace host
