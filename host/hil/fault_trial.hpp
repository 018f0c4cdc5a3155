// Injects one or two faults at given samples of a motion and checks the supervisor's reaction.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/hil/injection.hpp"

namespace host {

/// The motion during the injection.
enum class TrialMotion { self_test, ready, starting, standing, jog, move, circle, stopping };
inline constexpr std::array<std::string_view, 8> kTrialMotions{"self-test", "ready", "starting", "standing",
                                                               "jog",       "move",  "circle",   "stopping"};

/// Waiting times of an axis between its enable and motion, and at its end.
struct TrialStart {
  int ready_ms = 0;  ///< amplifier.ready_time; the amplifier drives at once and reports ready after half of that time
  bool ready_input = false;  ///< the ready contact is wired
  bool brake = false;        ///< a brake is fitted
};
inline constexpr int kTrialBrake_ms = 50;  ///< time to release and to apply

struct TrialInjection {
  const InjectionInfo* injection = nullptr;
  std::size_t axis = 0;
  double value = 0.0;
};

struct FaultTrial {
  TrialInjection first;
  TrialInjection second;  ///< optional second fault
  int delay = 0;          ///< samples from the first to the second
  TrialMotion motion = TrialMotion::jog;
  int sample = 300;           ///< sample of the injection from the start of the motion (starting: from the enable)
  int since_disable = 0;      ///< stopping: samples from the disable to the injection
  double speed_mm_s = 100.0;  ///< signed speed of jogs
  bool tachometer = true;     ///< both axes have one
  bool encoder_fault_input = false;    ///< the fault outputs of the encoders' receivers are wired
  double acceleration_mm_s2 = 2000.0;  ///< limit of the references
  TrialStart start{};
  double weight_Nm = 0.0;  ///< load that pulls on both motors; if not 0, a brake is fitted
  bool light = false;      ///< a tenth of the friction of the paper's axes: J 0.010 kg m^2, Coulomb 0.2 Nm
  std::uint64_t seed = 1;

  std::string text() const;
};

struct TrialOutcome {
  firmware::AxisFault fault = firmware::AxisFault::none;  ///< first fault that was found on any axis
  double reaction_s = 0.0;                                ///< from the first injection to the fault
  double stop_s = 0.0;        ///< from the fault until both axes are at rest with outputs off
  double distance_mm = 0.0;   ///< longest travel of an axis since the fault
  double whole_way_mm = 0.0;  ///< the same, since the first injection
  /// Largest travel beyond the formula (broken_ramp_way), which uses the speed and acceleration when the fault was
  /// found, the highest speed after that, and the speed when the amplifier stopped driving.
  double beyond_mm = 0.0;
  double beyond_s = 0.0;
  double gain_s = 0.0;        ///< time in which the full command would accelerate an axis to its highest speed
  double speed_mm_s = 0.0;    ///< speed of the faster axis when the fault was found
  double driven_off_s = 0.0;  ///< time for which an amplifier drove without its enable until its power was cut
  /// The fault identifies the cause: the first injection, or the second if it came before the first was found.
  bool is_named = false;
  bool is_safe = false;  ///< both axes are at rest, D/A at 0 V, enables dropped
  /// Every axis that was enabled, or had the fault itself, is in the state fault.
  bool is_latched = false;
};

/// Runs the trial on the paper's axes, or on light ones, with parameters designed from their models. If a fault is not
/// found at rest, the axes are enabled and jog in both directions.
TrialOutcome run_trial(const FaultTrial& trial);

/// Largest travel beyond the formula in any trial: until a monitor finds that an axis does not follow its ramp, and
/// until it is found to be at rest.
inline constexpr double kStatedExtra_mm = 20.0;
inline constexpr double kStatedExtra_s = 0.4;
/// Time for which a tachometer with interchanged leads can hide the full command: the filter over the difference of the
/// sensors (16 samples), and the time until they differ by monitor.disagreement (10 rad/s, growing by 1.6 rad/s each
/// sample).
inline constexpr double kStatedGain_s = 0.022;
/// Longest time until the power of an amplifier that drives without its enable is cut (DropWatch::kTime_s), beyond the
/// time until it reports so.
inline constexpr double kStatedCut_s = 0.11;

/// The table of the documentation: every injection at its usual value in every motion.
std::string fault_page();

}  // namespace host
