// The states of an axis and what leads from one to the next, as a table and a pure function.
#pragma once

#include <array>
#include <cstdint>

namespace firmware {

enum class SupervisorState : std::uint8_t {
  off = 0,        ///< no parameters
  self_test = 1,  ///< outputs off; the inputs are watched for a while
  ready = 2,      ///< outputs off; may be enabled
  enabled = 3,    ///< the loop is closed
  stopping = 4,   ///< the loop is closed; the reference slows down to standstill, then the enable drops
  fault = 5,      ///< outputs off, until the fault is cleared
  starting = 6,   ///< the amplifier has its enable; it becomes ready, the loop closes, the brake is released
};

inline constexpr std::array<const char*, 7> kStateNames{"off",      "self-test", "ready",   "enabled",
                                                        "stopping", "fault",     "starting"};

// cppcheck-suppress CastIntegerToAddressAtReturn
constexpr const char* state_name(SupervisorState state) { return kStateNames[static_cast<std::size_t>(state)]; }

/// The amplifier has its enable, and the D/A converter may be off 0 V, in these states only.
constexpr bool outputs_are_on(SupervisorState state) {
  return state == SupervisorState::enabled || state == SupervisorState::stopping || state == SupervisorState::starting;
}

/// What happened in a control period; several at once make a set.
enum class SupervisorEvent : std::uint16_t {
  configured = 1 << 0,   ///< parameters were accepted
  test_passed = 1 << 1,  ///< the self-test saw no fault until its end
  enable_request = 1 << 2,
  disable_request = 1 << 3,  ///< an orderly stop
  clear_request = 1 << 4,
  ramp_fault = 1 << 5,  ///< a fault whose reaction is ramp_stop
  drop_fault = 1 << 6,  ///< a fault whose reaction is drop_enable
  standing = 1 << 7,    ///< the stop has ended, and the brake holds
  started = 1 << 8,     ///< the amplifier drives, the brake is released
};

using SupervisorEvents = std::uint16_t;

constexpr SupervisorEvents operator|(SupervisorEvent a, SupervisorEvent b) {
  return static_cast<SupervisorEvents>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr SupervisorEvents operator|(SupervisorEvents events, SupervisorEvent one) {
  return static_cast<SupervisorEvents>(events | static_cast<unsigned>(one));
}
constexpr bool contains(SupervisorEvents events, SupervisorEvent one) {
  return (events & static_cast<unsigned>(one)) != 0;
}

struct SupervisorTransition {
  SupervisorState from;
  SupervisorEvent event;
  SupervisorState to;
};

/// The first row that fits decides: faults before wishes.
inline constexpr std::array<SupervisorTransition, 19> kTransitions{{
    {SupervisorState::off, SupervisorEvent::configured, SupervisorState::self_test},
    {SupervisorState::self_test, SupervisorEvent::drop_fault, SupervisorState::fault},
    {SupervisorState::self_test, SupervisorEvent::ramp_fault, SupervisorState::fault},
    {SupervisorState::self_test, SupervisorEvent::configured, SupervisorState::self_test},
    {SupervisorState::self_test, SupervisorEvent::test_passed, SupervisorState::ready},
    {SupervisorState::ready, SupervisorEvent::drop_fault, SupervisorState::fault},
    {SupervisorState::ready, SupervisorEvent::ramp_fault, SupervisorState::fault},
    {SupervisorState::ready, SupervisorEvent::configured, SupervisorState::self_test},
    {SupervisorState::ready, SupervisorEvent::enable_request, SupervisorState::starting},
    {SupervisorState::starting, SupervisorEvent::drop_fault, SupervisorState::fault},
    {SupervisorState::starting, SupervisorEvent::ramp_fault, SupervisorState::stopping},
    {SupervisorState::starting, SupervisorEvent::disable_request, SupervisorState::stopping},
    {SupervisorState::starting, SupervisorEvent::started, SupervisorState::enabled},  // at once, if nothing is awaited
    {SupervisorState::enabled, SupervisorEvent::drop_fault, SupervisorState::fault},
    {SupervisorState::enabled, SupervisorEvent::ramp_fault, SupervisorState::stopping},
    {SupervisorState::enabled, SupervisorEvent::disable_request, SupervisorState::stopping},
    {SupervisorState::stopping, SupervisorEvent::drop_fault, SupervisorState::fault},
    {SupervisorState::stopping, SupervisorEvent::standing, SupervisorState::ready},  // or fault: see below
    {SupervisorState::fault, SupervisorEvent::clear_request, SupervisorState::self_test},
}};

/// `fault_latched`: a stop caused by a fault ends in the state fault.
constexpr SupervisorState next_state(SupervisorState state, SupervisorEvents events, bool fault_latched) {
  for (const SupervisorTransition& row : kTransitions) {
    if (row.from != state || !contains(events, row.event)) continue;
    return row.to == SupervisorState::ready && fault_latched ? SupervisorState::fault : row.to;
  }
  return state;
}

}  // namespace firmware
