// One fault, injected at one sample of one motion: what the supervisor made of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/hil/injection.hpp"

namespace host {

/// What the machine is doing when it happens.
enum class TrialMotion { self_test, ready, standing, jog, move, circle, stopping };
inline constexpr std::array<std::string_view, 7> kTrialMotions{"self-test", "ready",  "standing", "jog",
                                                               "move",      "circle", "stopping"};

struct FaultTrial {
  const InjectionInfo* injection = nullptr;
  std::size_t axis = 0;
  double value = 0.0;
  TrialMotion motion = TrialMotion::jog;
  int sample = 300;           ///< of the injection, since the motion began
  double speed_mm_s = 100.0;  ///< of jogs, with its sign
  std::uint64_t seed = 1;

  std::string text() const;
};

struct TrialOutcome {
  firmware::AxisFault fault = firmware::AxisFault::none;  ///< of the axis (any axis, for a fault of the board)
  double reaction_s = 0.0;                                ///< from the injection to the fault
  double stop_s = 0.0;                                    ///< from the fault until both axes stand, outputs off
  double distance_mm = 0.0;                               ///< the longest way of an axis since the fault
  bool is_named = false;                                  ///< the fault is one of those that name the cause
  bool is_safe = false;                                   ///< both axes stand, D/A at 0 V, enables dropped
};

/// The paper's axes with parameters designed from Table 1. What does not show while the axes stand is given a motion:
/// they are enabled, and jog both ways.
TrialOutcome run_trial(const FaultTrial& trial);

/// What the paper's axes promise: the way and the time of coasting from the overspeed limit, 300 mm/s, against friction
/// alone, which is longer than a ramp, with a converter stuck at full voltage until it is found.
inline constexpr double kStatedStop_s = 0.8;
inline constexpr double kStatedDistance_mm = 100.0;

/// Every injection at its usual value in every motion; the documentation's table.
std::string fault_page();

}  // namespace host
