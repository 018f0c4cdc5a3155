// Evaluates a touch probe while axes follow a path.
#pragma once

#include <cstdint>

#include "firmware/core/supervision/input_filter.hpp"
#include "hal/probe.hpp"

namespace firmware {

/// State of its input on contact. Numbers are permanent: values of the parameter probe.input.
enum class ProbeContact : std::uint8_t { none = 0 /* not wired */, closes = 1, opens = 2 };

/// State of the probe that ends a path. Numbers are permanent, because requests contain them.
enum class ProbeStop : std::uint8_t {
  none = 0,  ///< no probing path: a contact during it is unexpected
  contact = 1,
  release = 2,
};

/// The expected state counts once the input has had it for a while. The position is that of the first edge, which the
/// hardware latched. If the input returns to its earlier state for the same time, the edge was a noise spike and is
/// ignored.
class ProbeWatch {
 public:
  /// `samples`: control periods for which the input must have the expected state.
  constexpr void configure(ProbeContact contact, ProbeStop stop, std::int32_t samples) {
    contact_ = contact;
    stop_ = stop;
    found_ = missing_ = {};
    found_.configure(samples);
    missing_.configure(samples);
  }
  constexpr ProbeContact contact() const { return contact_; }
  constexpr bool is_on() const { return contact_ != ProbeContact::none; }
  constexpr bool is_probing() const { return stop_ != ProbeStop::none; }

  /// Call it at the path's start. False if a probing path looks for a state that exists already.
  template <hal::ProbeInput Probe>
  constexpr bool begin(Probe& probe) {
    probe.arm(wants_closed());
    was_missing_ = !is_there(probe);
    return was_missing_ || !is_probing();
  }

  /// Call it once a control period: whether the expected state has been reached. On a path that does not probe, a
  /// contact that existed at its start must have been lost first.
  template <hal::ProbeInput Probe>
  constexpr bool has_come(Probe& probe) {
    const bool there = is_there(probe), stays_away = missing_.filtered(!there);
    was_missing_ = was_missing_ || stays_away;
    if (stays_away && probe.has_latched()) probe.arm(wants_closed());
    return found_.filtered(there) && was_missing_;
  }

  template <hal::ProbeInput Probe>
  constexpr bool is_there(Probe& probe) const {
    return probe.is_closed() == wants_closed();
  }

 private:
  constexpr bool wants_closed() const { return (contact_ == ProbeContact::closes) == (stop_ != ProbeStop::release); }

  ProbeContact contact_ = ProbeContact::none;
  ProbeStop stop_ = ProbeStop::none;
  InputFilter found_, missing_;
  bool was_missing_ = false;
};

}  // namespace firmware
