// Carries out the host's requests for excitations: one at a time, on one axis.
#pragma once

#include "firmware/app/motion_owner.hpp"
#include "firmware/app/parameters/bare_parameters.hpp"
#include "firmware/app/protocol/excitation_messages.hpp"
#include "firmware/core/excitation/excitation_run.hpp"

namespace firmware {

template <typename Scalar>
class ExcitationService {
 public:
  bool is_active() const { return run_.is_active(); }
  std::size_t axis() const { return axis_; }

  /// Call it in the control interrupt, before the axes' step. `axes`: an AxisGroup.
  template <typename Axes>
  [[gnu::noinline]] void before_step(Axes& axes) {
    run_.before_step(axes[axis_]);
  }

  // For the background, while nothing is active.

  /// All entries must be of one client, for one axis and one input; other entries are discarded.
  bool load(const ExcitationEntriesRequest& request, ClientToken client, const AxisValues& values, float rate_Hz) {
    if (request.count > kEntriesPerReport || request.first + request.count > kExcitationEntries ||
        request.input >= kExcitationInputs)
      return false;
    for (std::size_t i = 0; i < request.count; ++i)
      if (!ScalarTraits<float>::is_finite(request.entry[i].value)) return false;
    if (client != client_ || request.axis != loaded_axis_ || request.input != loaded_input_) forget();
    client_ = client;
    loaded_axis_ = request.axis;
    loaded_input_ = request.input;
    for (std::size_t i = 0; i < request.count; ++i) {
      const auto& entry = request.entry[i];
      loaded_ |= 1u << (request.first + i);
      plan_.entry[request.first + i] = {in_core_units(entry.value, request.input, values, rate_Hz), entry.first,
                                        entry.second};
    }
    return true;
  }

  /// Discards the loaded entries, because their owner or their units have changed.
  void forget() { loaded_ = 0; }
  bool is_others(ClientToken client) const { return loaded_ != 0 && client != client_; }

  /// False if the excitation is not possible, or not all of its entries were loaded. Otherwise start() follows.
  bool plan(const ExcitationRequest& r, const AxisValues& values, float rate_Hz) {
    for (const float value : {r.speed, r.drive_velocity, r.volts, r.amplitude, r.ride})
      if (!ScalarTraits<float>::is_finite(value)) return false;
    if (r.kind >= kExcitationKinds || r.input >= kExcitationInputs || !(r.speed > 0) || r.speed > kMostSpeedCounts)
      return false;
    const unsigned needed = r.count < kExcitationEntries ? (1u << r.count) - 1 : (1u << kExcitationEntries) - 1;
    if (needed != 0 && ((loaded_ & needed) != needed || r.axis != loaded_axis_ || r.input != loaded_input_))
      return false;
    plan_.kind = static_cast<ExcitationKind>(r.kind);
    plan_.input = static_cast<ExcitationInput>(r.input);
    plan_.count = r.count;
    plan_.samples = r.samples;
    plan_.period = r.period;
    plan_.step = r.step;
    plan_.last_step = r.last_step;
    plan_.fade_samples = r.fade_samples;
    plan_.stall_samples = static_cast<std::uint32_t>(rate_Hz * kStall_s) + 1;
    plan_.box.travel_counts = r.travel_counts;
    plan_.box.margin_counts = r.margin_counts;
    plan_.box.speed = static_cast<std::int32_t>(r.speed * (256.0F * kSpeedSamples));
    plan_.box.drive_velocity = velocity_in_core_units(r);
    plan_.box.counts_per_velocity = kIsFloat && r.drive_velocity > 0 ? Scalar(r.speed / r.drive_velocity) : Scalar(1);
    plan_.box.volts = in_core_units(r.volts, static_cast<std::uint8_t>(ExcitationInput::output), values, rate_Hz);
    plan_.amplitude = in_core_units(r.amplitude, r.input, values, rate_Hz);
    plan_.ride = in_core_units(r.ride, static_cast<std::uint8_t>(ExcitationInput::jog), values, rate_Hz);
    axis_ = r.axis;
    if (!is_possible(plan_)) return false;
    run_.prepare(plan_);
    return true;
  }

  // For the background, while the control interrupt is disabled.
  void start() { run_.start(); }
  void stop() { run_.stop(); }
  ExcitationStatePayload state() const {
    return {.phase = static_cast<std::uint8_t>(run_.phase()),
            .end = static_cast<std::uint8_t>(run_.end()),
            .axis = static_cast<std::uint8_t>(axis_),
            .elapsed = run_.elapsed(),
            .farthest = run_.farthest(),
            .fastest = static_cast<float>(run_.fastest()) * (1.0F / kSpeedSamples)};
  }

 private:
  static constexpr float kStall_s = 0.25F;
  static constexpr bool kIsFloat = std::is_same_v<Scalar, float>;

  static Scalar in_core_units(float value, std::uint8_t input, const AxisValues& v, float rate_Hz) {
    const bool is_volts = input == static_cast<std::uint8_t>(ExcitationInput::open_loop) ||
                          input == static_cast<std::uint8_t>(ExcitationInput::output);
    if constexpr (kIsFloat) {
      if (is_volts) return value * v.get<"drive.dac_resolution">();
      const bool is_jog = input == static_cast<std::uint8_t>(ExcitationInput::jog);
      return is_jog ? value * v.get<"drive.encoder_resolution">() * rate_Hz : value;
    } else {
      return Scalar::from(is_volts ? value * (1.0F / 4096) : value);  // fixed_units.hpp
    }
  }

  /// The request contains the same speed in both units.
  static Scalar velocity_in_core_units(const ExcitationRequest& r) {
    if constexpr (kIsFloat)
      return r.drive_velocity > 0 ? r.drive_velocity : 0;
    else
      return r.drive_velocity > 0 ? Scalar::from(r.speed) : Scalar{};
  }

  ExcitationPlan<Scalar> plan_{};
  ExcitationRun<Scalar> run_;
  std::size_t axis_ = 0;
  ClientToken client_ = 0;  ///< who loaded the entries
  unsigned loaded_ = 0;     ///< entries
  std::uint8_t loaded_axis_ = 0, loaded_input_ = 0;
};

}  // namespace firmware
