// Excitation for identification: open-loop steps for inertia, jogs for the friction curve.
#pragma once

#include <array>
#include <vector>

namespace host {

/// Amplitude of the step series at Ku = 1, V. With this value the paper's drives stand still at Ku <= 2.5, hardly move
/// at 5 and move well from 7.5 on, as section 3.1 of the paper reports for its own signal (whose amplitude is not
/// printed).
inline constexpr double kStepUnit_V = 0.3;

/// The scalings of the step series in the paper, p. 1499.
inline constexpr std::array kPaperScalings = {1.0, 2.5, 5.0, 7.5, 10.0, 12.5, 15.0};

/// Command for open-loop identification, one value per sample: doublets +a -a and -a +a of four durations (50 to 200 ms
/// per step), each followed by rest. The travel of the two orders cancels. Different durations reach different speeds,
/// which separates viscous from Coulomb friction. Lasts about 4 s.
std::vector<double> doublet_series(double amplitude_V, double sample_period_s);

/// One jog of the friction programme.
struct Jog {
  double speed;       ///< travel per second with its sign: mm/s, or m/s if scaled so
  double constant_s;  ///< time at constant speed, without acceleration
};

/// Speeds of the paper's jogging tests, p. 1504, mm/s.
inline constexpr std::array kPaperJogSpeeds_mm_s = {0.1, 0.3, 0.5, 1.0, 3.0, 5.0, 10.0, 25.0, 50.0, 75.0, 100.0};

/// Each speed forward and then backward, so that the axis returns. A speed is held for `settle_s`, in which the
/// estimator settles, and then for whole turns of the screw: as many as fit into `longest_s`. A speed too slow for one
/// turn is held for `longest_s`.
std::vector<Jog> jogging_programme(const std::vector<double>& speeds, double travel_per_turn, double settle_s = 0.3,
                                   double longest_s = 3.0);

}  // namespace host
