// Point-to-point moves: durations and step sizes, in whole samples and whole units.
#pragma once

#include <cstdint>

#include "firmware/core/motion/motion_limits.hpp"

namespace firmware {

/// A distance D as D times the convolution of three box filters of N1 >= N2 + N3 samples, N2 >= N3: velocity is D/N1 at
/// most, acceleration D/(N1 N2), jerk D/(N1 N2 N3). Each quotient is rounded down and its remainder r is spread as one
/// unit over r samples, so the increments add up to D exactly.
struct MovePlan {
  std::int32_t N1 = 0;  ///< samples from the start of speeding up to the start of slowing down
  std::int32_t N2 = 0;  ///< samples from the start of the first jerk to the start of the second
  std::int32_t N3 = 0;  ///< samples of one jerk
  Increment jerk = 0;
  std::int32_t jerk_remainder = 0;          ///< samples of a jerk that take one unit more
  std::int32_t acceleration_remainder = 0;  ///< samples of an acceleration that take one unit more
  std::int32_t velocity_remainder = 0;      ///< samples of the move that take one unit more
  bool negative = false;

  /// Below 2^30: N2 + N3 <= N1 <= 2^29.
  constexpr std::int32_t samples() const { return N1 == 0 ? 0 : N1 + N2 + N3 - 1; }
};

struct MovePlanResult {
  MovePlan plan{};
  Refusal refusal = Refusal::none;
};

namespace move_planning {

inline constexpr std::int64_t kLongest = std::int64_t{1} << 29;  ///< N1, samples

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

constexpr std::int64_t divide_up(std::int64_t value, std::int64_t divisor) {
  return value / divisor + (value % divisor != 0 ? 1 : 0);
}

/// Smallest n with n * n >= value, 0 <= value < 2^62. 31 rounds.
constexpr std::int64_t square_root_up(std::int64_t value) {
  std::int64_t root = 0;
  for (int bit = 30; bit >= 0; --bit) {
    const std::int64_t candidate = root | (std::int64_t{1} << bit);
    if (candidate * candidate <= value) root = candidate;
  }
  return root * root < value ? root + 1 : root;
}

struct Ramp {
  std::int64_t N2;
  std::int64_t N3;
};

/// The shortest ramp to `velocity` > 0: jerk-limited (N2 = N3), or with a stretch at full acceleration.
constexpr Ramp ramp_to(Increment velocity, const MotionLimits& limits) {
  const std::int64_t by_jerk = square_root_up(divide_up(velocity, limits.jerk));
  const std::int64_t by_acceleration = divide_up(velocity, limits.acceleration);
  if (by_jerk >= by_acceleration) return {by_jerk, by_jerk};
  return {by_acceleration, divide_up(divide_up(velocity, by_acceleration), limits.jerk)};
}

constexpr bool is_admissible(const CountPosition& distance, std::int64_t N1, const MotionLimits& limits) {
  const Division velocity = divide(distance, N1);
  const Increment most = velocity.quotient + (velocity.remainder != 0 ? 1 : 0);
  if (most > limits.velocity) return false;
  const Ramp ramp = ramp_to(most, limits);
  return ramp.N2 + ramp.N3 <= N1;
}

}  // namespace move_planning

/// Counts: the longest move at the highest velocity that limits may have. Longer moves cannot be planned, and the
/// arithmetic of a plan has room for twice as much.
inline constexpr std::int64_t kFarthestMove = move_planning::kLongest * (kMostMotion >> kFractionBits);

inline constexpr std::int32_t kWholeVelocity = 1 << 16;  ///< shares of the velocity limit are parts of it

/// The shortest plan, to within the rounding of its durations up to whole samples. `limits` have passed check(). Pure
/// and bounded (some 60 trial durations), but it divides: run it outside the control interrupt.
constexpr MovePlanResult plan_move(CountPosition distance, const MotionLimits& limits) {
  using move_planning::Division;
  using move_planning::is_admissible;
  using move_planning::kLongest;
  using move_planning::Ramp;
  MovePlan plan;
  // Checked before the sign changes, because -2^63 has no negative.
  if (distance.counts >= kFarthestMove || distance.counts < -kFarthestMove) return {plan, Refusal::move_too_long};
  plan.negative = distance.counts < 0;
  if (plan.negative) distance = CountPosition{} - distance;
  if (distance == CountPosition{}) return {plan, Refusal::none};

  // Spreading remainders adds at most one unit of velocity, two of acceleration and four of jerk.
  const MotionLimits reduced{
      .velocity = limits.velocity - 1, .acceleration = limits.acceleration - 2, .jerk = limits.jerk - 4};
  std::int64_t admissible = 2;
  while (!is_admissible(distance, admissible, reduced)) {
    admissible *= 2;
    if (admissible > kLongest) return {plan, Refusal::move_too_long};
  }
  // A longer N1 means a slower move with a shorter ramp, so admissibility is monotone and the shortest is found by
  // halving.
  std::int64_t too_short = admissible / 2;
  while (admissible - too_short > 1) {
    const std::int64_t middle = too_short + (admissible - too_short) / 2;
    (is_admissible(distance, middle, reduced) ? admissible : too_short) = middle;
  }

  const Division velocity = move_planning::divide(distance, admissible);
  const Ramp ramp = move_planning::ramp_to(velocity.quotient + (velocity.remainder != 0 ? 1 : 0), reduced);
  const Increment acceleration = velocity.quotient / ramp.N2;
  plan.N1 = static_cast<std::int32_t>(admissible);
  plan.N2 = static_cast<std::int32_t>(ramp.N2);
  plan.N3 = static_cast<std::int32_t>(ramp.N3);
  plan.jerk = acceleration / ramp.N3;
  plan.jerk_remainder = static_cast<std::int32_t>(acceleration % ramp.N3);
  plan.acceleration_remainder = static_cast<std::int32_t>(velocity.quotient % ramp.N2);
  plan.velocity_remainder = static_cast<std::int32_t>(velocity.remainder);
  return {plan, Refusal::none};
}

}  // namespace firmware
