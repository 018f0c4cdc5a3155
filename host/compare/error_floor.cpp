#include "host/compare/error_floor.hpp"

#include <cmath>

namespace host {

namespace {

struct Channels {
  std::vector<double> x, w;
};

void run_window(const sim::Drive& drive, const PreparedRecord& prepared, const Window& window, sim::DriveState state,
                Channels& out) {
  out.x.resize(window.length);
  out.w.resize(window.length);
  for (std::size_t k = 0; k < window.length; ++k) {
    const std::size_t row = window.begin + k;
    drive.step(state, prepared.u_V[row], prepared.record->t_s[row], prepared.period_s);
    out.x[k] = drive.encoder(state);
    out.w[k] = drive.tachometer(state);
  }
}

double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum / static_cast<double>(a.size());
}

}  // namespace

ErrorFloor error_floor(const sim::Drive& drive, const sim::DataSheet& data, const PreparedRecord& prepared) {
  const double x_noise = data.encoder_resolution * data.encoder_resolution / 12.0;  // eq. (12)
  const double w_noise = data.tach_noise_variance.value_or(0.0);                    // eq. (46)
  const SmoothedMotion& motion = prepared.motion();
  const std::vector<sim::DriveState> states = restart_states(drive, prepared);
  ErrorFloor floor;
  Channels nominal, disturbed;
  for (std::size_t index = 0; index < states.size(); ++index) {
    const Window& window = prepared.windows[index];
    const sim::DriveState& start = states[index];
    // The two independent parts of the restart's error: of the speed with the travel that goes with it, and of the
    // travel alone. Each is tried up and down, since friction turns small errors into different motions.
    const double speed_variance = motion.w_variance[window.begin];
    const double slant = speed_variance > 0.0 ? motion.xw_covariance[window.begin] / speed_variance : 0.0;
    double x_variance = motion.x_variance[window.begin] - slant * slant * speed_variance;
    double w_variance = 0.0;
    run_window(drive, prepared, window, start, nominal);
    if (speed_variance > 0.0) {
      const double deviation = std::sqrt(speed_variance);
      for (const double change : {-deviation, deviation}) {
        sim::DriveState state = start;
        state.w += change;
        state.x += slant * change;
        state.load_w += change;
        state.load_x += slant * change;
        run_window(drive, prepared, window, state, disturbed);
        x_variance += 0.5 * mean_square_difference(disturbed.x, nominal.x);
        w_variance += 0.5 * mean_square_difference(disturbed.w, nominal.w);
      }
    }
    if (prepared.record->has_position()) floor.x.push_back(std::sqrt(x_noise + x_variance));
    if (prepared.record->has_speed()) floor.w.push_back(std::sqrt(w_noise + w_variance));
  }
  return floor;
}

}  // namespace host
