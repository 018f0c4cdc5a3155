// The board's own axis on a plant in this process. It performs excitations as a board does, but without the protocol.
#pragma once

#include <cmath>
#include <functional>
#include <utility>

#include "firmware/app/excitation_service.hpp"
#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "host/device/excitation.hpp"
#include "host/record/record.hpp"

namespace host {

/// `Hal`: the board's end of the connectors of a drive. Deterministic.
template <firmware::SupervisedHal Hal>
class ExcitedAxis {
 public:
  /// `values`: the board's parameters, with a design on its first axis. `advance`: advances the plant by one control
  /// period. The first row of the record belongs to the first piece.
  ExcitedAxis(Hal& hal, const firmware::ParameterValues& values, const sim::DriveDescription& drive,
              std::function<void()> advance)
      : wires_(hal),
        data_(drive.data),
        values_(values),
        rate_Hz_(static_cast<float>(1.0 / data_.sample_period_s)),
        advance_(std::move(advance)),
        axes_([&hal](std::size_t) -> Hal& { return hal; }) {
    record_.drive = drive.name;
    record_.kind = data_.kind;
    record_.sample_period_s = data_.sample_period_s;
    axes_.board().configure(firmware::BoardWatch::default_limits(static_cast<float>(data_.sample_period_s)));
    axes_.board().host_commands(true);
    is_usable_ = axes_[0].configure(firmware::axis_parameters<float>(values_.axis(0))) == firmware::Refusal::none;
    for (int k = 0; k <= firmware::kSelfTestSamples; ++k) step();
    start_counts_ = axes_[0].telemetry().encoder_counts;
    record_.t_s.clear();
    record_.u_V.clear();
    record_.x.clear();
    record_.w.clear();
    record_.x2.clear();
  }

  /// Runs an excitation from standstill to standstill, followed by a short rest. The end is `refused` if the axis does
  /// not accept it.
  firmware::ExcitationStatePayload run(const Excitation& excitation) {
    const auto refused = static_cast<std::uint8_t>(firmware::ExcitationEnd::refused);
    constexpr firmware::ClientToken kClient = 1;  // the only client
    firmware::ExcitationStatePayload none;
    none.end = refused;
    const bool is_open = excitation.request.input == static_cast<std::uint8_t>(firmware::ExcitationInput::open_loop);
    if (!is_usable_ || (!is_open && !enable())) return none;
    for (const auto& part : entry_requests(excitation, 0))
      if (!excitation_.load(part, kClient, values_.axis(0), rate_Hz_)) return none;
    if (!excitation_.plan(excitation.request, values_.axis(0), rate_Hz_)) return none;
    excitation_.start();
    // A stop within the limits of any drive takes less time.
    constexpr double kLongestStop_s = 10.0;
    const auto most = excitation.request.samples + samples(kLongestStop_s);
    for (std::size_t k = 0; k < most && excitation_.is_active(); ++k) step();
    const firmware::ExcitationStatePayload state = excitation_.is_active() ? none : excitation_.state();
    if (!is_open) axes_[0].disable();
    constexpr double kRest_s = 0.2;  // as between the pieces on a board
    for (std::size_t k = 0; k < samples(kLongestStop_s) && axes_.outputs_on(); ++k) step();
    for (std::size_t k = 0; k < samples(kRest_s); ++k) step();
    return state;
  }

  /// Position of the encoder relative to the axis's first position, mm (m).
  double offset() const {
    return static_cast<double>(axes_[0].telemetry().encoder_counts - start_counts_) * data_.encoder_resolution;
  }

  /// The record so far, one row per control period; the axis must not be used afterwards.
  Record take() { return std::move(record_); }

 private:
  std::size_t samples(double duration_s) const {
    return static_cast<std::size_t>(std::lround(duration_s / data_.sample_period_s));
  }

  bool enable() {
    constexpr double kLongestStart_s = 2.0;
    if (axes_.enable(1) != 1) return false;
    for (std::size_t k = 0; k < samples(kLongestStart_s); ++k) {
      step();
      if (axes_[0].state() == firmware::SupervisorState::enabled) return true;
    }
    return false;
  }

  void step() {
    if (excitation_.is_active()) excitation_.before_step(axes_);
    axes_.board().host_heard();
    axes_.step({now_us_, false, false, false});
    const auto& seen = axes_[0].telemetry();
    record_.t_s.push_back(data_.sample_period_s * static_cast<double>(record_.size()));
    record_.u_V.push_back(seen.dac_code * data_.dac_resolution_V);
    record_.x.push_back(static_cast<double>(seen.encoder_counts - start_counts_) * data_.encoder_resolution);
    if (data_.tach_noise_variance) record_.w.push_back(static_cast<double>(seen.tachometer_velocity));
    if constexpr (hal::TableEncoderHal<Hal>)
      if (const hal::EncoderReading table = wires_.table_encoder().read(); table.valid)
        record_.x2.push_back(static_cast<double>(static_cast<std::int32_t>(table.counts)) *
                             data_.load_encoder_resolution);
    now_us_ += static_cast<std::uint32_t>(std::lround(1e6 * data_.sample_period_s));
    advance_();
  }

  Hal& wires_;
  sim::DataSheet data_;
  firmware::ParameterValues values_;
  float rate_Hz_;
  std::function<void()> advance_;
  firmware::AxisGroup<float, Hal, 1> axes_;
  firmware::ExcitationService<float> excitation_;
  Record record_;
  std::int64_t start_counts_ = 0;
  std::uint32_t now_us_ = 0;
  bool is_usable_ = false;
};

}  // namespace host
