#include "host/opening/next_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace host {

namespace {

/// At lower rates, the first resonances and every reversal of a feed drive (5 to 100 ms) are shorter than a few
/// samples.
constexpr double kFewest_Hz = 200.0;

struct Recipe {
  std::string_view layout, text;
};

constexpr Recipe kRecipes[] = {
    {"twincat-scope",
     "TwinCAT Scope: add the axis' ActPos, ActVelo and, from the drive's process data, the torque or current actual "
     "value (link 6077h or its like); sample time: that of the NC task; export as CSV with one time column"},
    {"sinumerik",
     "SINUMERIK Operate, Diagnostics, Trace: actual position of encoder 1 and torque-generating current iq (r0078) of "
     "the axis, "
     "in the position controller's or IPO cycle"},
    {"halsampler",
     "LinuxCNC: loadrt sampler cfg=fff; net the pins joint.N.motor-pos-cmd, joint.N.motor-pos-fb and the PID's output "
     "(or the "
     "drive's torque feedback) to sampler.0.pin.0 to 2; addf sampler.0 servo-thread; halsampler -n 20000 log.txt"},
    {"halscope",
     "LinuxCNC halscope: joint.N.motor-pos-fb, joint.N.motor-pos-cmd and the PID's output, every servo period; File, "
     "Save"},
    {"odrive",
     "ODrive: read axis0.encoder.pos_estimate, vel_estimate and axis0.motor.current_control.Iq_measured with their "
     "time in one "
     "loop, or by the oscilloscope, at 1 kHz"},
    {"moteus", "moteus: log position, velocity and q_current (mode kInt16 or finer) at 500 Hz or more"},
    {"vesc", "VESC Tool: sampled data at a rate of 1 kHz instead of the real-time log"},
    {"ros2-joint-states",
     "ROS 2: publish position, velocity and effort of the joint at 200 Hz or more (joint_state_broadcaster, "
     "update_rate "
     "of the controller manager); ros2 bag record /joint_states"},
    {"camonitor",
     "EPICS: archive the drive's current or torque beside the position, both at 200 Hz or more (a waveform record)"},
};

}  // namespace

std::string next_run(const Understanding& understood) {
  const bool records = std::ranges::any_of(understood.axes, &OpenedAxis::makes_record);
  const bool slow = understood.rate_Hz > 0.0 && understood.rate_Hz < kFewest_Hz;
  if (records && !slow) return {};
  const auto* const found = std::ranges::find(kRecipes, std::string_view(understood.layout), &Recipe::layout);
  const std::string_view how =
      found != std::end(kRecipes)
          ? found->text
          : "Log position or speed and the motor's current, torque or command together, with units in the "
            "headings, at 200 Hz or more";
  return fmt::format(
      "{}{}. Motions: steps in both directions, jogs at several speeds over the travel, a sweep; ten seconds each.",
      slow ? fmt::format("{:.3g} Hz is too slow for reversals and resonances, but sufficient for friction over speed "
                         "and travel. ",
                         understood.rate_Hz)
           : "",
      how);
}

}  // namespace host
