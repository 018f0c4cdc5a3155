// One excitation of one axis, from its beginning to standstill, within its box.
#pragma once

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/excitation/excitation_generator.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"

namespace firmware {

/// Numbers are permanent, because replies contain them.
enum class ExcitationPhase : std::uint8_t {
  idle = 0,
  opening = 1,  ///< the amplifier is being enabled
  running = 2,
  stopping = 3,  ///< the excitation fades out, and the axis comes to rest
  done = 4,
};

enum class ExcitationEnd : std::uint8_t {
  none = 0,
  completed = 1,  ///< its time is over
  asked = 2,      ///< it was stopped by request
  travel = 3,     ///< the axis left the box
  speed = 4,
  no_motion = 5,  ///< the command was large for long without an encoder count
  fault = 6,      ///< the axis stopped for another reason: a fault, or a disable
  refused = 7,    ///< the axis could not be enabled
  blind = 8,      ///< the tachometer shows motion that the encoder does not
};

/// Computes the input before each step. It checks the box with the encoder's raw counts, and with the tachometer if its
/// scale is known, so it needs neither model nor estimate. In an open loop it stops the axis by reversing the command
/// that accelerated it. The direction in which a command accelerates the drive follows from the excitation itself, as
/// the sign of the sum of command times change of speed. The command falls to 0 when the axis reverses, when it has
/// slowed to the encoder's resolution, or when braking makes it faster. A closed loop stops as its reference does. A
/// train reverses in time: a drive needs no longer distance to lose its speed under the reversed command than it took
/// to reach it; friction helps. A margin of half that distance allows for levels of unequal size.
template <typename Scalar>
class ExcitationRun {
 public:
  /// The slow part of the start, outside the control interrupt, while nothing is active. `plan` is possible and must
  /// outlive the run.
  constexpr void prepare(const ExcitationPlan<Scalar>& plan) {
    plan_ = &plan;
    room_ = plan.box.travel_counts - plan.box.travel_counts / 10;
    too_fast_ = plan.box.speed / 256;
    nearly_too_fast_ = plan.box.speed / 320;
    generator_.start(plan);
  }
  /// In an open loop the axis is enabled as soon as this is allowed; a closed loop is enabled already.
  constexpr void start() {
    phase_ = ExcitationPhase::opening;
    end_ = ExcitationEnd::none;
    elapsed_ = waited_ = longest_silence_ = 0;
    still_samples_ = still_before_ = still_at_ = rest_at_ = 0;
    largest_for_ = 0;
    largest_change_ = 0;
    is_abrupt_ = was_forward_ = false;
    woken_by_ = Scalar(0);
    moved_forward_by_ = moved_backward_by_ = Scalar(0);
    farthest_ = fastest_ = 0;
    sum_of_effects_ = 0;
    last_value_ = ride_ = unseen_ = Scalar(0);
    last_ride_ = plan_->ride;
    earlier_value_ = {};
    last_reference_ = 0;
    is_braking_ = is_asked_ = is_requested_ = false;
    may_turn_ = true;
    slowest_ = 0;
  }

  constexpr void stop() {
    is_asked_ = phase_ == ExcitationPhase::opening;
    if (phase_ == ExcitationPhase::running) leave(ExcitationEnd::asked);
  }

  constexpr bool is_active() const { return phase_ != ExcitationPhase::idle && phase_ != ExcitationPhase::done; }
  constexpr ExcitationPhase phase() const { return phase_; }
  constexpr ExcitationEnd end() const { return end_; }
  constexpr std::uint32_t elapsed() const { return elapsed_; }
  constexpr std::int32_t farthest() const { return farthest_; }  ///< counts from where it began
  constexpr std::int32_t fastest() const { return fastest_; }    ///< counts in kSpeedSamples

  /// Call it before the axis's step: applies the excitation. For a SupervisedAxis.
  template <typename Axis>
  constexpr void before_step(Axis& axis) {
    const bool is_on = axis.state() == SupervisorState::enabled;
    if (phase_ == ExcitationPhase::opening) return open(axis, is_on);
    see(axis.telemetry());
    if (!is_on && phase_ == ExcitationPhase::running) leave(ExcitationEnd::fault);
    if (phase_ == ExcitationPhase::running) {
      judge(axis.telemetry());
      if (++elapsed_ >= plan_->samples) leave(ExcitationEnd::completed);
    }
    if (phase_ == ExcitationPhase::stopping && has_ended(axis)) {
      axis.excite(Scalar(0));
      phase_ = ExcitationPhase::done;
    } else if (plan_->input == ExcitationInput::open_loop) {
      drive_open(axis);
    } else {
      drive_closed(axis);
    }
  }

 private:
  using Traits = ScalarTraits<Scalar>;
  static constexpr std::uint32_t kLongestOpening = 1000;  ///< samples
  static constexpr std::int32_t kStill = 20;              ///< samples of a standstill
  static constexpr Scalar kUneven{0.6f};       ///< excess of the breakaway command in one place over that in another
  static constexpr int kSlipShift = 6;         ///< slip: less than this part, 2^-n, of the window's half
  static constexpr std::int32_t kFlicker = 2;  ///< counts of a standing axis on an encoder edge

  template <typename Axis>
  constexpr void open(Axis& axis, bool is_on) {
    if (plan_->input == ExcitationInput::open_loop && !is_on && !is_requested_) is_requested_ = axis.enable_open_loop();
    if (is_on) {
      begin(axis.telemetry().encoder_counts);
      phase_ = ExcitationPhase::running;
      if (is_asked_) leave(ExcitationEnd::asked);
    } else if (axis.state() == SupervisorState::fault ||
               (axis.state() != SupervisorState::starting && ++waited_ > kLongestOpening)) {  // starting has a limit
      end_ = ExcitationEnd::refused;
      phase_ = ExcitationPhase::done;
    }
  }

  constexpr void begin(std::int64_t counts) {
    start_ = counts;
    turned_at_ = way_ = 0;
    seen_ = {};
    speed_ = speed_before_ = 0;
    waited_ = 0;
  }

  template <typename Telemetry>
  constexpr void see(const Telemetry& seen) {
    way_ = static_cast<std::int32_t>(seen.encoder_counts - start_);
    const std::int32_t last_speed = speed_;
    const std::int32_t middle = seen_[(place_ + kSpeedSamples) % seen_.size()];
    speed_ = way_ - middle;
    speed_before_ = middle - seen_[place_];
    seen_[place_] = way_;
    place_ = (place_ + 1) % seen_.size();
    if ((speed_ > 0) != is_forward_ && speed_ != 0) {
      is_forward_ = speed_ > 0;
      turned_at_ = way_;
    }
    if (plan_->input == ExcitationInput::open_loop) see_open_loop(speed_ - last_speed);
    farthest_ = larger(farthest_, magnitude(way_));
    fastest_ = larger(fastest_, magnitude(speed_));
  }

  /// Out of line, like does_nothing(): a closed loop has no time to save registers that it does not use.
  [[gnu::noinline]] constexpr void see_open_loop(std::int32_t change_of_speed) {
    const bool is_still = magnitude(way_ - still_at_) <= kFlicker;
    still_before_ = still_samples_;
    still_samples_ = is_still ? still_samples_ + 1 : 0;
    if (!is_still) still_at_ = way_;
    largest_change_ = larger(largest_change_, magnitude(change_of_speed));
    if (phase_ == ExcitationPhase::running) learn(change_of_speed);
  }

  /// Direction in which a command accelerates: the sum of signs of command times change of speed. The mean speed is two
  /// samples older than the last command.
  constexpr void learn(std::int32_t change) {
    const Scalar value = earlier_value_[0];
    earlier_value_[0] = earlier_value_[1];
    earlier_value_[1] = last_value_;
    if (value > Scalar(0)) sum_of_effects_ += change;
    if (value < Scalar(0)) sum_of_effects_ -= change;
  }

  template <typename Telemetry>
  constexpr void judge(const Telemetry& seen) {
    if (magnitude(way_) > plan_->box.travel_counts) return leave(ExcitationEnd::travel);
    // One count is the encoder's resolution and does not count as speed.
    if (magnitude(speed_) - 1 > too_fast_) return leave(ExcitationEnd::speed);
    if (plan_->box.drive_velocity > Scalar(0)) {
      if (Traits::magnitude(seen.tachometer_velocity) > plan_->box.drive_velocity) return leave(ExcitationEnd::speed);
      if (is_blind(seen)) return leave(ExcitationEnd::blind);
    }
    if (plan_->input != ExcitationInput::open_loop) return;
    if (does_nothing()) leave(ExcitationEnd::no_motion);
  }

  /// The encoder shows at most a flicker under a command near the largest, for the plan's time. Before the first motion
  /// the times add up; later they must be continuous, since cogging may hold the axis, or the command may change too
  /// fast for it to move. An encoder that failed in motion looks the same. Without a tachometer to show that, a
  /// standstill that began more abruptly than the axis ever changed its speed is doubted: then a command well above the
  /// one that moved the axis in this direction may last only four times the longest silence so far. Weight, cogging and
  /// friction depend on the direction.
  [[gnu::noinline]] constexpr bool does_nothing() {
    const Scalar command = Traits::magnitude(last_value_);
    Scalar& moved_by = last_value_ > Scalar(0) ? moved_forward_by_ : moved_backward_by_;
    if (still_samples_ > 0) {
      if (still_samples_ == kSpeedSamples) is_abrupt_ = magnitude(speed_before_) > 2 * largest_change_;
      const bool is_largest = command >= plan_->amplitude * Scalar(0.9f) && (last_value_ > Scalar(0)) == was_forward_;
      largest_for_ = is_largest ? largest_for_ + 1 : 0;
      was_forward_ = last_value_ > Scalar(0);
      const bool is_enough = moved_by > Scalar(0) && command > moved_by + moved_by * kUneven;
      if (is_enough || is_largest) ++waited_;
      const bool is_seen = plan_->box.drive_velocity > Scalar(0);
      const bool has_moved = moved_forward_by_ > Scalar(0) || moved_backward_by_ > Scalar(0);
      return (has_moved ? largest_for_ : waited_) > plan_->stall_samples ||
             (is_abrupt_ && !is_seen && moved_by > Scalar(0) && waited_ > 4 * longest_silence_ + kStill);
    }
    if (still_before_ >= kStill) {
      rest_at_ = way_;
      woken_by_ = last_value_;
    }
    // Elastic slip and gear play are not breakaway.
    const bool is_away = magnitude(way_ - rest_at_) > plan_->box.travel_counts >> kSlipShift;
    if (is_away && (woken_by_ > Scalar(0)) == (last_value_ > Scalar(0)) && Traits::magnitude(woken_by_) > moved_by)
      moved_by = Traits::magnitude(woken_by_);
    if (waited_ > longest_silence_) longest_silence_ = waited_;
    waited_ = largest_for_ = 0;
    return false;
  }

  /// Travel that the tachometer shows but the encoder does not. An eighth of all travel is tolerated, so the
  /// tachometer's scale may be wrong by an eighth.
  template <typename Telemetry>
  constexpr bool is_blind(const Telemetry& seen) {
    const Scalar travel = Traits::from_integer(seen.encoder_travel);
    unseen_ = unseen_ + seen.tachometer_velocity * plan_->box.counts_per_velocity - travel;
    const Scalar forgiven = Traits::magnitude(travel) * Scalar(0.125f);
    if (Traits::magnitude(unseen_) <= forgiven)
      unseen_ = Scalar(0);
    else
      unseen_ = unseen_ > Scalar(0) ? unseen_ - forgiven : unseen_ + forgiven;
    constexpr std::int32_t kMost = 1000;  // a scalar of fixed point holds it
    const std::int32_t part = plan_->box.travel_counts >> kBlindShift;
    return Traits::magnitude(unseen_) > Traits::from_integer(part < kMost ? part : kMost) + Scalar(4);
  }

  constexpr void leave(ExcitationEnd why) {
    end_ = why;
    phase_ = ExcitationPhase::stopping;
    generator_.end();
    is_braking_ = true;
    brake_from_ = magnitude(speed_);
    waited_ = 0;
  }

  /// Whether the axis is so far out, or so fast, that it must reverse now. `is_turning()`: the present input already
  /// slows it down, but the next might not.
  template <typename IsTurning>
  constexpr bool must_turn(IsTurning is_turning) {
    const std::int32_t speed = magnitude(speed_);
    if (!may_turn_) {
      // The reversal still slows it down, until it moves the other way or gains speed again.
      if (speed < slowest_) slowest_ = speed;
      may_turn_ = is_forward_ != turned_forward_ || speed > slowest_ + slowest_ / 4 + kSpeedSamples;
      if (!may_turn_) return false;
    }
    if (!(is_far_out() || is_nearly_too_fast(speed)) || is_turning()) return false;
    may_turn_ = false;
    turned_forward_ = is_forward_;
    slowest_ = speed;
    return true;
  }

  constexpr bool is_far_out() const {
    if (way_ > 0 ? speed_ <= 0 : speed_ >= 0) return false;
    const std::int32_t taken = magnitude(way_ - turned_at_);
    const std::int32_t needed = plan_->box.margin_counts != 0 ? plan_->box.margin_counts : taken + taken / 2;
    return magnitude(way_) + needed > room_;
  }
  constexpr bool is_nearly_too_fast(std::int32_t speed) const {
    const std::int32_t ahead = magnitude(2 * speed_ - speed_before_);  // in kSpeedSamples from now
    return ahead > nearly_too_fast_ && ahead >= speed;
  }

  constexpr bool is_against_motion(Scalar command) const {
    if (sum_of_effects_ == 0 || command == Scalar(0)) return false;
    return ((command > Scalar(0)) == (sum_of_effects_ > 0)) != (speed_ > 0);
  }

  template <typename Axis>
  constexpr void drive_open(Axis& axis) {
    Scalar value{};
    if (phase_ == ExcitationPhase::running)
      value = within(generator_.next(must_turn([this] { return is_against_motion(last_value_); })), plan_->box.volts);
    else
      value = brake();
    axis.excite(value);
    last_value_ = value;
  }

  constexpr Scalar brake() {
    const std::int32_t speed = magnitude(speed_);
    const bool has_turned = (speed_ > 0) != brakes_forward_ && waited_ > 0;
    if (waited_++ == 0) brakes_forward_ = speed_ > 0;
    if (speed <= 1 || has_turned || speed > brake_from_ + brake_from_ / 4 + kSpeedSamples || sum_of_effects_ == 0)
      is_braking_ = false;
    if (!is_braking_) return Scalar(0);
    const Scalar most = within(plan_->amplitude, plan_->box.volts);
    return (speed_ > 0) == (sum_of_effects_ > 0) ? Scalar(0) - most : most;
  }

  template <typename Axis>
  constexpr void drive_closed(Axis& axis) {
    if (plan_->input == ExcitationInput::jog) {
      follow(axis, phase_ == ExcitationPhase::running ? generator_.next(must_turn([this] { return jogs_back(ride_); }))
                                                      : Scalar(0));
      return;
    }
    if (last_ride_ != Scalar(0)) {
      // A reversal is decided in one sample and takes effect in the next.
      const Scalar wanted = phase_ == ExcitationPhase::running ? last_ride_ : Scalar(0);
      if (wanted != ride_)
        follow(axis, wanted);
      else if (must_turn([this] { return jogs_back(last_ride_); }))
        last_ride_ = Scalar(0) - last_ride_;
    }
    const Scalar value = generator_.next(false);
    if (plan_->input == ExcitationInput::output) {
      axis.excite(within(value, plan_->box.volts));
      return;
    }
    const Increment reference = Traits::to_increment(value);
    axis.lead(reference - last_reference_);
    last_reference_ = reference;
  }

  constexpr bool jogs_back(Scalar velocity) const {
    return velocity != Scalar(0) && (velocity > Scalar(0)) != (speed_ > 0);
  }

  /// A jog receives only changes.
  template <typename Axis>
  constexpr void follow(Axis& axis, Scalar velocity) {
    if (velocity == ride_) return;
    ride_ = velocity;
    axis.jog(velocity);
  }

  template <typename Axis>
  constexpr bool has_ended(Axis& axis) {
    if (plan_->input != ExcitationInput::open_loop)
      return !outputs_are_on(axis.state()) || (generator_.is_gone() && axis.is_at_rest() && ride_ == Scalar(0));
    if (!is_braking_ && still_samples_ >= kStill) axis.disable();
    return !outputs_are_on(axis.state());
  }

  static constexpr std::int32_t magnitude(std::int32_t value) { return value < 0 ? -value : value; }
  static constexpr std::int32_t larger(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
  static constexpr Scalar within(Scalar value, Scalar limit) {
    if (value > limit) return limit;
    return value < Scalar(0) - limit ? Scalar(0) - limit : value;
  }

  const ExcitationPlan<Scalar>* plan_ = nullptr;
  ExcitationGenerator<Scalar> generator_;
  ExcitationPhase phase_ = ExcitationPhase::idle;
  ExcitationEnd end_ = ExcitationEnd::none;
  std::uint32_t elapsed_ = 0;                           ///< samples of the excitation
  std::uint32_t waited_ = 0;                            ///< samples: for the enable, for a first count, of braking
  std::uint32_t longest_silence_ = 0;                   ///< under a large command, samples
  std::uint32_t largest_for_ = 0;                       ///< samples of a standstill under a command near the largest
  std::int32_t largest_change_ = 0;                     ///< of speed_ in a sample
  std::int32_t still_samples_ = 0, still_before_ = 0;   ///< with at most a flicker: now, and a sample ago
  std::int32_t still_at_ = 0;                           ///< position of that standstill
  std::int32_t rest_at_ = 0;                            ///< where a longer standstill ended
  Scalar woken_by_{};                                   ///< the command that ended it
  Scalar moved_forward_by_{}, moved_backward_by_{};     ///< largest command that has ended a standstill
  std::int64_t start_ = 0;                              ///< counts
  std::int32_t turned_at_ = 0;                          ///< position of the last reversal
  std::int32_t way_ = 0;                                ///< from the start
  std::int32_t too_fast_ = 0, nearly_too_fast_ = 0;     ///< counts in kSpeedSamples
  std::int32_t room_ = 0;                               ///< range that a train or a ride may use
  std::array<std::int32_t, 2 * kSpeedSamples> seen_{};  ///< the last positions, from the start
  std::size_t place_ = 0;
  std::int32_t speed_ = 0, speed_before_ = 0;  ///< counts in kSpeedSamples: the last, and those before
  std::int32_t farthest_ = 0, fastest_ = 0;
  std::int64_t sum_of_effects_ = 0;
  std::int32_t slowest_ = 0;     ///< since the reversal was requested
  std::int32_t brake_from_ = 0;  ///< speed at which braking began
  Scalar last_value_{}, ride_{}, last_ride_{};
  std::array<Scalar, 2> earlier_value_{};
  Scalar unseen_{};  ///< counts
  Increment last_reference_ = 0;
  bool is_abrupt_ = false, was_forward_ = false;  ///< how the standstill began; direction of the command during it
  bool is_asked_ = false, is_requested_ = false, is_braking_ = false, brakes_forward_ = true;
  bool is_forward_ = true, turned_forward_ = true, may_turn_ = true;
};

}  // namespace firmware
