// Pitch error compensation: the reference deviates from the wanted position by the screw's error there.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/compensation/crossing_ramp.hpp"
#include "firmware/core/compensation/pitch_table.hpp"
#include "firmware/core/compensation/reversal_watch.hpp"
#include "firmware/core/control/reference_feedforward.hpp"

namespace firmware {

struct PitchParameters {
  bool on = false;
  std::int32_t crossing_samples = 1;  ///< 1..CrossingRamp::kLongest
};

/// Subtracts the deviation for the direction in which the reference moves, interpolated linearly between points; before
/// the first motion the mean of both directions. Acts once the axis is homed. If the offset would jump (a reversal, a
/// home found or lost), it changes over a fixed number of samples.
class PitchCorrection {
 public:
  constexpr void configure(const PitchParameters& parameters) {
    on_ = parameters.on;
    ramp_.configure(parameters.crossing_samples);
    reset();
  }

  /// For a disabled axis; the table must stay in place while it is used.
  constexpr void use(PitchTable table) {
    table_ = table;
    reset();
  }

  /// For an axis whose position has just been found.
  constexpr void reset() {
    reversal_.reset();
    offsets_ = {};
    acts_ = false;
    ramp_.end();
    stretch_ = {};
  }

  constexpr bool is_on() const { return on_; }
  constexpr bool is_crossing() const { return ramp_.is_under_way(); }

  /// The loop closes at the axis's position: the reference begins at `place`, and the wanted position differs from it
  /// by the correction.
  [[gnu::noinline]] constexpr void enter(const CountPosition& place, bool homed) {
    if (!on_) return;
    acts_ = homed;
    ramp_.end();
    position_ = place;
    Increment offset = 0;
    for (int i = 0; acts_ && i < 3; ++i) {  // each round reduces the error to a sixty-fourth
      offset = wanted();
      position_ = place;
      position_.advance(-offset);
    }
    offsets_.fill(offset);
  }
  constexpr void leave() { ramp_.end(); }

  /// Amount added to the reference's newest increment.
  [[gnu::noinline]] constexpr Increment next(Increment reference, bool homed) {
    position_.advance(reference);
    if (reversal_.turns(reference) || homed != acts_) {
      acts_ = homed;
      cross();
    }
    for (int i = 0; i < kPreviewSamples; ++i) offsets_[i] = offsets_[i + 1];
    const Increment target = acts_ ? wanted() : 0;
    offsets_[kPreviewSamples] = ramp_.is_under_way() ? ramp_.next(begin_, target) : target;
    return offsets_[kPreviewSamples] - offsets_[kPreviewSamples - 1];
  }

  /// The same position, counted from another origin.
  constexpr void shift(std::int64_t counts) {
    position_.counts += counts;
    cross();
  }

  /// Total amount added to the reference `ahead` samples from now, 2^-48 counts.
  constexpr Increment offset(int ahead) const { return offsets_[ahead]; }

  /// Counts, rounded up, of the largest offset.
  constexpr std::int64_t largest_offset() const {
    std::int64_t largest = 0;
    if (on_)
      for (const PitchPoint& point : table_)
        for (const std::int64_t value : {point.forward, point.backward})
          largest = std::max(largest, value < 0 ? -value : value);
    return (largest + 65535) >> 16;
  }

 private:
  /// Between two points, for one direction: an offset that changes linearly.
  struct Stretch {
    std::int64_t begin = 0, end = 0;  ///< counts
    Increment offset = 0, slope = 0;  ///< at `begin`; a count
  };
  static constexpr std::int64_t kBeyondAll = std::int64_t{1} << 62;

  constexpr void cross() {
    begin_ = offsets_[kPreviewSamples];
    ramp_.begin();
    stretch_ = {};  // perhaps for the other direction
  }

  constexpr Increment wanted() {
    if (position_.counts < stretch_.begin || position_.counts >= stretch_.end) find_stretch();
    // 16 bits of the fraction of a count are enough.
    return stretch_.offset + stretch_.slope * (position_.counts - stretch_.begin) +
           (stretch_.slope >> 16) * (position_.fraction >> (kFractionBits - 16));
  }

  /// Called rarely: eight comparisons and a division.
  [[gnu::noinline]] constexpr void find_stretch() {
    stretch_ = {-kBeyondAll, kBeyondAll, 0, 0};
    if (table_.empty()) return;
    std::size_t first = 0, behind = table_.size();  // the first point beyond the position is in first..behind
    while (first < behind) {
      const std::size_t middle = (first + behind) / 2;
      if (table_[middle].counts > position_.counts)
        behind = middle;
      else
        first = middle + 1;
    }
    if (behind > 0) {
      stretch_.begin = table_[behind - 1].counts;
      stretch_.offset = offset_at(table_[behind - 1]);
    }
    if (behind == 0) {
      stretch_.end = table_[0].counts;
      stretch_.offset = offset_at(table_[0]);
    } else if (behind < table_.size()) {
      stretch_.end = table_[behind].counts;
      stretch_.slope = (offset_at(table_[behind]) - stretch_.offset) / (stretch_.end - stretch_.begin);
    }
  }

  constexpr Increment offset_at(const PitchPoint& point) const {
    const int side = reversal_.side();
    const std::int64_t deviation = side > 0   ? point.forward
                                   : side < 0 ? point.backward
                                              : (std::int64_t{point.forward} + point.backward) / 2;
    return -deviation * (kOneCount >> 16);
  }

  bool on_ = false, acts_ = false;
  PitchTable table_;
  CrossingRamp ramp_;
  ReversalWatch reversal_;
  CountPosition position_{};  ///< wanted position of the table, kPreviewSamples from now
  Increment begin_ = 0;
  Stretch stretch_;
  std::array<Increment, kPreviewSamples + 1> offsets_{};
};

}  // namespace firmware
