// What an axis is excited with, and the box that it must not leave meanwhile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/compensation/turn_sine.hpp"

namespace firmware {

/// Numbers are permanent: they stand in requests.
enum class ExcitationKind : std::uint8_t {
  train = 0,      ///< levels, each for its time or until the box tells it to turn round
  ramp = 1,       ///< from 0 up to the amplitude until the axis moves away, then from 0 the other way
  chirp = 2,      ///< sine whose frequency goes from the first to the last; a plain sine where they are equal
  multisine = 3,  ///< the sum of the lines
  triangle = 4,   ///< to and fro at constant speed
};
inline constexpr std::size_t kExcitationKinds = 5;

/// Where it goes in.
enum class ExcitationInput : std::uint8_t {
  open_loop = 0,  ///< it is all of the command; the controller is out of action
  reference = 1,  ///< added to the reference, counts
  output = 2,     ///< added to the controller's output
  jog = 3,        ///< velocity of the axis's own jog, within its limits
};
inline constexpr std::size_t kExcitationInputs = 4;

/// A level of a train: value and samples. A line of a multisine: amplitude, turns a sample, phase at the beginning.
template <typename Scalar>
struct ExcitationEntry {
  Scalar value{};
  std::uint32_t first = 0;   ///< samples; turns a sample
  std::uint32_t second = 0;  ///< phase
};
/// As many lines as the control interrupt has time for.
inline constexpr std::size_t kExcitationEntries = 14;

/// Sums of a few such ways have 32 bits.
inline constexpr std::int32_t kMostBoxCounts = std::int32_t{1} << 28;

/// Fastest box, counts a sample.
inline constexpr float kMostSpeedCounts = 16384.0f;

/// The board's own word on what an excited axis may do, whatever excites it.
template <typename Scalar>
struct ExcitationBox {
  std::int32_t travel_counts = 0;  ///< to either side of where it began, 1..kMostBoxCounts
  std::int32_t margin_counts = 0;  ///< the way that a stop takes; 0: not known, the axis's own acceleration tells it
  std::int32_t speed = 0;          ///< 1/256 counts in kSpeedSamples, 1..kMostBoxCounts
  Scalar drive_velocity{};         ///< the same for the tachometer, rad/s (m/s); 0: its scale is not known
  Scalar counts_per_velocity{};    ///< a sample, of the tachometer's unit; 0 likewise
  Scalar volts{};                  ///< largest command of an open loop, and largest addition to a controller's output
};

/// The tachometer may show so much of the window's half, as a part of 2^n, while the encoder shows nothing.
inline constexpr int kBlindShift = 3;

/// The encoder's speed is its travel in so many samples: one count of it is a quarter of a count a sample.
inline constexpr std::int32_t kSpeedSamples = 4;

/// Values are V; counts for ExcitationInput::reference; the velocity of a jog for ExcitationInput::jog.
template <typename Scalar>
struct ExcitationPlan {
  ExcitationKind kind = ExcitationKind::train;
  ExcitationInput input = ExcitationInput::open_loop;
  std::uint8_t count = 0;           ///< entries in use: levels, lines
  Scalar amplitude{};               ///< of ramp, chirp and triangle; of a train and a multisine their largest value
  Scalar ride{};                    ///< jog beneath what is added to a closed loop; it turns round within the box
  std::uint32_t samples = 0;        ///< time of the box, > 0
  std::uint32_t period = 1;         ///< of ramp (0 to the amplitude), multisine and triangle, samples
  Turn step = 0, last_step = 0;     ///< of a chirp: turns a sample at the beginning and at the end; of a triangle
  std::uint32_t fade_samples = 1;   ///< in which a periodic excitation grows to its size, and goes away again
  std::uint32_t stall_samples = 1;  ///< of nine tenths of the amplitude without a count: then nothing moves
  ExcitationBox<Scalar> box{};
  std::array<ExcitationEntry<Scalar>, kExcitationEntries> entry{};
};

/// Largest excitation of a reference: a scalar of fixed point holds it.
inline constexpr float kMostReferenceCounts = 1000.0f;

/// Whether a plan can be run at all.
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
  // Only a train fits a jog, and only what comes back to where it began a reference.
  if ((p.input == ExcitationInput::jog) != (p.kind == ExcitationKind::train && p.input != ExcitationInput::open_loop))
    return false;
  if (p.kind == ExcitationKind::ramp && p.input != ExcitationInput::open_loop) return false;
  if (p.kind == ExcitationKind::triangle && p.input != ExcitationInput::reference) return false;
  return p.input != ExcitationInput::reference || p.amplitude <= Scalar(kMostReferenceCounts);
}

}  // namespace firmware
