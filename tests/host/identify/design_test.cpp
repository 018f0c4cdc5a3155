// Estimator and controller against the printed design of Erkorkmaz & Altintas, IJMTM 41 (2001), pp. 1502-1504.
//
// The printed digits follow from the full-precision inputs below and Ru = 0.05/Ka^2 (not from the printed (42), (44)).
// Expected values come from an independent computation with these inputs, which agrees with every digit of (49), (51)
// and the matrices of p. 1502. rg is 10/(2 pi), not rounded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "host/exit_codes.hpp"
#include "host/identify/axis_design.hpp"
#include "host/identify/design_json.hpp"
#include "host/parameters/board_parameters.hpp"

namespace {

struct PaperAxis {
  const char* name;
  double amplifier_gain_A_per_V, J, B;
  double a12, a22, b1, b2;   // p. 1502
  double kobs[3][2];         // (49)
  double poles[3][2];        // p. 1503
  double fn_Hz[3], zeta[3];  // p. 1503
  double kc[2];              // (51)
};

constexpr PaperAxis kX = {
    "x",
    6.4898,
    0.007653894458020126,
    0.0198722104983324,
    0.0015894851059468785,
    0.9974070147838652,
    0.0003215070665699483,
    0.4038429422576441,
    {{0.34611426957160996, 0.0006464169870471526},
     {65.07046450655567, 0.349253807424954},
     {-25.794229508666586, -0.3082011241888027}},
    {{0.6778842874360118, 0.0}, {0.6944369251385613, 0.2862675203669791}, {0.6944369251385613, -0.2862675203669791}},
    {61.87604759346498, 77.11773535221651, 77.11773535221651},
    {1.0, 0.5906170756210805, 0.5906170756210805},
    {48.44405325182899, 0.6064573749898439}};

constexpr PaperAxis kY = {
    "y",
    7.5768,
    0.009786361672644647,
    0.023875714036238428,
    0.001589609563124967,
    0.9975632810432217,
    0.00029358165222351793,
    0.3687756348926911,
    {{0.34516990742928644, 0.0006396118153243618},
     {64.3854334910936, 0.3319714535738079},
     {-27.88665248828222, -0.31023544035629286}},
    {{0.6832839241831243, 0.0}, {0.7065024675957742, 0.2817461039395824}, {0.7065024675957742, -0.2817461039395824}},
    {60.613333140167136, 74.45804221855393, 74.45804221855393},
    {1.0, 0.5848988357437662, 0.5848988357437662},
    {53.050655056962796, 0.6645509633276226}};

sim::DriveDescription model_of(const PaperAxis& axis) {
  sim::DriveDescription model;
  model.name = axis.name;
  model.data.amplifier_gain_A_per_V = axis.amplifier_gain_A_per_V;
  model.data.torque_constant_Nm_per_A = 0.4769;  // p. 1499
  model.data.lead = 10.0 / (2.0 * std::numbers::pi);
  model.data.dac_resolution_V = 20.0 / 65536.0;   // (44)
  model.data.encoder_resolution = 10.0 / 4096.0;  // (45)
  model.data.tach_noise_variance = 0.05;          // (47)
  model.effects = {{.kind = "inertia", .parameters = {{"J", axis.J}}, .ci95 = {}, .from = {}},
                   {.kind = "viscous", .parameters = {{"B", axis.B}}, .ci95 = {}, .from = {}}};
  return model;
}

host::DesignOptions printed_options(const PaperAxis& axis) {
  host::DesignOptions options;
  options.command_variance = 0.05 / (axis.amplifier_gain_A_per_V * axis.amplifier_gain_A_per_V);
  return options;
}

sim::DriveDescription linear_motor() {
  sim::DriveDescription model;
  model.name = "stage";
  model.data.kind = sim::DriveKind::linear;
  model.data.force_constant_N_per_V = 35.0;
  model.data.encoder_resolution = 5e-8;
  model.data.dac_resolution_V = 20.0 / 65536.0;
  model.effects = {{.kind = "inertia", .parameters = {{"J", 95.0}}, .ci95 = {}, .from = {}},
                   {.kind = "viscous", .parameters = {{"B", 203.0}}, .ci95 = {}, .from = {}}};
  return model;
}

class PaperDesign : public testing::TestWithParam<PaperAxis> {};

TEST_P(PaperDesign, ReproducesSampledModelKalmanGainPolesAndFeedback) {
  const PaperAxis& paper = GetParam();
  const host::AxisDesign design = host::design_axis(model_of(paper), printed_options(paper));

  const double A[3][3] = {{1.0, paper.a12, -paper.b1}, {0.0, paper.a22, -paper.b2}, {0.0, 0.0, 1.0}};
  const double B[3] = {paper.b1, paper.b2, 0.0};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(design.model.A(r, c), A[r][c], 1e-6) << r << ' ' << c;
    EXPECT_NEAR(design.model.B(r), B[r], 1e-6) << r;
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(design.Kobs(r, c), paper.kobs[r][c], 1e-6) << r << ' ' << c;
    const auto k = static_cast<std::size_t>(r);
    EXPECT_NEAR(design.observer_poles[k].real(), paper.poles[r][0], 1e-4);
    EXPECT_NEAR(design.observer_poles[k].imag(), paper.poles[r][1], 1e-4);
    EXPECT_NEAR(design.observer_fn_Hz[k], paper.fn_Hz[r], 1e-4);
    EXPECT_NEAR(design.observer_zeta[k], paper.zeta[r], 1e-4);
  }
  EXPECT_NEAR(design.Kc(0), paper.kc[0], 1e-4);
  EXPECT_NEAR(design.Kc(1), paper.kc[1], 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Axes, PaperDesign, testing::Values(kX, kY),
                         [](const auto& axis) { return std::string(axis.param.name); });

TEST(Design, PlacesTheClosedLoopPolesWhereAsked) {
  for (const double zeta : {0.7, 1.0, 1.3}) {
    host::DesignOptions options;
    options.bandwidth_Hz = 45.0;
    options.damping = zeta;
    const host::AxisDesign design = host::design_axis(model_of(kX), options);
    const Eigen::Matrix2d loop = design.model.A.topLeftCorner<2, 2>() - design.model.B.head<2>() * design.Kc;
    const std::complex<double> s =
        2.0 * std::numbers::pi * 45.0 * (-zeta + std::sqrt(std::complex<double>(zeta * zeta - 1.0)));
    const std::complex<double> z = std::exp(0.001 * s);
    const std::complex<double> characteristic = z * z - loop.trace() * z + loop.determinant();
    EXPECT_NEAR(std::abs(characteristic), 0.0, 1e-12) << zeta;
  }
}

TEST(Design, RiccatiSolutionSatisfiesItsEquationAndObserverIsStable) {
  const host::AxisDesign design = host::design_axis(model_of(kY), {});
  const Eigen::Matrix3d A = design.model.A;
  const Eigen::MatrixXd C = design.model.C;
  const Eigen::Vector2d q(*design.used.command_variance, design.used.disturbance_variance);
  const Eigen::Matrix3d Q = design.model.W * q.asDiagonal() * design.model.W.transpose();
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();
  R.diagonal() << *design.used.position_variance, *design.used.tach_variance;
  const Eigen::Matrix3d P = host::solve_estimator_dare(A, C, Q, R);
  const Eigen::Matrix3d again =
      A * P * A.transpose() - A * P * C.transpose() * (C * P * C.transpose() + R).inverse() * C * P * A.transpose() + Q;
  EXPECT_LT((again - P).norm(), 1e-10 * P.norm());
  for (const auto& pole : design.observer_poles) EXPECT_LT(std::abs(pole), 1.0);
}

TEST(Design, AxisWithoutViscousFrictionIsADoubleIntegrator) {
  sim::DriveDescription model = model_of(kX);
  model.effects.pop_back();
  const host::AxisDesign design = host::design_axis(model, {});
  const double Kw = 6.4898 * 0.4769 / kX.J, Ts = 0.001, rg = 10.0 / (2.0 * std::numbers::pi);
  EXPECT_NEAR(design.model.A(0, 1), rg * Ts, 1e-15);
  EXPECT_NEAR(design.model.B(0), rg * Kw * Ts * Ts / 2.0, 1e-15);
  EXPECT_NEAR(design.model.B(1), Kw * Ts, 1e-12);
}

TEST(Design, ServesALinearDriveWithEncoderOnly) {
  const host::AxisDesign design = host::design_axis(linear_motor(), {});
  EXPECT_EQ(design.Kobs.cols(), 1);
  EXPECT_EQ(design.model.C.rows(), 1);
  for (const auto& pole : design.observer_poles) EXPECT_LT(std::abs(pole), 1.0);
  const nlohmann::json json = host::design_json(design);
  EXPECT_EQ(json["Kobs"].size(), 3u);
  EXPECT_EQ(json["Kobs"][0].size(), 1u);
  EXPECT_THAT(host::board_parameters_toml(linear_motor(), design), testing::HasSubstr("[stage.kalman]"));
}

TEST(Design, JsonHoldsTheContractsFields) {
  const nlohmann::json json = host::design_json(host::design_axis(model_of(kX), printed_options(kX)));
  EXPECT_EQ(json["format"], "axis-design/1");
  for (const char* field : {"A", "B", "Kobs", "observer_poles", "observer_fn_Hz", "observer_zeta", "Kc"}) {
    EXPECT_TRUE(json.contains(field)) << field;
  }
  EXPECT_NEAR(json["Kobs"][1][0].get<double>(), kX.kobs[1][0], 1e-6);
  EXPECT_NEAR(json["observer_poles"][1][1].get<double>(), kX.poles[1][1], 1e-4);
}

TEST(Design, BoardParametersNameEveryGainWithItsUnit) {
  const host::AxisDesign design = host::design_axis(model_of(kX), printed_options(kX));
  const std::string toml = host::board_parameters_toml(model_of(kX), design);
  EXPECT_THAT(toml, testing::HasSubstr("format = \"axis-params/1\""));
  EXPECT_THAT(toml, testing::HasSubstr("[x.kalman]\nk11 = 0.34611427  # correction"));
  EXPECT_THAT(toml, testing::HasSubstr("k21 = 65.0704645  # (rad/s)/mm: correction"));
  EXPECT_THAT(toml, testing::HasSubstr("k1 = 48.4440533  # V/mm"));
}

TEST(Design, RefusesWhatCannotBeDesignedAndSaysWhy) {
  const auto message = [](const sim::DriveDescription& model, const host::DesignOptions& options) -> std::string {
    try {
      host::design_axis(model, options);
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::bad_input);
      return failure.what();
    }
    return "";
  };
  sim::DriveDescription massless = model_of(kX);
  massless.effects.erase(massless.effects.begin());
  EXPECT_THAT(message(massless, {}), testing::HasSubstr("inertia"));
  sim::DriveDescription ideal_encoder = model_of(kX);
  ideal_encoder.data.encoder_resolution = 0.0;
  EXPECT_THAT(message(ideal_encoder, {}), testing::HasSubstr("--rx"));
  host::DesignOptions too_fast;
  too_fast.bandwidth_Hz = 500.0;
  EXPECT_THAT(message(model_of(kX), too_fast), testing::HasSubstr("--fc"));
}

TEST(Design, RefusesGainsThatAreNoNumbers) {
  host::DesignOptions endless;
  endless.disturbance_variance = 1e300;
  try {
    host::design_axis(model_of(kX), endless);
    FAIL() << "gains of 1e300 V² a sample";
  } catch (const host::Failure& failure) {
    EXPECT_THAT(failure.what(), testing::HasSubstr("--rwd"));
  }
}

}  // namespace
