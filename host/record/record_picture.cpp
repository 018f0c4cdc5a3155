#include "host/record/record_picture.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <stop_token>

#include "host/cancellation.hpp"
#include "host/exit_codes.hpp"
#include "host/parallel.hpp"

namespace host {

namespace {

/// 0 ... count-1, spread evenly from the beginning on: each round halves the distances.
std::vector<std::size_t> spread(std::size_t count) {
  std::vector<std::size_t> order{0};
  order.reserve(count);
  for (std::size_t step = std::bit_ceil(count) / 2; step > 0; step /= 2)
    for (std::size_t k = step; k < count; k += 2 * step) order.push_back(k);
  return order;
}

}  // namespace

RecordPicture::RecordPicture(const std::string& path)
    : file_(path),
      pyramid_(file_.columns().size(), file_.rows()),
      blocks_(file_.blocks()),
      reader_([this](const std::stop_token& stop) { read(stop); }) {}

std::size_t RecordPicture::bytes() const {
  return EnvelopePyramid::bytes(file_.columns().size(), file_.rows()) + blocks_.size() * sizeof(Block);
}

RecordPicture::Progress RecordPicture::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void RecordPicture::wait(double longest_s) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(longest_s),
                    [this] { return progress_.share >= 1.0 || !progress_.problem.empty(); });
}

void RecordPicture::read(const std::stop_token& stop) {
  std::atomic<bool> is_stopped = false;
  const std::stop_callback on_stop(stop, [&] { is_stopped = true; });
  const CancelledBy scope(&is_stopped);
  const std::vector<std::size_t> order = spread(blocks_.size());
  try {
    for_each_in_parallel(order.size(), [&](std::size_t k) { read_block(order[k]); });
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    progress_.problem = error.what();
  }
  changed_.notify_all();
}

void RecordPicture::read_block(std::size_t index) {
  std::vector<EnvelopePyramid::Piece> pieces;
  Block block;
  const RecordFile::Faults faults =
      file_.each_row(file_.block(index), [&](std::uint64_t number, std::span<const double> values) {
        if (block.first > block.last) block.first = number;
        block.last = number;
        const std::uint64_t bucket = number / EnvelopePyramid::kRows;
        if (pieces.empty() || pieces.back().bucket != bucket) {
          pieces.push_back({bucket, 1, {values.begin(), values.end()}, {values.begin(), values.end()}});
          return;
        }
        EnvelopePyramid::Piece& piece = pieces.back();
        ++piece.taken;
        for (std::size_t k = 0; k < values.size(); ++k) {
          // Comparisons with NaN are false.
          if (values[k] < piece.low[k] || std::isnan(piece.low[k])) piece.low[k] = values[k];
          if (values[k] > piece.high[k] || std::isnan(piece.high[k])) piece.high[k] = values[k];
        }
      });
  const std::lock_guard lock(mutex_);
  pyramid_.add(pieces);
  blocks_[index] = block;
  progress_.faults.rows += faults.rows;
  progress_.faults.fields += faults.fields;
  progress_.share = static_cast<double>(++read_) / static_cast<double>(blocks_.size());
}

std::vector<std::size_t> RecordPicture::blocks_of(std::uint64_t from, std::uint64_t to) const {
  std::vector<std::size_t> indices;
  const std::lock_guard lock(mutex_);
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (blocks_[k].first <= blocks_[k].last && blocks_[k].first < to && blocks_[k].last >= from) indices.push_back(k);
  return indices;
}

Envelope RecordPicture::envelope(std::uint64_t from, std::uint64_t to, std::size_t points) const {
  to = std::min(to, file_.rows());
  from = std::min(from, to);
  const std::size_t most = std::clamp<std::size_t>(points, 1, kMostPoints);
  const std::size_t rows = std::bit_ceil(std::max<std::uint64_t>(1, (to - from + most - 1) / most));
  if (rows >= EnvelopePyramid::kRows) {
    const std::lock_guard lock(mutex_);
    return pyramid_.envelope(from, to, rows);
  }
  const std::uint64_t first = from / rows, end = (to + rows - 1) / rows;
  Envelope envelope = Envelope::empty(file_.columns().size(), first * rows, rows, end - first);
  for (const std::size_t index : blocks_of(first * rows, end * rows))
    file_.each_row(file_.block(index), [&](std::uint64_t number, std::span<const double> values) {
      const std::uint64_t bucket = number / rows;
      if (bucket >= first && bucket < end) envelope.widen(bucket - first, 1, values, values);
    });
  return envelope;
}

std::string RecordPicture::text_of(std::uint64_t from, std::uint64_t to) const {
  if (const Progress now = progress(); now.share < 1.0)
    throw Failure(ExitCode::refused, now.problem.empty() ? "the record is still being read: wait" : now.problem);
  std::string text = file_.head();
  for (const std::size_t index : blocks_of(from, to)) text += file_.block(index);
  return text;
}

}  // namespace host
