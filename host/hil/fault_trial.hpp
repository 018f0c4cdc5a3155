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

struct TrialInjection {
  const InjectionInfo* injection = nullptr;
  std::size_t axis = 0;
  double value = 0.0;
};

struct FaultTrial {
  TrialInjection first;
  TrialInjection second;  ///< without an injection: one fault alone
  int delay = 0;          ///< samples from the first to the second
  TrialMotion motion = TrialMotion::jog;
  int sample = 300;                    ///< of the injection, since the motion began
  double speed_mm_s = 100.0;           ///< of jogs, with its sign
  bool tachometer = true;              ///< both axes have one
  double acceleration_mm_s2 = 2000.0;  ///< the references' limit
  std::uint64_t seed = 1;

  std::string text() const;
};

struct TrialOutcome {
  firmware::AxisFault fault = firmware::AxisFault::none;  ///< the first that was found on any axis
  double reaction_s = 0.0;                                ///< from the first injection to the fault
  double stop_s = 0.0;                                    ///< from the fault until both axes stand, outputs off
  double distance_mm = 0.0;                               ///< the longest way of an axis since the fault
  double whole_way_mm = 0.0;                              ///< likewise, since the first injection
  double speed_mm_s = 0.0;                                ///< of the faster axis when the fault was found
  /// The fault is one of those that name the cause: the first injection, or the second where that came before the
  /// first had been found.
  bool is_named = false;
  bool is_safe = false;  ///< both axes stand, D/A at 0 V, enables dropped
  /// Every axis that was enabled, or had the fault itself, has ended in the state fault.
  bool is_latched = false;
};

/// The paper's axes with parameters designed from Table 1. What does not show while the axes stand is given a motion:
/// they are enabled, and jog both ways.
TrialOutcome run_trial(const FaultTrial& trial);

/// What the paper's axes promise, by their speed when the fault is found: the way and the time of a ramp within the
/// references' limits, and what coasting against friction alone, or finding a second fault meanwhile, may add.
struct StatedStop {
  double distance_mm;
  double time_s;
};
StatedStop stated_stop(double speed_mm_s, double acceleration_mm_s2);
inline constexpr double kStatedExtra_mm = 30.0;
inline constexpr double kStatedExtra_s = 0.4;

/// Every injection at its usual value in every motion; the documentation's table.
std::string fault_page();

}  // namespace host
