// Point-to-point moves: a jog to one velocity and, after a planned time, back to rest.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/core/motion/jog_steps.hpp"

namespace firmware {

/// A jog slows down by the mirror image of its speeding up, so a distance D is `velocity` times `samples`, if it
/// reaches that velocity before. The remainder of this quotient is spread as one unit over so many samples: the
/// increments add up to D exactly.
struct MovePlan {
  std::int32_t samples = 0;    ///< from the start of speeding up to the start of slowing down; up to 2^29
  std::int32_t remainder = 0;  ///< so many samples take one unit more; or less, if negative
  Increment velocity = 0;
};

struct MovePlanResult {
  MovePlan plan{};
  Refusal refusal = Refusal::none;
};

namespace move_planning {

inline constexpr std::int64_t kLongest = std::int64_t{1} << 29;  ///< MovePlan::samples

struct Division {
  Increment quotient;
  std::int64_t remainder;
};

/// distance / divisor for 0 <= distance and 0 < divisor < 2^31, in steps that fit 64 bits. A quotient beyond the
/// velocity range is returned as kMostMotion + 1.
constexpr Division divide(const CountPosition& distance, std::int64_t divisor) {
  const std::int64_t whole = distance.counts / divisor;
  std::int64_t remainder = distance.counts % divisor;
  if (whole >= kMostMotion >> kFractionBits) return {kMostMotion + 1, 0};
  constexpr int kDigitBits = kFractionBits / 2;
  constexpr std::int64_t kDigitMask = (std::int64_t{1} << kDigitBits) - 1;
  remainder = (remainder << kDigitBits) | (distance.fraction >> kDigitBits);
  const std::int64_t high = remainder / divisor;
  remainder = ((remainder % divisor) << kDigitBits) | (distance.fraction & kDigitMask);
  return {(whole << kFractionBits) | (high << kDigitBits) | (remainder / divisor), remainder % divisor};
}

constexpr bool is_admissible(const CountPosition& distance, std::int64_t samples, const MotionLimits& limits) {
  const Division velocity = divide(distance, samples);
  return velocity.quotient < limits.velocity && JogSteps(limits).ramp_samples(velocity.quotient) <= samples;
}

}  // namespace move_planning

/// Counts: the longest move at the highest velocity that limits may have. Longer moves cannot be planned, and the
/// arithmetic of a plan has room for twice as much.
inline constexpr std::int64_t kFarthestMove = move_planning::kLongest * (kMostMotion >> kFractionBits);

inline constexpr std::int32_t kWholeVelocity = 1 << 16;  ///< shares of the velocity limit are parts of it

/// The shortest plan, to within a few samples. `limits` have passed check(). Pure and bounded (some 60 trial
/// durations), but it divides: run it outside the control interrupt.
constexpr MovePlanResult plan_move(CountPosition distance, const MotionLimits& limits) {
  using move_planning::Division;
  using move_planning::is_admissible;
  using move_planning::kLongest;
  MovePlan plan;
  // Checked before the sign changes, because -2^63 has no negative.
  if (distance.counts >= kFarthestMove || distance.counts < -kFarthestMove) return {plan, Refusal::move_too_long};
  const bool negative = distance.counts < 0;
  if (negative) distance = CountPosition{} - distance;
  if (distance == CountPosition{}) return {plan, Refusal::none};

  std::int64_t admissible = 2;
  while (!is_admissible(distance, admissible, limits)) {
    admissible *= 2;
    if (admissible > kLongest) return {plan, Refusal::move_too_long};
  }
  // A longer time means a slower move with a shorter ramp, so admissibility is monotone and the shortest is found by
  // halving.
  std::int64_t too_short = admissible / 2;
  while (admissible - too_short > 1) {
    const std::int64_t middle = too_short + (admissible - too_short) / 2;
    (is_admissible(distance, middle, limits) ? admissible : too_short) = middle;
  }

  const Division velocity = move_planning::divide(distance, admissible);
  plan.samples = static_cast<std::int32_t>(admissible);
  plan.remainder = static_cast<std::int32_t>(negative ? -velocity.remainder : velocity.remainder);
  plan.velocity = negative ? -velocity.quotient : velocity.quotient;
  return {plan, Refusal::none};
}

}  // namespace firmware
