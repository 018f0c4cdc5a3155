// Generates the excitation, one value per sample.
#pragma once

#include "firmware/core/excitation/excitation_plan.hpp"
#include "firmware/core/excitation/line_bank.hpp"

namespace firmware {

/// No division and no library call in next(); its loop is bounded by kExcitationEntries. Periodic kinds are exactly
/// periodic: phases are whole numbers, and the lines of a multisine restart with each of its periods.
template <typename Scalar>
class ExcitationGenerator {
 public:
  /// `plan` is possible and must outlive its use. Divides: for the background.
  constexpr void start(const ExcitationPlan<Scalar>& plan) {
    plan_ = &plan;
    level_ = 0;
    left_ = plan.kind == ExcitationKind::train ? plan.entry[0].first : plan.period;
    value_ = Scalar(0);
    slope_ = plan.amplitude / ScalarTraits<Scalar>::from_integer(bounded(plan.period));
    fade_step_ = Scalar(1) / ScalarTraits<Scalar>::from_integer(bounded(plan.fade_samples));
    fade_ = Scalar(0);
    is_fading_ = false;
    if (plan.kind == ExcitationKind::multisine) lines_.prepare(plan.entry.data(), plan.count);
    phase_ = 0;
    step_ = std::uint64_t{plan.step} << 32;
    const std::int64_t sweep = std::int64_t{plan.last_step} - std::int64_t{plan.step};
    // No overflow: for frequencies below a quarter turn a sample the difference has 31 bits.
    rate_ = (sweep * (std::int64_t{1} << 31) / plan.samples) * 2;
  }

  /// `turn`: the axis is leaving the box, or is near its speed limit.
  constexpr Scalar next(bool turn) {
    switch (plan_->kind) {
      case ExcitationKind::train:
        return next_level(turn);
      case ExcitationKind::ramp:
        return next_of_ramp(turn);
      case ExcitationKind::chirp:
        return faded(next_of_chirp());
      case ExcitationKind::multisine:
        return faded(next_of_lines());
      case ExcitationKind::triangle:
        return faded(next_of_triangle());
    }
    return Scalar(0);
  }

  /// A periodic excitation ends within its fade time; the others end at once.
  constexpr void end() { is_fading_ = true; }
  constexpr bool is_gone() const {
    const bool ends_at_once = plan_->kind == ExcitationKind::train || plan_->kind == ExcitationKind::ramp;
    return is_fading_ && (ends_at_once || fade_ <= Scalar(0));
  }

 private:
  using Traits = ScalarTraits<Scalar>;

  /// Limited to the range of a scalar.
  static constexpr std::int32_t bounded(std::uint32_t samples) {
    constexpr std::uint32_t kMost = std::uint32_t{1} << 24;
    return static_cast<std::int32_t>(samples < kMost ? samples : kMost);
  }

  constexpr Scalar faded(Scalar value) {
    if (is_fading_)
      fade_ = fade_ > fade_step_ ? fade_ - fade_step_ : Scalar(0);
    else if (fade_ < Scalar(1))
      fade_ = fade_ + fade_step_ < Scalar(1) ? fade_ + fade_step_ : Scalar(1);
    return value * fade_;
  }

  constexpr Scalar next_level(bool turn) {
    if (turn || left_ == 0) {
      level_ = level_ + 1 < plan_->count ? level_ + 1 : 0;
      left_ = plan_->entry[level_].first;
    }
    --left_;
    return plan_->entry[level_].value;
  }

  constexpr Scalar next_of_ramp(bool turn) {
    if (turn || left_ == 0) {
      slope_ = Scalar(0) - slope_;
      value_ = Scalar(0);
      left_ = plan_->period;
    }
    --left_;
    value_ = value_ + slope_;
    return value_;
  }

  constexpr Scalar next_of_chirp() {
    const Scalar value = plan_->amplitude * sine_of<Scalar>(static_cast<Turn>(phase_ >> 32));
    phase_ += step_;
    step_ += static_cast<std::uint64_t>(rate_);
    return value;
  }

  constexpr Scalar next_of_lines() {
    const bool is_last = --left_ == 0;
    if (is_last) left_ = plan_->period;
    return lines_.next(is_last);
  }

  constexpr Scalar next_of_triangle() {
    const auto turn = static_cast<Turn>(phase_ >> 32);
    phase_ += step_;
    // From 0 up to 1 at a quarter turn, down to -1 at three quarters.
    const Turn folded = turn > kQuarterTurn && turn < 3 * kQuarterTurn ? 2 * kQuarterTurn - turn : turn;
    const auto quarters = std::int64_t{static_cast<std::int32_t>(folded)} << (kFractionBits - 30);
    return plan_->amplitude * Traits::from_increment(quarters);
  }

  const ExcitationPlan<Scalar>* plan_ = nullptr;
  LineBank<Scalar> lines_;
  std::size_t level_ = 0;
  std::uint32_t left_ = 0;  ///< samples of the level, of the ramp, of the period
  Scalar value_{}, slope_{};
  Scalar fade_{}, fade_step_{};
  bool is_fading_ = false;
  std::uint64_t phase_ = 0, step_ = 0;  ///< 2^-64 turns
  std::int64_t rate_ = 0;               ///< 2^-64 turns a sample^2
};

}  // namespace firmware
