// The axes of a board: they start separately and stop together.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "firmware/core/supervision/board_watch.hpp"
#include "firmware/core/supervision/supervised_axis.hpp"

namespace firmware {

template <typename Scalar, SupervisedHal Hal, std::size_t axes>
class AxisGroup {
 public:
  static constexpr std::size_t kAxes = axes;
  using BoardAxis = SupervisedAxis<Scalar, Hal>;

  /// `hal_of(index)`: the hardware of each axis, by reference.
  template <typename HalOf>
  requires std::is_invocable_r_v<Hal&, HalOf, std::size_t>
  constexpr explicit AxisGroup(HalOf hal_of) : AxisGroup(hal_of, std::make_index_sequence<axes>()) {}
  constexpr explicit AxisGroup(std::array<Hal, axes>& hal)
      : AxisGroup([&hal](std::size_t index) -> Hal& { return hal[index]; }) {}

  constexpr BoardAxis& operator[](std::size_t index) { return axes_[index]; }
  constexpr const BoardAxis& operator[](std::size_t index) const { return axes_[index]; }
  constexpr BoardWatch& board() { return board_; }
  constexpr const BoardWatch& board() const { return board_; }

  /// One control period; each axis follows its own reference.
  constexpr void step(const BoardInputs& inputs) {
    const AxisFault outer = watch_board(inputs);
    const Readings readings = read_encoders();
    if (outer == AxisFault::control_overrun) bridge_gap(readings);
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kAxes; ++i) step_axis(i, [&] { axes_[i].step(fault_for(i, outer), readings[i]); });
  }

  /// One control period in which an interpolator moves all axes.
  constexpr void step_with(const std::array<Increment, kAxes>& increments, const BoardInputs& inputs) {
    const AxisFault outer = watch_board(inputs);
    const Readings readings = read_encoders();
    if (outer == AxisFault::control_overrun) bridge_gap(readings);
    for (std::size_t i = 0; i < kAxes; ++i)
      step_axis(i, [&] { axes_[i].step_with(increments[i], fault_for(i, outer), readings[i]); });
  }

  /// Enables all axes of the mask or none of them; returns the first that refuses, or kAxes. An axis that is already
  /// enabled does not refuse.
  constexpr std::size_t enable(unsigned mask) {
    const auto is_named = [mask](std::size_t i) { return (mask >> i & 1u) != 0; };
    for (std::size_t i = 0; i < kAxes; ++i)
      if (is_named(i) && !axes_[i].is_enabled_or_starting() && !axes_[i].may_be_enabled()) return i;
    for (std::size_t i = 0; i < kAxes; ++i)
      if (is_named(i)) axes_[i].enable();
    return kAxes;
  }

  /// An axis that homes counts as in motion: it stands still for a moment between its searches.
  constexpr bool is_in_motion(std::size_t index) const {
    const BoardAxis& axis = axes_[index];
    return axis.is_or_will_be_on() && (!axis.is_at_rest() || axis.is_homing());
  }
  constexpr bool is_in_motion() const {
    for (std::size_t i = 0; i < kAxes; ++i)
      if (is_in_motion(i)) return true;
    return false;
  }

  /// As for SupervisedAxis: true if it holds for any axis.
  constexpr bool must_cut_power() const {
    for (const BoardAxis& axis : axes_)
      if (axis.must_cut_power()) return true;
    return false;
  }

  /// Whether the relay in the amplifiers' power is closed. It opens once all axes stand after a stop, after the stop's
  /// delay, and if an enable does not drop.
  constexpr bool may_have_power() const {
    if (board_.is_stopped() && (board_.is_stop_due() || !outputs_on())) return false;
    return !must_cut_power();
  }

  constexpr bool outputs_on() const {
    for (const BoardAxis& axis : axes_)
      if (outputs_are_on(axis.state())) return true;
    return false;
  }

 private:
  template <typename HalOf, std::size_t... index>
  constexpr AxisGroup(HalOf hal_of, std::index_sequence<index...>) : axes_{BoardAxis(hal_of(index))...} {}

  using Readings = std::array<hal::EncoderReading, kAxes>;
  /// Reads all positions at one instant, however long the steps then take.
  constexpr Readings read_encoders() { return read_encoders(std::make_index_sequence<axes>()); }
  template <std::size_t... index>
  constexpr Readings read_encoders(std::index_sequence<index...>) {
    return {axes_[index].read_encoder()...};
  }

  constexpr AxisFault watch_board(const BoardInputs& inputs) {
    return board_.watch(
        inputs, [this] { return outputs_on(); },
        [this] {
          for (BoardAxis& axis : axes_) axis.disable();
        });
  }

  /// Tells the axes about lost periods.
  constexpr void bridge_gap(const Readings& readings) {
    for (std::size_t i = 0; i < kAxes; ++i) axes_[i].bridge_gap(readings[i]);
  }

  /// A fault of one axis stops the other; faults of the axis itself and of the board come first.
  constexpr AxisFault fault_for(std::size_t index, AxisFault outer) {
    if (outer != AxisFault::none || !must_stop_[index]) return outer;
    must_stop_[index] = false;
    return AxisFault::other_axis_stopped;
  }

  template <typename Step>
  constexpr void step_axis(std::size_t index, Step step) {
    step();
    if (axes_[index].has_looked_at_index() && index + 1 < kAxes) axes_[index + 1].leave_index_for_later();
    if (!axes_[index].take_new_fault()) return;
    for (std::size_t other = 0; other < kAxes; ++other)
      if (other != index && axes_[other].is_or_will_be_on()) must_stop_[other] = true;
  }

  BoardWatch board_;
  std::array<BoardAxis, kAxes> axes_;
  std::array<bool, kAxes> must_stop_{};
};

}  // namespace firmware
