#include "host/identify/axis_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

/// Eq. (47): the paper's tachometer variance for the design. It is above the measured one (46) because the noise
/// varies.
constexpr double kPaperTachVariance_rad2_s2 = 0.05;

[[noreturn]] void refuse(const std::string& what) { throw Failure(ExitCode::bad_input, what); }

double positive_or_default(const std::optional<double>& option, double fallback, const char* name, const char* remedy) {
  const double value = option.value_or(fallback);
  if (!(value > 0.0) || !std::isfinite(value)) {
    refuse(fmt::format("{} is {} but must be greater than zero; {}", name, value, remedy));
  }
  return value;
}

DesignOptions complete(const DesignOptions& options, const sim::DataSheet& data) {
  DesignOptions used = options;
  used.command_variance = options.command_variance.value_or(data.dac_resolution_V * data.dac_resolution_V / 12.0);
  if (!(*used.command_variance >= 0.0)) refuse("--ru must not be negative");
  used.position_variance =
      positive_or_default(options.position_variance, data.encoder_resolution * data.encoder_resolution / 12.0, "--rx",
                          "give --rx or the encoder's resolution in the model's [drive.encoder]");
  if (data.tach_noise_variance) {
    const double fallback =
        data.kind == sim::DriveKind::rotary ? kPaperTachVariance_rad2_s2 : *data.tach_noise_variance;
    used.tach_variance = positive_or_default(options.tach_variance, fallback, "--rw", "give --rw");
  } else {
    used.tach_variance.reset();
  }
  positive_or_default(options.disturbance_variance, 0.0, "--rwd",
                      "a larger value follows disturbances faster, a smaller one has less noise");
  positive_or_default(options.damping, 0.0, "--zeta", "0.7 is usual");
  if (!(data.sample_period_s > 0.0)) refuse("the model's sample_period_s must be greater than zero");
  if (!(options.bandwidth_Hz > 0.0) || options.bandwidth_Hz >= 0.5 / data.sample_period_s) {
    refuse(fmt::format("--fc is {} Hz but must lie between 0 and half the sampling rate ({} Hz)", options.bandwidth_Hz,
                       0.5 / data.sample_period_s));
  }
  return used;
}

void describe_observer(AxisDesign& design, double sample_period_s) {
  const Eigen::Matrix3d loop = (Eigen::Matrix3d::Identity() - design.Kobs * design.model.C) * design.model.A;
  const Eigen::VectorXcd poles = eigenvalues(loop);
  design.observer_poles.assign(poles.begin(), poles.end());
  std::ranges::sort(design.observer_poles, [](const auto& a, const auto& b) {
    const double fa = std::abs(std::log(a)), fb = std::abs(std::log(b));
    if (std::abs(fa - fb) > 1e-9 * (fa + fb)) return fa < fb;
    return a.imag() > b.imag();
  });
  for (const std::complex<double>& z : design.observer_poles) {
    const std::complex<double> s = std::log(z);
    design.observer_fn_Hz.push_back(std::abs(s) / (2.0 * std::numbers::pi * sample_period_s));
    design.observer_zeta.push_back(-s.real() / std::abs(s));
  }
}

/// Requires finite gains and a stable observer.
void require_usable(const AxisDesign& design) {
  const bool settles = std::ranges::all_of(design.observer_poles, [](const auto& z) { return std::abs(z) < 1.0; });
  if (settles && design.Kobs.allFinite() && design.Kc.allFinite()) return;
  throw Failure(ExitCode::refused,
                fmt::format("no usable design: {}; give variances and a bandwidth that suit this machine (--rwd {:g} "
                            "V², --rx {:g}, --ru {:g} V², --fc {:g} Hz, --zeta {:g})",
                            settles ? "the gains are not finite" : "the observer would be unstable",
                            design.used.disturbance_variance, design.used.position_variance.value_or(0.0),
                            design.used.command_variance.value_or(0.0), design.used.bandwidth_Hz, design.used.damping));
}

}  // namespace

Eigen::Matrix3d solve_estimator_dare(const Eigen::Matrix3d& A, const Eigen::MatrixXd& C, const Eigen::Matrix3d& Q,
                                     const Eigen::MatrixXd& R) {
  constexpr int kMaxDoublings = 60;  // each squares the error; a detectable axis needs far fewer than 60
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d a = A.transpose();
  const Eigen::MatrixXd weight = square_inverse(R),
                        weighted = C.transpose() * weight;  // a variable, because one product compiles faster
  Eigen::Matrix3d g = weighted * C;
  Eigen::Matrix3d h = Q;
  for (int k = 0; k < kMaxDoublings; ++k) {
    const Eigen::Matrix3d coupling = I + g * h, next = square_solution(coupling, a);
    const Eigen::Matrix3d step = a.transpose() * h * next;
    g += a * square_solution(coupling, g) * a.transpose();
    a = (a * next).eval();
    h += step;
    h = (0.5 * (h + h.transpose())).eval();
    if (!h.allFinite()) break;
    if (step.norm() <= 1e-15 * h.norm()) return h;
  }
  refuse("the estimator's Riccati equation has no stabilising solution: check --rwd, --rx and the model's inertia");
}

Eigen::RowVector2d place_poles(const SampledAxis& axis, double natural_frequency_Hz, double damping,
                               double sample_period_s) {
  const double angle = 2.0 * std::numbers::pi * natural_frequency_Hz * sample_period_s;
  const std::complex<double> root = std::sqrt(std::complex<double>(damping * damping - 1.0, 0.0));
  const std::complex<double> z1 = std::exp(angle * (-damping + root)), z2 = std::exp(angle * (-damping - root));
  const double sum = (z1 + z2).real(), product = (z1 * z2).real();
  const Eigen::Matrix2d polynomial = axis.Ad * axis.Ad - sum * axis.Ad + product * Eigen::Matrix2d::Identity();
  Eigen::Matrix2d controllability;
  controllability << axis.Bd, axis.Ad * axis.Bd;
  return Eigen::RowVector2d(0.0, 1.0) * square_inverse(controllability) * polynomial;
}

AxisDesign design_axis(const sim::DriveDescription& model, const DesignOptions& options) {
  AxisDesign design;
  design.axis = rigid_axis(model);
  design.used = complete(options, model.data);
  const double period_s = model.data.sample_period_s;
  const SampledAxis sampled = sample_axis(design.axis, period_s);
  design.model = augment_axis(sampled, model.data.tach_noise_variance.has_value());
  const Eigen::MatrixXd C = design.model.C;

  const Eigen::Vector2d process(*design.used.command_variance, design.used.disturbance_variance);
  const Eigen::Matrix3d Q = design.model.W * process.asDiagonal() * design.model.W.transpose();
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(C.rows(), C.rows());
  R(0, 0) = *design.used.position_variance;
  if (design.used.tach_variance) R(1, 1) = *design.used.tach_variance;
  const Eigen::Matrix3d P = solve_estimator_dare(design.model.A, C, Q, R);
  const Eigen::MatrixXd CP = C * P, innovation = CP * C.transpose() + R, weight = square_inverse(innovation);
  const Eigen::MatrixXd PC = P * C.transpose();
  design.Kobs = PC * weight;
  describe_observer(design, period_s);
  design.Kc = place_poles(sampled, options.bandwidth_Hz, options.damping, period_s);
  require_usable(design);
  return design;
}

}  // namespace host
