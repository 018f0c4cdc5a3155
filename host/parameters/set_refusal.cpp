#include "host/parameters/set_refusal.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "firmware/core/supervision/monitor_check.hpp"
#include "host/dense_solutions.hpp"
#include "host/parameters/monitor_relations.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

using firmware::PoleProblem;
using firmware::Refusal;
namespace ceilings = firmware::monitor_ceilings;

std::string eigenvalues_text(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXcd values = eigenvalues(matrix);
  std::string text;
  for (const std::complex<double>& z : values) {
    if (z.imag() < 0.0) continue;  // printed with its conjugate
    text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", z.real());
    if (z.imag() > 0.0) text += fmt::format(" +- {:.4g}i", z.imag());
  }
  return text;
}

const char* words(PoleProblem problem) {
  switch (problem) {
    case PoleProblem::unstable:
      return "unstable: a pole lies on or outside the unit circle";
    case PoleProblem::undamped:
      return "undamped: it would ring";
    case PoleProblem::slow:
      return "too slow: a mode takes longer than 2 s";
    case PoleProblem::none:
      break;
  }
  return "stable here, but not after the board's rounding";
}

}  // namespace

std::string estimator_poles_text(const firmware::AxisParameters<float>& p) {
  Eigen::Matrix3f A;
  A << 1, p.drive.Ad12, -p.drive.Bd1, 0, p.drive.Ad22, -p.drive.Bd2, 0, 0, 1;
  Eigen::Matrix<float, 3, 2> K;
  for (int row = 0; row < 3; ++row) {
    const auto& gains = p.Kobs[static_cast<std::size_t>(row)];
    K.row(row) << gains[0], p.tachometer_fitted ? gains[1] : 0.0F;
  }
  const Eigen::Matrix3d closed =
      ((Eigen::Matrix3f::Identity() - K * Eigen::Matrix<float, 2, 3>::Identity()) * A).cast<double>();
  return eigenvalues_text(closed);
}

std::string loop_poles_text(const firmware::AxisParameters<float>& p) {
  Eigen::Matrix2f closed;
  closed << 1 - p.drive.Bd1 * p.Kc[0], p.drive.Ad12 - p.drive.Bd1 * p.Kc[1], -p.drive.Bd2 * p.Kc[0],
      p.drive.Ad22 - p.drive.Bd2 * p.Kc[1];
  return eigenvalues_text(closed.cast<double>());
}

std::string why_refused(const firmware::ParameterValues& values, const firmware::SetRefusal& refused) {
  if (refused.kind != firmware::ValueRefusal::refused_by_core || refused.key.owner() == 0) return "";
  const auto p = firmware::axis_parameters<float>(values.axis(refused.key.owner() - 1));
  switch (refused.core) {
    case Refusal::estimator_poles:
      return fmt::format("with these Kalman gains the estimator is {}; its poles are {}. Design the gains again",
                         words(firmware::estimator_problem(p)), estimator_poles_text(p));
    case Refusal::loop_poles:
      return fmt::format("with feedback.k1 and feedback.k2 the loop is {}; its poles are {}. Design the gains again",
                         words(firmware::loop_problem(p)), loop_poles_text(p));
    case Refusal::filters:
      return "with these notch and low_pass filters the loop would be unstable, or one of them is not below 0.45 of "
             "the control rate; a narrower notch, a higher frequency or less bandwidth (design --fc) leaves more phase";
    case Refusal::brake_feedback:
      return "an axis with a brake may fall, and at rest only a tachometer or the fault output of the encoder's "
             "receivers reveals a dead encoder: fit one (tachometer.fitted or encoder.fault_input). An axis whose "
             "amplifier controls the brake (brake.fitted = false) needs one as well";
    case Refusal::following_error:
      return following_error_relation(p);
    case Refusal::disagreement:
      return disagreement_relation(p);
    case Refusal::overspeed:
      return overspeed_relation(p);
    case Refusal::polarity_command:
      return fmt::format("above {:g} of drive.dac_limit, {:.4g} V, no command would reach it", ceilings::kCommandShare,
                         ceilings::kCommandShare * p.dac_limit_V);
    case Refusal::oscillation:
      return fmt::format("above {:g} of drive.dac_limit, {:.4g} V, no swing would reach it",
                         ceilings::kOscillationShare, ceilings::kOscillationShare * p.dac_limit_V);
    case Refusal::travel:
      return "monitor.travel_min must be below monitor.travel_max";
    case Refusal::saturation_time:
      return fmt::format("above {:g} s it would not protect", ceilings::kSaturation_s);
    default:
      return "";
  }
}

}  // namespace host
