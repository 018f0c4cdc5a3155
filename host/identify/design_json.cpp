#include "host/identify/design_json.hpp"

namespace host {

namespace {

nlohmann::json rows_of(const Eigen::MatrixXd& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    nlohmann::json row = nlohmann::json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

nlohmann::json design_json(const AxisDesign& design) {
  nlohmann::json poles = nlohmann::json::array();
  for (const std::complex<double>& pole : design.observer_poles) poles.push_back({pole.real(), pole.imag()});
  nlohmann::json used = {{"rwd", design.used.disturbance_variance},
                         {"ru", *design.used.command_variance},
                         {"rx", *design.used.position_variance},
                         {"fc_Hz", design.used.bandwidth_Hz},
                         {"zeta", design.used.damping},
                         {"zero_phase", design.used.zero_phase}};
  if (design.used.tach_variance) used["rw"] = *design.used.tach_variance;
  return {{"format", "axis-design/1"},
          {"A", rows_of(design.model.A)},
          {"B", {design.model.B(0), design.model.B(1), design.model.B(2)}},
          {"Kobs", rows_of(design.Kobs)},
          {"observer_poles", poles},
          {"observer_fn_Hz", design.observer_fn_Hz},
          {"observer_zeta", design.observer_zeta},
          {"Kc", {design.Kc(0), design.Kc(1)}},
          {"options", used}};
}

}  // namespace host
