#include "host/insight/prediction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

PreparedRecord prepare(const Record& record, const sim::DriveDescription& base, double window_s) {
  const auto length = static_cast<std::size_t>(std::lround(window_s / record.sample_period_s));
  if (length < 2 || record.size() < length + 1)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: {} samples of {} s are too few for a window of {} s; record longer or choose --window",
                    record.path, record.size(), record.sample_period_s, window_s));
  const sim::EffectEntry* inertia = base.find("inertia");
  const sim::EffectEntry* viscous = base.find("viscous");
  if (inertia == nullptr)
    throw Failure(ExitCode::bad_input,
                  base.name + ": the model has no [[effect]] of kind \"inertia\"; identify the drive first");
  const sim::Drive drive(base);
  const double friction_level = drive.friction[0].coulomb + drive.friction[1].coulomb;
  PreparedRecord prepared{
      &record,
      command_volts(record, base.data),
      MotionSmoother(record, base.data, inertia->at("J"), viscous == nullptr ? 0.0 : viscous->at("B"), friction_level),
      {},
      record.sample_period_s};
  for (std::size_t begin = 0; begin + length < record.size(); begin += length)
    prepared.windows.push_back({begin, length});
  return prepared;
}

namespace {

/// The motion that windows restart from, as a drive understands it: one whose encoder errs or whose command arrives
/// changed sees another motion behind the same record.
class RestartMotion {
 public:
  RestartMotion(const sim::Drive& drive, const PreparedRecord& prepared)
      : x_(&prepared.motion().x), w_(&prepared.motion().w) {
    if (drive.encoder_error.empty() && !drive.shapes_effort()) return;
    changed_ = prepared.smoother.change(reading_change(drive, prepared), command_change(drive, prepared));
    for (std::size_t k = 0; k < changed_.x.size(); ++k) {
      changed_.x[k] += prepared.motion().x[k];
      changed_.w[k] += prepared.motion().w[k];
    }
    x_ = &changed_.x;
    w_ = &changed_.w;
  }
  RestartMotion(const RestartMotion&) = delete;
  RestartMotion& operator=(const RestartMotion&) = delete;

  double x(std::size_t row) const { return (*x_)[row]; }
  double w(std::size_t row) const { return (*w_)[row]; }

 private:
  /// What the true travel is less than the encoder's reading, row by row.
  std::vector<double> reading_change(const sim::Drive& drive, const PreparedRecord& prepared) const {
    std::vector<double> change;
    if (drive.encoder_error.empty()) return change;
    for (const double x : prepared.motion().x) change.push_back(-drive.encoder_error_at(x - drive.encoder_error_at(x)));
    return change;
  }

  /// What the drive's inertia is given beyond the recorded command, in volts.
  std::vector<double> command_change(const sim::Drive& drive, const PreparedRecord& prepared) const {
    std::vector<double> change;
    if (!drive.shapes_effort()) return change;
    const std::size_t n = x_->size();
    change.resize(n);
    sim::DriveState state = drive.at((*x_)[0], (*w_)[0]);
    for (std::size_t k = 0; k + 1 < n; ++k) {
      const double effort =
          drive.follow(state, prepared.u_V[k], (*x_)[k + 1], (*w_)[k + 1], prepared.record->t_s[k], prepared.period_s);
      change[k] = effort / drive.effort_per_volt - prepared.u_V[k];
    }
    return change;
  }

  const std::vector<double>* x_;
  const std::vector<double>* w_;
  MotionSmoother::Change changed_;
};

/// Gives use(window index, restart state) every `stride`-th window; hidden states follow the motion from the record's
/// start.
template <typename Use>
void for_each_restart(const sim::Drive& drive, const PreparedRecord& prepared, std::size_t stride, Use use) {
  const RestartMotion motion(drive, prepared);
  const bool hidden = drive.has_hidden_state();
  sim::DriveState followed = drive.at(motion.x(0), motion.w(0));
  std::size_t row = 0;
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
    const std::size_t begin = prepared.windows[index].begin;
    if (!hidden) {
      use(index, drive.at(motion.x(begin), motion.w(begin)));
      continue;
    }
    for (; row < begin; ++row)
      drive.follow(followed, prepared.u_V[row], motion.x(row + 1), motion.w(row + 1), prepared.record->t_s[row],
                   prepared.period_s);
    use(index, followed);
  }
}

}  // namespace

std::vector<sim::DriveState> restart_states(const sim::Drive& drive, const PreparedRecord& prepared) {
  std::vector<sim::DriveState> states;
  states.reserve(prepared.windows.size());
  for_each_restart(drive, prepared, 1, [&](std::size_t, const sim::DriveState& state) { states.push_back(state); });
  return states;
}

void predict(const sim::Drive& drive, const PreparedRecord& prepared, Prediction& out, std::size_t stride) {
  out.x.resize(prepared.record->size());
  out.w.resize(prepared.record->size());
  const std::vector<double>& t_s = prepared.record->t_s;
  for_each_restart(drive, prepared, stride, [&](std::size_t index, sim::DriveState state) {
    const Window& window = prepared.windows[index];
    for (std::size_t k = window.begin; k < window.begin + window.length; ++k) {
      drive.step(state, prepared.u_V[k], t_s[k], prepared.period_s);
      out.x[k + 1] = drive.encoder(state);
      out.w[k + 1] = drive.tachometer(state);
    }
  });
}

}  // namespace host
