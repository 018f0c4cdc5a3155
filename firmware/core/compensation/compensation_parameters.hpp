// What a drive does besides inertia and the friction of eq. (19), as far as feed-forward can take it away.
#pragma once

#include <array>

#include "firmware/core/compensation/backlash_crossing.hpp"
#include "firmware/core/compensation/pitch_correction.hpp"
#include "firmware/core/compensation/presliding_friction.hpp"
#include "firmware/core/compensation/travel_harmonic.hpp"

namespace firmware {

inline constexpr int kCoggingHarmonics = 3;

/// Each part has its own switch, off by default.
template <typename Scalar>
struct CompensationParameters {
  bool cogging_on = false;
  std::array<TravelHarmonic<Scalar>, kCoggingHarmonics> cogging_V{};  ///< effort that cogging adds to the motor's, V
  bool position_friction_on = false;
  TravelHarmonic<Scalar> position_friction{};  ///< what friction grows by along the travel, relative
  PreslidingParameters<Scalar> presliding{};
  BacklashParameters backlash{};
  PitchParameters pitch{};
};

}  // namespace firmware
