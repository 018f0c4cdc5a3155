#include "host/compare/residual_effort.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "host/compare/effort_residual.hpp"

namespace host {

namespace {

/// A turning point counts once the axis has moved back from it by this many encoder steps.
constexpr double kBelievedSteps = 3.0;

/// For every row: signed travel since the last reversal, and duration of the rest before the present motion, s.
struct History {
  std::vector<double> since_reversal, rest_s;

  History(const SmoothedMotion& motion, double resolution, double period_s)
      : since_reversal(motion.x.size()), rest_s(motion.x.size()) {
    std::size_t turning = 0, extreme = 0;
    double direction = 0.0, rest = 0.0;
    for (std::size_t k = 0; k < motion.x.size(); ++k) {
      const double beyond = motion.x[k] - motion.x[extreme];
      if (direction == 0.0 ? std::abs(beyond) > kBelievedSteps * resolution
                           : beyond * direction < -kBelievedSteps * resolution) {
        turning = extreme;
        extreme = k;
        direction = beyond > 0.0 ? 1.0 : -1.0;
      } else if (beyond * direction > 0.0) {
        extreme = k;
      }
      since_reversal[k] = motion.x[k] - motion.x[turning];
      if (motion.standing[k]) rest = k > 0 && motion.standing[k - 1] ? rest + period_s : period_s;
      rest_s[k] = rest;
    }
  }
};

/// Mean over the samples of one average.
double mean_of(const std::vector<double>& values, std::size_t row, std::size_t step) {
  const std::size_t begin = row - step / 2;
  double sum = 0.0;
  for (std::size_t k = begin; k < begin + step; ++k) sum += values[k];
  return sum / static_cast<double>(step);
}

enum class Beyond { motion, inverse_model, speed_channel };

/// Torque or force that the measured motion of each row needed beyond the model; NaN if the axis stands or reverses.
std::vector<double> missing_by_row(const sim::DriveDescription& model, const PreparedRecord& prepared) {
  std::vector<double> missing(prepared.record->size(), std::nan(""));
  const ResidualSamples samples = residual_samples(model, prepared, 1);
  for (std::size_t k = 0; k < samples.row.size(); ++k) missing[samples.row[k]] = samples.missing[k];
  return missing;
}

/// Appends the averages of one record.
void append(const sim::Drive& drive, const sim::DriveDescription& model, const PreparedRecord& prepared,
            std::size_t index, const Prediction& prediction, std::size_t first_window, bool with_temperature,
            Beyond what, ResidualEffort& out) {
  const Record& record = *prepared.record;
  const SmoothedMotion& motion = prepared.motion();
  const History history(motion, model.data.encoder_resolution, prepared.period_s);
  const std::vector<double> missing =
      what == Beyond::inverse_model ? missing_by_row(model, prepared) : std::vector<double>{};
  const std::size_t step =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(out.period_s / prepared.period_s)));
  const double step_s = static_cast<double>(step) * prepared.period_s;
  const bool by_position = record.has_position();
  for (std::size_t place = 0; place < prepared.windows.size(); ++place) {
    const Window& window = prepared.windows[place];
    // Difference between the motion and its prediction; zero at the restart.
    const auto beyond = [&](std::size_t row) {
      if (row == window.begin) return 0.0;
      return by_position ? motion.x[row] - prediction.x[row] : motion.w[row] - prediction.w[row];
    };
    const auto acceleration_at = [&](std::size_t row) {
      return (motion.w[row + step] - motion.w[row - step]) / (2.0 * step_s);
    };
    // For changes slower than its filter, a tachometer shows the speed with a delay of one time constant.
    const auto motion_at = [&](std::size_t row) {
      sim::DriveMotion at;
      at.x = motion.x[row];
      at.w = motion.w[row];
      at.tach = at.w - drive.tach_lag_s * acceleration_at(row);
      return at;
    };
    for (std::size_t row = window.begin + step; row + step <= window.begin + window.length; row += step) {
      // At standstill and at reversals the smoother rounds off the motion.
      if (motion.standing[row] || motion.w[row - step] * motion.w[row + step] <= 0.0) continue;
      const double bend = beyond(row + step) - 2.0 * beyond(row) + beyond(row - step);
      const double slope = 0.5 * (beyond(row + step) - beyond(row - step));
      const double acceleration = by_position ? bend / (step_s * step_s * drive.lead) : slope / step_s;
      const double inverse = what == Beyond::inverse_model ? mean_of(missing, row, step) : 0.0;
      if (std::isnan(inverse)) continue;
      out.record.push_back(index);
      out.slot.push_back(row / step);
      out.window.push_back(first_window + place);
      out.missing.push_back(what == Beyond::speed_channel
                                ? mean_of(record.w, row, step) - drive.tachometer(motion_at(row))
                            : what == Beyond::inverse_model ? inverse
                                                            : drive.inertia * acceleration);
      out.t_s.push_back(record.t_s[row] - record.t_s.front());
      out.x.push_back(motion.x[row]);
      out.w.push_back(motion.w[row]);
      out.acceleration.push_back(acceleration_at(row));
      out.command_V.push_back(prepared.u_V[row]);
      out.since_reversal.push_back(history.since_reversal[row]);
      out.rest_s.push_back(history.rest_s[row]);
      if (with_temperature) out.temp_C.push_back(record.temp_C[row]);
    }
  }
}

ResidualEffort residual(const sim::DriveDescription& model, const RecordSet& set, Beyond what) {
  const sim::Drive drive(model);
  const bool with_temperature = std::ranges::none_of(
      set.records, [](const ComparedRecord& compared) { return compared.prepared.record->temp_C.empty(); });
  ResidualEffort residual;
  Prediction prediction;
  std::size_t windows = 0;
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    const PreparedRecord prepared = in_long_windows(set.records[r].prepared, kWindow_s);
    predict(drive, prepared, prediction);
    append(drive, model, prepared, r, prediction, windows, with_temperature, what, residual);
    windows += prepared.windows.size();
  }
  return residual;
}

}  // namespace

ResidualEffort residual_effort(const sim::DriveDescription& model, const RecordSet& set) {
  return residual(model, set, Beyond::motion);
}

ResidualEffort residual_of_inverse(const sim::DriveDescription& model, const RecordSet& set) {
  return residual(model, set, Beyond::inverse_model);
}

ResidualEffort residual_of_speed_channel(const sim::DriveDescription& model, const RecordSet& set) {
  const bool both = std::ranges::all_of(set.records, [](const ComparedRecord& compared) {
    return compared.prepared.record->has_position() && compared.prepared.record->has_speed();
  });
  return both ? residual(model, set, Beyond::speed_channel) : ResidualEffort{};
}

}  // namespace host
