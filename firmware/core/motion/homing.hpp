// Homing: finds the origin of positions by a switch, an index pulse, or both.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/axis_fault.hpp"

namespace firmware {

enum class HomingMode : std::uint8_t {
  none = 0,              ///< no search: an operator states the position
  home_switch = 1,       ///< the position at which the switch is actuated
  index = 2,             ///< the next index pulse of the encoder
  switch_and_index = 3,  ///< the first index pulse after the switch is actuated
};

/// Velocities in mm/s (m/s), distances in encoder counts.
template <typename Scalar>
struct HomingParameters {
  HomingMode mode = HomingMode::none;
  Scalar velocity{};              ///< of the search; its sign is the direction of the switch; not 0
  Scalar creep_velocity{};        ///< at which edge and index are measured, > 0
  std::int64_t travel = 0;        ///< longest distance of each search, > 0
  std::int64_t index_travel = 0;  ///< distance within which an index pulse comes: a little more than a turn, > 0
  std::int64_t position = 0;      ///< position of the place that is found
  std::int64_t turn = 0;          ///< from one index pulse to the next; 0: not known, at most index_travel
};

/// Inputs of one control period.
struct HomingInputs {
  std::int64_t counts = 0;
  bool at_switch = false;
  bool at_rest = false;     ///< the reference stands
  bool index_seen = false;  ///< since the last control period
  std::int64_t index_counts = 0;
};

enum class HomingStep : std::uint8_t { wait, jog, stop, arrived, failed };

template <typename Scalar>
struct HomingAction {
  HomingStep step = HomingStep::wait;
  Scalar velocity{};                  ///< of jog
  std::int64_t found = 0;             ///< arrived: the counts of the place, in the old origin
  AxisFault fault = AxisFault::none;  ///< failed
};

/// An index pulse must be farther than this part of a turn, 2^-n, from the switch, so that a switch that acts a little
/// earlier or later does not select another pulse.
inline constexpr int kIndexMarginShift = 3;

/// Moves onto the switch at search speed, off it again, and onto it once more at creep speed; then waits for an index
/// in the same direction, so that backlash and hysteresis are always on the same side. An axis that begins on its
/// switch leaves it first. Every distance is limited: the sequence ends with a position or with a fault.
template <typename Scalar>
class HomingSequence {
 public:
  constexpr void configure(const HomingParameters<Scalar>& parameters) {
    parameters_ = parameters;
    phase_ = Phase::idle;
  }

  /// Begins from rest. False if the mode has no search.
  constexpr bool begin() {
    if (parameters_.mode == HomingMode::none) return false;
    phase_ = Phase::beginning;
    return true;
  }
  constexpr void abandon() { phase_ = Phase::idle; }
  constexpr bool is_active() const { return phase_ != Phase::idle; }
  constexpr const HomingParameters<Scalar>& parameters() const { return parameters_; }
  /// Counts from the switch's edge to the next index pulse, as a magnitude; of the last search by both.
  constexpr std::int64_t index_way() const { return index_way_; }

  /// Call it once per control period while active.
  constexpr HomingAction<Scalar> next(const HomingInputs& seen) {
    switch (phase_) {
      case Phase::idle:
        return {};
      case Phase::beginning:
        return enter(parameters_.mode == HomingMode::index ? Phase::awaiting_index
                     : seen.at_switch                      ? Phase::leaving
                                                           : Phase::searching,
                     seen);
      case Phase::leaving:
        return seen.at_switch ? go_on(seen, parameters_.travel, AxisFault::homing_travel_exceeded)
                              : stop_before(Phase::searching);
      case Phase::searching:
        return !seen.at_switch ? go_on(seen, parameters_.travel, AxisFault::homing_switch_not_found)
                               : stop_before(Phase::backing_off);
      case Phase::backing_off:
        return seen.at_switch ? go_on(seen, parameters_.travel, AxisFault::homing_travel_exceeded)
                              : stop_before(Phase::creeping);
      case Phase::creeping:
        if (!seen.at_switch) return go_on(seen, parameters_.travel, AxisFault::homing_switch_not_found);
        if (parameters_.mode == HomingMode::switch_and_index) return enter(Phase::awaiting_index, seen);
        return stop_at(seen.counts);
      case Phase::awaiting_index:
        return seen.index_seen ? take_index(seen.index_counts)
                               : go_on(seen, parameters_.index_travel, AxisFault::homing_index_not_found);
      case Phase::stopping:
        break;
    }
    if (!seen.at_rest) return {};
    if (next_ != Phase::idle) return enter(next_, seen);
    phase_ = Phase::idle;
    return {.step = HomingStep::arrived, .found = found_};
  }

 private:
  enum class Phase : std::uint8_t {
    idle,
    beginning,
    leaving,
    searching,
    backing_off,
    creeping,
    awaiting_index,
    stopping,  ///< until the reference stands, then next_; idle: arrived
  };

  constexpr HomingAction<Scalar> enter(Phase phase, const HomingInputs& seen) {
    phase_ = phase;
    begin_ = seen.counts;
    const Scalar fast = parameters_.velocity;
    const Scalar creep = fast < Scalar(0) ? Scalar(0) - parameters_.creep_velocity : parameters_.creep_velocity;
    const bool goes_back = phase == Phase::leaving || phase == Phase::backing_off;
    const Scalar ahead = phase == Phase::searching ? fast : creep;
    return {.step = HomingStep::jog, .velocity = goes_back ? Scalar(0) - fast : ahead};
  }

  constexpr HomingAction<Scalar> go_on(const HomingInputs& seen, std::int64_t longest, AxisFault otherwise) {
    const std::int64_t way = seen.counts - begin_;
    if (way <= longest && way >= -longest) return {};
    phase_ = Phase::idle;
    return {.step = HomingStep::failed, .fault = otherwise};
  }

  constexpr HomingAction<Scalar> take_index(std::int64_t found) {
    if (parameters_.mode != HomingMode::switch_and_index) return stop_at(found);
    index_way_ = found > begin_ ? found - begin_ : begin_ - found;
    const std::int64_t turn = parameters_.turn > 0 ? parameters_.turn : parameters_.index_travel;
    const std::int64_t margin = turn >> kIndexMarginShift;
    if (index_way_ >= margin && index_way_ <= turn - margin) return stop_at(found);
    phase_ = Phase::idle;
    return {.step = HomingStep::failed, .fault = AxisFault::homing_index_near_switch};
  }

  constexpr HomingAction<Scalar> stop_before(Phase next) {
    phase_ = Phase::stopping;
    next_ = next;
    return {.step = HomingStep::stop};
  }

  constexpr HomingAction<Scalar> stop_at(std::int64_t found) {
    found_ = found;
    return stop_before(Phase::idle);
  }

  HomingParameters<Scalar> parameters_{};
  Phase phase_ = Phase::idle;
  Phase next_ = Phase::idle;
  std::int64_t begin_ = 0;
  std::int64_t found_ = 0;
  std::int64_t index_way_ = 0;
};

}  // namespace firmware
