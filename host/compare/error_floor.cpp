#include "host/compare/error_floor.hpp"

#include <array>
#include <cmath>

namespace host {

namespace {

struct Channels {
  std::vector<double> x, w;

  WindowRun run(const Window& window, const sim::DriveState& start) {
    x.resize(window.length);
    w.resize(window.length);
    return {&window, start, x.data(), w.data()};
  }
};

/// The start state with another speed and the correlated change of travel.
sim::DriveState changed(sim::DriveState state, double w, double x) {
  state.w += w;
  state.x += x;
  state.load_w += w;
  state.load_x += x;
  return state;
}

/// The drive under a constant torque that moves it within a window about as far as white noise with `deviation` per
/// row. After n rows, white noise adds up to a speed of sqrt(n) and a travel of sqrt(n^3/3) steps, a constant torque to
/// n and n^2/2.
sim::Drive pushed(sim::DriveDescription model, double deviation, std::size_t rows) {
  constexpr double kBetween = 1.2;  // 1 for the speed, 4/3 for the travel
  model.effects.push_back(
      {"constant_torque", {{"torque", deviation * std::sqrt(kBetween / static_cast<double>(rows))}}, {}, {}});
  return sim::Drive(model);
}

double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum / static_cast<double>(a.size());
}

}  // namespace

void renew_floor(ErrorFloor& floor, const sim::DriveDescription& model, const sim::Drive& drive,
                 const PreparedRecord& prepared, std::size_t stride) {
  const double x_noise = model.data.encoder_resolution * model.data.encoder_resolution / 12.0;  // eq. (12)
  const double w_noise = model.data.tach_noise_variance.value_or(0.0);                          // eq. (46)
  const SmoothedMotion& motion = prepared.motion();
  const std::vector<sim::DriveState> states = restart_states(drive, prepared, stride);
  if (prepared.record->has_position()) floor.x.resize(prepared.windows.size());
  if (prepared.record->has_speed()) floor.w.resize(prepared.windows.size());
  // The effect of a measured torque that differs from the acting torque.
  std::vector<sim::Drive> misled;
  if (prepared.effort_noise > 0.0 && !prepared.windows.empty())
    for (const double sign : {-1.0, 1.0})
      misled.push_back(pushed(model, sign * prepared.effort_noise, prepared.windows.front().length));
  Channels nominal, slower, faster;
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
    const Window& window = prepared.windows[index];
    const sim::DriveState& start = states[index / stride];
    // The error of the restart has two independent parts: an error of the speed with the correlated error of the
    // travel, and an error of the travel alone. Each is tried with both signs, because friction makes the motion depend
    // on the sign. An axis that seems to stand still may creep; a command near breakaway then determines the whole
    // window.
    const bool stands = motion.standing[window.begin];
    const double speed_variance = stands ? motion.hidden_creep * motion.hidden_creep : motion.w_variance[window.begin];
    const double slant = !stands && speed_variance > 0.0 ? motion.xw_covariance[window.begin] / speed_variance : 0.0;
    double x_variance = motion.x_variance[window.begin] - slant * slant * speed_variance;
    double w_variance = 0.0;
    const auto spread = [&](const Channels& first, const Channels& second) {
      for (const Channels* disturbed : {&first, &second}) {
        x_variance += 0.5 * mean_square_difference(disturbed->x, nominal.x);
        w_variance += 0.5 * mean_square_difference(disturbed->w, nominal.w);
      }
    };
    const double deviation = std::sqrt(std::max(0.0, speed_variance));
    std::array runs{nominal.run(window, start), slower.run(window, changed(start, -deviation, -slant * deviation)),
                    faster.run(window, changed(start, deviation, slant * deviation))};
    if (deviation > 0.0) {
      run_side_by_side(drive, prepared, runs);
      spread(slower, faster);
    }
    if (!misled.empty()) {
      if (!(deviation > 0.0)) run_side_by_side(drive, prepared, std::span(runs).first(1));
      std::array less{slower.run(window, start)}, more{faster.run(window, start)};
      run_side_by_side(misled[0], prepared, less);
      run_side_by_side(misled[1], prepared, more);
      spread(slower, faster);
    }
    // For a diverging model the noise floor does not matter.
    if (!std::isfinite(x_variance + w_variance)) {
      x_variance = motion.x_variance[window.begin];
      w_variance = motion.w_variance[window.begin];
    }
    if (prepared.record->has_position()) floor.x[index] = std::sqrt(x_noise + x_variance);
    if (prepared.record->has_speed()) floor.w[index] = std::sqrt(w_noise + w_variance);
  }
}

}  // namespace host
