#include "host/live/sample_ring.hpp"

#include <algorithm>

namespace host {

SampleRing::SampleRing(std::size_t channels, std::size_t rows, std::size_t steps)
    : channels_(channels), rows_(rows), values_(channels * rows), is_taken_(rows), steps_(steps) {}

std::uint64_t SampleRing::begin() const { return end_ > rows_ ? end_ - rows_ : 0; }

std::span<const double> SampleRing::row(std::uint64_t number) const {
  return {values_.data() + number % rows_ * channels_, channels_};
}

void SampleRing::append(std::uint32_t number, std::span<const double> values) {
  const auto ahead = static_cast<std::int32_t>(number - static_cast<std::uint32_t>(end_));
  if (ahead < 0) {
    ++repeated_;
    return;
  }
  const std::uint64_t taken = end_ + static_cast<std::uint64_t>(ahead);
  const std::uint64_t first_step = (end_ + kStep - 1) / kStep, last_step = taken / kStep;
  lost_ += taken - end_;
  for (std::uint64_t gap = std::max(end_, taken > rows_ ? taken - rows_ : 0); gap < taken; ++gap)
    is_taken_[gap % rows_] = false;
  for (std::uint64_t step = std::max(first_step, last_step > steps_.size() ? last_step - steps_.size() : 0);
       step <= last_step; ++step)
    steps_[step % steps_.size()].taken = 0;
  std::ranges::copy(values, values_.begin() + static_cast<std::ptrdiff_t>(taken % rows_ * channels_));
  is_taken_[taken % rows_] = true;
  end_ = taken + 1;

  Step& step = steps_[last_step % steps_.size()];
  if (step.taken++ == 0) {
    step.low.assign(values.begin(), values.end());
    step.high = step.low;
  }
  for (std::size_t k = 0; k < channels_; ++k) {
    step.low[k] = std::min(step.low[k], values[k]);
    step.high[k] = std::max(step.high[k], values[k]);
  }
}

Envelope SampleRing::envelope(std::uint64_t from, std::uint64_t to, std::size_t rows) const {
  const bool by_steps = rows % kStep == 0;
  const std::uint64_t known_steps = (steps_.size() - 1) * kStep;
  const std::uint64_t oldest = by_steps ? (end_ > known_steps ? end_ - known_steps : 0) : begin();
  const std::uint64_t first = (std::max(from, oldest) + rows - 1) / rows, last = std::min(to, end_) / rows;
  const std::size_t buckets = last > first ? last - first : 0;
  Envelope envelope = Envelope::empty(channels_, first * rows, rows, buckets);
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::uint64_t begin = (first + bucket) * rows, end = begin + rows;
    if (by_steps) {
      for (std::uint64_t k = begin / kStep; k < end / kStep; ++k) {
        const Step& step = steps_[k % steps_.size()];
        envelope.widen(bucket, step.taken, step.low, step.high);
      }
      continue;
    }
    for (std::uint64_t number = begin; number < end; ++number)
      if (is_taken_[number % rows_]) envelope.widen(bucket, 1, row(number), row(number));
  }
  return envelope;
}

void SampleRing::each(std::uint64_t from, std::uint64_t to,
                      const std::function<void(std::uint64_t, std::span<const double>)>& use) const {
  for (std::uint64_t number = std::max(from, begin()); number < std::min(to, end_); ++number)
    if (is_taken_[number % rows_]) use(number, row(number));
}

}  // namespace host
