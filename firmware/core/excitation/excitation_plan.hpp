// The excitation of an axis, and the box that it must not leave meanwhile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/compensation/turn_sine.hpp"

namespace firmware {

/// Numbers are permanent, because requests contain them.
enum class ExcitationKind : std::uint8_t {
  train = 0,      ///< levels, each for its time or until the box reverses it
  ramp = 1,       ///< from 0 up to the amplitude until the axis moves away, then from 0 the other way
  chirp = 2,      ///< sine whose frequency changes from first to last; a plain sine if they are equal
  multisine = 3,  ///< the sum of the lines
  triangle = 4,   ///< back and forth at constant speed
};
inline constexpr std::size_t kExcitationKinds = 5;

/// The point at which the excitation is added.
enum class ExcitationInput : std::uint8_t {
  open_loop = 0,  ///< it is the whole command; the controller does not act
  reference = 1,  ///< added to the reference, counts
  output = 2,     ///< added to the controller's output
  jog = 3,        ///< velocity of the axis's own jog, within its limits
};
inline constexpr std::size_t kExcitationInputs = 4;

/// A level of a train: value and samples. A line of a multisine: amplitude, turns per sample, initial phase.
template <typename Scalar>
struct ExcitationEntry {
  Scalar value{};
  std::uint32_t first = 0;   ///< samples; turns a sample
  std::uint32_t second = 0;  ///< phase
};
/// Largest number of lines for which the control interrupt has time.
inline constexpr std::size_t kExcitationEntries = 14;

/// Sums of a few such distances fit 32 bits.
inline constexpr std::int32_t kMostBoxCounts = std::int32_t{1} << 28;

/// Fastest box, counts a sample.
inline constexpr float kMostSpeedCounts = 16384.0f;

/// The board's own limits for an excited axis, independent of the excitation.
template <typename Scalar>
struct ExcitationBox {
  std::int32_t travel_counts = 0;  ///< on each side of its start, 1..kMostBoxCounts
  std::int32_t margin_counts = 0;  ///< stopping distance; 0: unknown, estimated from the axis's own acceleration
  std::int32_t speed = 0;          ///< 1/256 counts in kSpeedSamples, 1..kMostBoxCounts
  Scalar drive_velocity{};         ///< the same for the tachometer, rad/s (m/s); 0: its scale is not known
  Scalar counts_per_velocity{};    ///< counts a sample per unit of the tachometer; 0: its scale is not known
  Scalar volts{};                  ///< largest command of an open loop, and largest addition to a controller's output
};

/// Travel that the tachometer may show while the encoder shows none, as a part 2^-n of half the window.
inline constexpr int kBlindShift = 3;

/// The encoder's speed is its travel in this many samples: one count is a quarter of a count per sample.
inline constexpr std::int32_t kSpeedSamples = 4;

/// Values are V; counts for ExcitationInput::reference; the velocity of a jog for ExcitationInput::jog.
template <typename Scalar>
struct ExcitationPlan {
  ExcitationKind kind = ExcitationKind::train;
  ExcitationInput input = ExcitationInput::open_loop;
  std::uint8_t count = 0;           ///< entries in use: levels, lines
  Scalar amplitude{};               ///< of ramp, chirp and triangle; of a train and a multisine their largest value
  Scalar ride{};                    ///< jog beneath the excitation of a closed loop; it reverses within the box
  std::uint32_t samples = 0;        ///< time of the box, > 0
  std::uint32_t period = 1;         ///< of ramp (0 to the amplitude), multisine and triangle, samples
  Turn step = 0, last_step = 0;     ///< of a chirp: turns a sample at the beginning and at the end; of a triangle
  std::uint32_t fade_samples = 1;   ///< in which a periodic excitation is faded in and out
  std::uint32_t stall_samples = 1;  ///< at nine tenths of the amplitude without a count: then the axis does not move
  ExcitationBox<Scalar> box{};
  std::array<ExcitationEntry<Scalar>, kExcitationEntries> entry{};
};

/// Largest excitation of a reference: a scalar of fixed point holds it.
inline constexpr float kMostReferenceCounts = 1000.0f;

/// Whether a plan can be run.
template <typename Scalar>
constexpr bool is_possible(const ExcitationPlan<Scalar>& p) {
  using Traits = ScalarTraits<Scalar>;
  constexpr std::int32_t kMost = kMostBoxCounts;
  const ExcitationBox<Scalar>& box = p.box;
  if (box.travel_counts < 1 || box.travel_counts > kMost || box.margin_counts < 0 || box.margin_counts > kMost ||
      box.speed < 1 || box.speed > kMost)
    return false;
  const auto is_size = [](Scalar value) { return value >= Scalar(0) && Traits::is_finite(value); };
  if (!is_size(box.volts) || !is_size(box.drive_velocity) || !is_size(p.amplitude) || !Traits::is_finite(p.ride))
    return false;
  if (p.samples == 0 || p.period == 0 || p.fade_samples == 0 || p.stall_samples == 0 || p.count > kExcitationEntries)
    return false;
  const bool has_entries = p.kind == ExcitationKind::train || p.kind == ExcitationKind::multisine;
  if (has_entries != (p.count != 0)) return false;
  for (std::size_t i = 0; i < p.count; ++i) {
    if (!Traits::is_finite(p.entry[i].value)) return false;
    if (p.kind == ExcitationKind::train && p.entry[i].first == 0) return false;
    if (p.kind == ExcitationKind::multisine && Traits::magnitude(p.entry[i].value) > Scalar(kMostReferenceCounts))
      return false;
  }
  // Only a train suits a jog, and only an excitation that returns to its start suits a reference.
  if ((p.input == ExcitationInput::jog) != (p.kind == ExcitationKind::train && p.input != ExcitationInput::open_loop))
    return false;
  if (p.kind == ExcitationKind::ramp && p.input != ExcitationInput::open_loop) return false;
  if (p.kind == ExcitationKind::triangle && p.input != ExcitationInput::reference) return false;
  return p.input != ExcitationInput::reference || p.amplitude <= Scalar(kMostReferenceCounts);
}

}  // namespace firmware
