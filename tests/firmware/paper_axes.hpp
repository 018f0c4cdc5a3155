// The paper's two axes, as parameters of the control core.
#pragma once

#include "firmware/core/axis_parameters.hpp"

namespace firmware_test {

/// Erkorkmaz and Altintas (2001), eqs. (47), (49), (51), to full precision: recomputed by solving the Riccati equation
/// and Ackermann's formula in double precision, independently of this project, from J = 7.65389e-3, B = 0.019872 (x)
/// and J = 9.78636e-3, B = 0.023876 (y); they agree with every digit that the paper prints.
struct PaperAxis {
  double Ad12, Ad22, Bd1, Bd2;
  double Kobs[3][2];
  double Kc[2];
  double observer_poles[3][2];  ///< real and imaginary parts, p. 1503
  double amplifier_gain_A_per_V;
  double static_Nm[2], coulomb_Nm[2];          ///< magnitudes, positive and negative direction, Table 1
  double omega1_rad_s[2], omega2_rad_s[2];     ///< likewise
  double viscous_Nm_s_per_rad, inertia_kg_m2;  ///< Table 1
  double model_viscous_Nm_s_per_rad;           ///< of the drive model above
};

inline constexpr PaperAxis kPaperX{
    0.0015894851059468785,
    0.9974070147838652,
    0.0003215070665699483,
    0.4038429422576441,
    {{0.34611426957160996, 0.0006464169870471526},
     {65.07046450655567, 0.349253807424954},
     {-25.794229508666586, -0.3082011241888027}},
    {48.44405325182899, 0.6064573749898439},
    {{0.6778842874360118, 0.0}, {0.6944369251385613, 0.2862675203669791}, {0.6944369251385613, -0.2862675203669791}},
    6.4898,
    {3.647, 2.702},
    {2.205, 1.656},
    {2.0, 2.0},
    {2.0, 2.0},
    0.0321,
    7.65e-3,
    0.0198722104983324};

inline constexpr PaperAxis kPaperY{
    0.001589609563124967,
    0.9975632810432217,
    0.00029358165222351793,
    0.3687756348926911,
    {{0.34516990742928644, 0.0006396118153243618},
     {64.3854334910936, 0.3319714535738079},
     {-27.88665248828222, -0.31023544035629286}},
    {53.050655056962796, 0.6645509633276226},
    {{0.6832839241831243, 0.0}, {0.7065024675957742, 0.2817461039395824}, {0.7065024675957742, -0.2817461039395824}},
    7.5768,
    {3.652, 3.218},
    {3.058, 2.739},
    {4.1, 3.6},
    {5.4, 4.2},
    0.0287,
    9.79e-3,
    0.023875714036238428};

inline constexpr double kLead_mm_per_rad = 1.5915494309189535;   // 10 / (2 pi), Table 1
inline constexpr double kSamplePeriod_s = 0.001;                 // Table 1
inline constexpr double kEncoderResolution_mm = 10.0 / 4096.0;   // Table 1
inline constexpr double kDacResolution_V = 20.0 / 65536.0;       // Table 1
inline constexpr double kMotorConstant_Nm_per_A = 0.4769;        // Table 1
inline constexpr double kTachometerResolution_rad_s = 1.0 / 64;  // this project's simulated board

/// Each threshold at its parameter's initial value.
template <typename Real>
constexpr firmware::MonitorLimits<Real> initial_monitor_limits(float encoder_resolution, float sample_period_s) {
  const auto initial = [](auto id) {
    float value = 0;
    for (const firmware::ThresholdRow& row : firmware::kThresholdRows)
      if (row.id == decltype(id)::value) value = row.initial;
    return value;
  };
  return firmware::monitor_limits<Real>(initial, encoder_resolution, sample_period_s);
}

/// Default thresholds. Following error: the travel in 2 ms at the velocity limit, and in 5 ms at the present speed;
/// state feedback without any feed-forward lags by about 1 ms. Disagreement: 4 % of the velocity limit and 10 % of the
/// speed (tachometers are within 2 %, ripple included); a jump: a quarter of the limit; neither below the speed noise
/// of the encoder's steps. Overspeed: a fifth above the limit. Polarity: 30 % of the converter, well above any friction
/// that can still be overcome. Oscillation: 25 % of the converter. Saturation: 0.1 s. Travel: the range of an encoder
/// counter. `velocity_limit` mm/s (m/s), `lead` mm/rad (1).
template <typename Real>
constexpr firmware::MonitorLimits<Real> default_monitor_limits(Real velocity_limit, Real lead, Real encoder_resolution,
                                                               Real sample_period_s, Real dac_limit_V) {
  const Real fastest = velocity_limit / lead;
  const Real count = encoder_resolution / (lead * sample_period_s);
  const auto larger = [](Real a, Real b) { return a > b ? a : b; };
  auto limits =
      initial_monitor_limits<Real>(static_cast<float>(encoder_resolution), static_cast<float>(sample_period_s));
  limits.following_error_floor = velocity_limit * Real(0.002f);
  limits.following_error_per_velocity = lead * Real(0.005f);
  limits.disagreement_floor = larger(fastest * Real(0.04f), count * Real(2));
  limits.disagreement_share = Real(0.1f);
  limits.encoder_jump = larger(fastest * Real(0.25f), count * Real(8));
  limits.overspeed = larger(fastest * Real(1.2f), fastest + count * Real(2));
  limits.polarity_command_V = dac_limit_V * Real(0.3f);
  limits.oscillation_V = dac_limit_V * Real(0.25f);
  firmware::set_filters(limits, sample_period_s);
  limits.travel_min_counts = -(std::int64_t{1} << 31);
  limits.travel_max_counts = std::int64_t{1} << 31;
  const std::int32_t samples = firmware::ScalarTraits<Real>::truncate(Real(0.1f) / sample_period_s + Real(0.5f));
  limits.saturation_samples = samples;
  limits.capture_stride = firmware::capture_stride(Real(1) / sample_period_s);
  return limits;
}

template <typename Scalar>
constexpr firmware::AxisParameters<Scalar> parameters_of(const PaperAxis& axis) {
  const auto scalar = [](double value) { return static_cast<Scalar>(value); };
  firmware::AxisParameters<Scalar> p;
  p.sample_period_s = scalar(kSamplePeriod_s);
  p.lead = scalar(kLead_mm_per_rad);
  p.encoder_resolution = scalar(kEncoderResolution_mm);
  p.dac_resolution_V = scalar(kDacResolution_V);
  p.dac_limit_V = scalar(10.0);
  p.tachometer_gain = scalar(kTachometerResolution_rad_s);
  p.drive = {scalar(axis.Ad12), scalar(axis.Ad22), scalar(axis.Bd1), scalar(axis.Bd2)};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 2; ++column) p.Kobs[row][column] = scalar(axis.Kobs[row][column]);
  p.Kc = {scalar(axis.Kc[0]), scalar(axis.Kc[1])};
  const double effort_per_volt = axis.amplifier_gain_A_per_V * kMotorConstant_Nm_per_A;
  const auto direction = [&](int side) {
    return firmware::FrictionDirection<Scalar>{
        scalar(axis.static_Nm[side] / effort_per_volt), scalar(axis.coulomb_Nm[side] / effort_per_volt),
        scalar((axis.viscous_Nm_s_per_rad - axis.model_viscous_Nm_s_per_rad) / effort_per_volt),
        scalar(axis.omega1_rad_s[side]), scalar(axis.omega2_rad_s[side])};
  };
  p.friction = {direction(0), direction(1), scalar(0.2)};
  p.velocity_limit = scalar(250.0);
  p.acceleration_limit = scalar(2000.0);  // section 4
  p.jerk_limit = scalar(50000.0);         // section 4
  p.monitors = default_monitor_limits(p.velocity_limit, p.lead, p.encoder_resolution, p.sample_period_s, p.dac_limit_V);
  return p;
}

}  // namespace firmware_test
