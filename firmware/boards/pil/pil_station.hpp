// The two axes of a processor-in-the-loop run. The board and the computer that checks it instantiate this same class.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "firmware/boards/pil/pil_messages.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/supervision/axis_group.hpp"

namespace firmware::boards {

template <typename Scalar>
class PilStation {
 public:
  /// Parameters travel as the bytes of this array, so their layout is part of the interface.
  using Parameters = std::array<AxisParameters<Scalar>, hal::kAxisCount>;
  static_assert(std::is_trivially_copyable_v<Parameters>);

  constexpr PilConfigured configure(const Parameters& parameters) {
    PilConfigured result;
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      result.error[i] = static_cast<std::uint32_t>(axes_[i].configure(parameters[i]));
      axes_[i].set_position(0);
    }
    axes_.board().configure(BoardWatch::default_limits(kPilPeriod_s));
    axes_.board().excuse_pause();
    return result;
  }

  constexpr PilReply step(const PilRequest& request) {
    PilReply reply;
    reply.number = request.number;
    std::array<bool, hal::kAxisCount> accepted{};
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      read_in(request.axis[i], io_[i]);
      accepted[i] = obey(request.axis[i], axes_[i]);
    }
    axes_.step({.now_us = request.now_us,
                .emergency_stop = (request.board & 1u) != 0,
                .supply_low = (request.board & 2u) != 0,
                .store_damaged = (request.board & 4u) != 0});
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) reply.axis[i] = write_out(axes_[i], io_[i], accepted[i]);
    return reply;
  }

  const SupervisedAxis<Scalar, ValueAxis>& axis(std::size_t index) const { return axes_[index]; }

 private:
  using Axes = AxisGroup<Scalar, ValueAxis, hal::kAxisCount>;
  using BoardAxis = typename Axes::BoardAxis;
  static constexpr float kPilPeriod_s = 0.001f;

  static constexpr void read_in(const PilAxisRequest& request, ValueAxis& io) {
    io.encoder().reading = {request.encoder_counts, true};
    io.tachometer().reading = {request.tachometer_code, request.tachometer_valid != 0};
    io.limits().state = {(request.lines & 1u) != 0, (request.lines & 2u) != 0, (request.lines & 4u) != 0};
    io.drive_enable().faulted = (request.lines & 8u) != 0;
    io.drive_enable().ready = (request.lines & 16u) == 0;
    io.drive_enable().edges = 0;
  }

  static constexpr bool obey(const PilAxisRequest& request, BoardAxis& axis) {
    switch (request.command) {
      case PilCommand::none:
        return true;
      case PilCommand::enable:
        return axis.enable();
      case PilCommand::disable:
        return axis.disable();
      case PilCommand::jog:
        return axis.jog(std::bit_cast<Scalar>(request.operand_low));
      case PilCommand::move: {
        const auto target = static_cast<std::int64_t>(std::uint64_t{request.operand_high} << 32 | request.operand_low);
        const MovePlanResult planned = axis.plan_move_to(CountPosition::at(target));
        return planned.refusal == Refusal::none && axis.start(planned.plan);
      }
      case PilCommand::stop:
        axis.stop();
        return true;
      case PilCommand::clear_fault:
        return axis.clear_fault();
    }
    return false;
  }

  static constexpr std::array<std::uint32_t, 2> halves(std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
  }

  static constexpr std::uint32_t bits(Scalar value) { return std::bit_cast<std::uint32_t>(value); }

  static constexpr PilAxisReply write_out(const BoardAxis& axis, ValueAxis& io, bool accepted) {
    const AxisTelemetry<Scalar>& seen = axis.telemetry();
    PilAxisReply reply;
    reply.dac_code = io.dac().code;
    reply.dac_writes = io.dac().writes;
    const ValueAxis::Enable& lines = io.drive_enable();
    reply.outputs = (lines.on ? 1u : 0u) | (lines.brake_released ? 2u : 0u) | lines.edges << 4;
    reply.flags = (accepted ? 0u : 1u) | (seen.saturated ? 2u : 0u) | (seen.enabled ? 4u : 0u) |
                  (axis.is_at_rest() ? 8u : 0u) | static_cast<std::uint32_t>(axis.fault()) << 8 |
                  static_cast<std::uint32_t>(axis.state()) << 16;
    reply.encoder_counts = halves(seen.encoder_counts);
    reply.anchor_counts = halves(seen.estimate.anchor_counts);
    reply.reference_counts = halves(seen.reference.counts);
    reply.reference_fraction = halves(seen.reference.fraction);
    reply.tachometer_velocity = bits(seen.tachometer_velocity);
    reply.offset = bits(seen.estimate.offset);
    reply.velocity = bits(seen.estimate.velocity);
    reply.disturbance = bits(seen.estimate.disturbance);
    reply.reference_velocity = bits(seen.reference_velocity);
    reply.position_error = bits(seen.position_error);
    reply.friction_V = bits(seen.friction_V);
    reply.control_V = bits(seen.control_V);
    reply.following_high_water = bits(axis.monitors().high_water());
    reply.captured = static_cast<std::uint32_t>(axis.capture().size());
    return reply;
  }

  std::array<ValueAxis, hal::kAxisCount> io_{};
  Axes axes_{io_};
};

}  // namespace firmware::boards
