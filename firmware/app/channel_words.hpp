// The words of an axis in a captured row, with 32 or 16 bits.
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "firmware/app/protocol/messages.hpp"
#include "firmware/core/supervision/supervised_axis.hpp"

namespace firmware {

namespace channel_words {

template <typename Scalar>
constexpr std::uint32_t bits_of(Scalar value) {
  if constexpr (std::is_floating_point_v<Scalar>)
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  else
    return static_cast<std::uint32_t>(value.raw());
}

}  // namespace channel_words

/// Whether the hardware of a SupervisedAxis has a second encoder on the table.
template <typename Axis>
constexpr bool has_scale(const Axis& axis) {
  if constexpr (hal::TableEncoderHal<std::remove_reference_t<decltype(axis.hal())>>)
    return axis.hal().table_encoder().read().valid;
  else
    return false;
}

/// Number of channels of a SupervisedAxis.
template <typename Axis>
constexpr std::size_t channels_of(const Axis& axis) {
  return kChannels + (has_scale(axis) ? 1 : 0);
}

/// A SupervisedAxis.
template <typename Axis>
std::uint32_t channel_word(const Axis& axis, Channel channel) {
  using channel_words::bits_of;
  const auto& seen = axis.telemetry();
  switch (channel) {
    case Channel::dac_code:
      return static_cast<std::uint32_t>(seen.dac_code);
    case Channel::counts:
      return static_cast<std::uint32_t>(seen.encoder_counts);
    case Channel::tachometer_velocity:
      return bits_of(seen.tachometer_velocity);
    case Channel::reference:
      return static_cast<std::uint32_t>(seen.reference.counts) << 8 |
             static_cast<std::uint32_t>(seen.reference.fraction >> (kFractionBits - 8));
    case Channel::reference_velocity:
      return bits_of(seen.reference_velocity);
    case Channel::position_error:
      return bits_of(seen.position_error);
    case Channel::velocity_estimate:
      return bits_of(seen.estimate.velocity);
    case Channel::disturbance:
      return bits_of(seen.estimate.disturbance);
    case Channel::friction:
      return bits_of(seen.friction_V);
    case Channel::control:
      return bits_of(seen.control_V);
    case Channel::table_counts:
      if constexpr (hal::TableEncoderHal<std::remove_reference_t<decltype(axis.hal())>>)
        return axis.hal().table_encoder().read().counts;
      break;
    case Channel::flags:
      break;
  }
  return static_cast<std::uint32_t>(axis.state()) | static_cast<std::uint32_t>(axis.fault()) << 8 |
         (seen.saturated ? 1u << 16 : 0u) |
         (axis.parameters().friction_feedforward_on && !axis.control_law().feeds_friction() ? 1u << 17 : 0u);
}

/// A row that a SupervisedAxis kept from before its fault; false beyond the last.
template <typename Axis>
bool fault_row(const Axis& axis, std::size_t row, FaultRowPayload& payload) {
  using channel_words::bits_of;
  const auto& kept = axis.capture();
  if (!kept.is_frozen() || row >= kept.size()) return false;
  const auto& sample = kept.row(row);
  payload.rows = static_cast<std::uint16_t>(kept.size());
  payload.every = static_cast<std::uint16_t>(kept.stride());
  payload.dac_code = static_cast<std::uint32_t>(sample.dac_code);
  payload.counts = static_cast<std::uint32_t>(sample.estimate.anchor_counts);
  payload.tachometer_velocity = bits_of(sample.tachometer_velocity);
  payload.reference_velocity = bits_of(sample.reference_velocity);
  payload.position_error = bits_of(sample.position_error);
  payload.velocity_estimate = bits_of(sample.estimate.velocity);
  payload.disturbance = bits_of(sample.estimate.disturbance);
  payload.index_way = static_cast<std::uint32_t>(axis.index_way());
  return true;
}

/// Channels that are whole numbers, compared by their difference; the others are scalars.
constexpr bool is_whole(Channel channel) {
  return channel == Channel::dac_code || channel == Channel::counts || channel == Channel::reference ||
         channel == Channel::flags;
}

/// The word in 16 bits: the low half of codes and counts, the reference in 1/16 counts, the rounded upper half of a
/// float (8 bits of its fraction: 0.4 %). Flags: state, bit 7 for saturated, then the fault.
constexpr std::uint16_t narrow(std::uint32_t word, Channel channel) {
  switch (channel) {
    case Channel::dac_code:
    case Channel::counts:
      return static_cast<std::uint16_t>(word);
    case Channel::reference:
      return static_cast<std::uint16_t>(word >> 4);
    case Channel::flags:
      return static_cast<std::uint16_t>((word & 0xFF7Fu) | (word >> 9 & 0x80u));
    default:
      return static_cast<std::uint16_t>((word + 0x8000u) >> 16);
  }
}

}  // namespace firmware
