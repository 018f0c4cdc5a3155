// One fault, injected at one sample of one motion: what the supervisor made of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/hil/injection.hpp"

namespace host {

/// What the machine is doing when it happens.
enum class TrialMotion { self_test, ready, starting, standing, jog, move, circle, stopping };
inline constexpr std::array<std::string_view, 8> kTrialMotions{"self-test", "ready", "starting", "standing",
                                                               "jog",       "move",  "circle",   "stopping"};

/// What an axis waits for between its enable and motion, and at its end.
struct TrialStart {
  int ready_ms = 0;          ///< amplifier.ready_time; the amplifier drives at once, and says so after half of it
  bool ready_input = false;  ///< the contact is wired
  bool brake = false;        ///< one is fitted
};
inline constexpr int kTrialBrake_ms = 50;  ///< to release and to apply

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
  int sample = 300;                    ///< of the injection, since the motion began; starting: since the enable
  int since_disable = 0;               ///< stopping: samples from the disable to the injection
  double speed_mm_s = 100.0;           ///< of jogs, with its sign
  bool tachometer = true;              ///< both axes have one
  double acceleration_mm_s2 = 2000.0;  ///< the references' limit
  TrialStart start{};
  double weight_Nm = 0.0;  ///< what pulls on both motors; not 0: a brake is fitted
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
/// references' limits, and what finding a second fault meanwhile, coasting against friction alone after it, and holding
/// an axis until it stands may add.
struct StatedStop {
  double distance_mm;
  double time_s;
};
StatedStop stated_stop(const FaultTrial& trial, double speed_mm_s);
inline constexpr double kStatedExtra_mm = 30.0;
inline constexpr double kStatedExtra_s = 0.5;

/// Every injection at its usual value in every motion; the documentation's table.
std::string fault_page();

}  // namespace host
