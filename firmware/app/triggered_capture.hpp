// A capture in the board's own memory, at loop rate, around an event.
#pragma once

#include <bit>
#include <span>
#include <type_traits>

#include "firmware/app/channel_words.hpp"
#include "firmware/app/crc32.hpp"
#include "firmware/app/protocol/trigger_messages.hpp"

namespace firmware {

/// State of a capture in addition to its rows. If a board puts both into memory that survives a reset, the last capture
/// can be read afterwards.
struct TriggeredState {
  std::uint32_t magic;
  std::uint32_t crc;  ///< of the request
  TriggerRequest request;
  TriggerPhase phase;
  std::uint32_t half_words;  ///< room for rows
  std::uint32_t next;        ///< next row of the ring
  std::uint32_t taken;       ///< rows since it was armed; stays at the ring's size
  std::uint32_t trigger;     ///< row of the ring
  std::uint32_t after;       ///< rows taken from the trigger on
  std::int64_t counts;       ///< of the axis at the trigger
};

/// Smallest memory: 100 ms of four channels at 20 kHz. A board may use more of its RAM.
struct TriggeredMemory : TriggeredState {
  static constexpr std::size_t kHalfWords = 8000;
  std::array<std::uint16_t, kHalfWords> half_word;
};
static_assert(std::is_trivial_v<TriggeredMemory>);

/// take() belongs to the control interrupt, the rest to the background.
class TriggeredCapture {
 public:
  /// Keeps the memory's contents if they are a capture whose trigger has occurred.
  void adopt(TriggeredState& memory, std::span<std::uint16_t> rows) {
    memory_ = &memory;
    rows_ = rows;
    const bool is_sound = memory.magic == kMagic && memory.crc == crc_of(memory.request) &&
                          memory.half_words == rows.size() && is_possible(memory.request, hal::kMostAxes) &&
                          memory.phase >= TriggerPhase::recording && memory.phase <= TriggerPhase::complete;
    if (is_sound) lay_out(memory.request);
    survived_ = is_sound && memory.next < ring_rows_ && memory.trigger < ring_rows_ && memory.taken <= ring_rows_ &&
                memory.after <= memory.request.after;
    memory.phase = survived_ ? TriggerPhase::complete : TriggerPhase::idle;
  }
  void adopt(TriggeredMemory& memory) { adopt(memory, memory.half_word); }

  bool is_possible(const TriggerRequest& r, std::size_t axes) const {
    CaptureRequest channels;
    channels.channels = r.channels;
    if (channels.words() == 0 || channels.words() > kWordsPerReport || r.every == 0 || r.after == 0) return false;
    for (std::size_t axis = 0; axis < hal::kMostAxes; ++axis)
      if (r.channels[axis] >> (axis < axes ? kChannels : 0) != 0 || (r.wide[axis] & ~r.channels[axis]) != 0)
        return false;
    const bool names_axis =
        r.axis < axes || (r.axis == kAnyAxis && r.kind == static_cast<std::uint8_t>(TriggerKind::fault));
    if (r.kind >= kTriggerKinds || !names_axis || r.channel >= kChannels || r.falling > 1) return false;
    const std::uint32_t most = room() / half_words_of(r);
    return r.after <= most && r.before <= most - r.after;
  }

  /// Call it while the control interrupt is disabled; `request` must be possible.
  void arm(const TriggerRequest& request) {
    TriggeredState& m = *memory_;
    m.request = request;
    m.magic = kMagic;
    m.crc = crc_of(request);
    m.half_words = room();
    lay_out(request);
    m.next = m.taken = m.trigger = m.after = 0;
    m.counts = 0;
    until_next_ = 1;
    holdoff_ = request.holdoff;
    was_so_ = true;  // the level is passed only after a sample on its near side
    survived_ = false;
    m.phase = TriggerPhase::waiting;
  }
  void stop() {
    if (memory_->phase != TriggerPhase::complete) memory_->phase = TriggerPhase::idle;
  }

  bool is_running() const {
    return memory_->phase == TriggerPhase::waiting || memory_->phase == TriggerPhase::recording;
  }

  /// Once a control period, after the axes' steps.
  template <typename Axes>
  [[gnu::noinline]] void take(const Axes& axes) {
    TriggeredState& m = *memory_;
    if (m.phase == TriggerPhase::waiting && has_come(axes)) {
      m.phase = TriggerPhase::recording;
      m.counts = axes[m.request.axis == kAnyAxis ? 0 : m.request.axis].telemetry().encoder_counts;
      m.trigger = m.next;
      until_next_ = 1;
    }
    if (--until_next_ > 0) return;
    until_next_ = m.request.every;
    put_row(axes);
    if (m.phase != TriggerPhase::recording) return;
    m.after = m.after + 1;
    if (m.after >= m.request.after) m.phase = TriggerPhase::complete;
  }

  TriggerStatePayload state() const {
    const TriggeredState& m = *memory_;
    TriggerStatePayload state;
    state.phase = static_cast<std::uint8_t>(m.phase);
    state.half_words = static_cast<std::uint8_t>(row_size_);
    state.survived = survived_ ? 1 : 0;
    state.capacity = room();
    state.channels = m.request.channels;
    state.wide = m.request.wide;
    state.every = m.request.every;
    state.kind = m.request.kind;
    state.axis = m.request.axis;
    state.counts_low = static_cast<std::uint32_t>(m.counts);
    state.counts_high = static_cast<std::int32_t>(m.counts >> 32);
    if (m.phase < TriggerPhase::recording) return state;
    state.trigger_row = rows_before();
    state.rows = state.trigger_row + m.after;
    return state;
  }

  /// False beyond the end, and while rows are still being recorded.
  bool read(std::uint32_t first, TriggeredPayload& payload) const {
    const TriggeredState& m = *memory_;
    if (m.phase != TriggerPhase::complete) return false;
    const std::uint32_t half_words = (rows_before() + m.after) * row_size_;
    if (first >= half_words) return false;
    payload.first = first;
    const std::uint32_t oldest = (m.trigger + ring_rows_ - rows_before()) % ring_rows_;
    for (std::uint32_t i = 0; i < kHalfWordsPerReport && first + i < half_words; ++i) {
      const std::uint32_t row = (oldest + (first + i) / row_size_) % ring_rows_;
      payload.half_word[i] = rows_[row * row_size_ + (first + i) % row_size_];
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kMagic = 0x54524743;

  static std::uint32_t crc_of(const TriggerRequest& request) { return crc32(std::as_bytes(std::span(&request, 1))); }

  static std::uint32_t half_words_of(const TriggerRequest& r) {
    std::uint32_t count = 0;
    for (std::size_t axis = 0; axis < hal::kMostAxes; ++axis)
      count += static_cast<std::uint32_t>(std::popcount(r.channels[axis]) + std::popcount(r.wide[axis]));
    return count;
  }

  std::uint32_t room() const { return static_cast<std::uint32_t>(rows_.size()); }

  void lay_out(const TriggerRequest& request) {
    row_size_ = half_words_of(request);
    ring_rows_ = room() / row_size_;
  }

  std::uint32_t rows_before() const {
    const TriggeredState& m = *memory_;
    const std::uint32_t there = m.taken - m.after;
    return there < m.request.before ? there : m.request.before;
  }

  template <typename Axes>
  bool has_come(const Axes& axes) {
    const TriggerRequest& r = memory_->request;
    bool is_so = true;
    switch (static_cast<TriggerKind>(r.kind)) {
      case TriggerKind::none:
        break;
      case TriggerKind::level:
      case TriggerKind::edge:
        is_so = lies_beyond(axes[r.axis]);
        break;
      case TriggerKind::fault:
        is_so = has_fault(axes, r.axis);
        break;
      case TriggerKind::motion:
        is_so = is_led(axes[r.axis]);
        break;
    }
    const bool begins = is_so && !was_so_;
    was_so_ = is_so;
    if (holdoff_ > 0) {
      --holdoff_;
      return false;
    }
    return r.kind <= static_cast<std::uint8_t>(TriggerKind::level) ? is_so : begins;
  }

  template <typename Axis>
  static bool is_led(const Axis& axis) {
    const auto velocity = axis.telemetry().reference_velocity;
    return velocity != decltype(velocity){};
  }

  template <typename Axes>
  static bool has_fault(const Axes& axes, std::uint8_t which) {
    for (std::size_t axis = 0; axis < Axes::kAxes; ++axis)
      if ((which == kAnyAxis || which == axis) && axes[axis].fault() != AxisFault::none) return true;
    return false;
  }

  template <typename Axis>
  bool lies_beyond(const Axis& axis) const {
    using Scalar = std::remove_cvref_t<decltype(axis.telemetry().position_error)>;
    const TriggerRequest& r = memory_->request;
    const auto channel = static_cast<Channel>(r.channel);
    const std::uint32_t word = channel_word(axis, channel);
    if (std::is_floating_point_v<Scalar> && !is_whole(channel)) {
      const auto value = std::bit_cast<float>(word), level = std::bit_cast<float>(r.level);
      return r.falling != 0 ? value < level : value > level;
    }
    // Difference of low words, modulo their range.
    const auto distance = static_cast<std::int32_t>(word - r.level);
    return r.falling != 0 ? distance < 0 : distance > 0;
  }

  template <typename Axes>
  void put_row(const Axes& axes) {
    TriggeredState& m = *memory_;
    std::uint16_t* out = rows_.data() + m.next * row_size_;
    for (std::size_t axis = 0; axis < Axes::kAxes; ++axis) {
      const std::uint32_t wide = m.request.wide[axis];
      for (std::uint32_t left = m.request.channels[axis]; left != 0; left &= left - 1) {
        const auto bit = std::countr_zero(left);
        const auto channel = static_cast<Channel>(bit);
        const std::uint32_t word = channel_word(axes[axis], channel);
        if ((wide >> bit & 1u) != 0) {
          *out++ = static_cast<std::uint16_t>(word);
          *out++ = static_cast<std::uint16_t>(word >> 16);
        } else {
          *out++ = narrow(word, channel);
        }
      }
    }
    m.next = m.next + 1 == ring_rows_ ? 0 : m.next + 1;
    if (m.taken < ring_rows_) m.taken = m.taken + 1;
  }

  TriggeredState* memory_ = nullptr;
  std::span<std::uint16_t> rows_;
  std::uint32_t row_size_ = 1, ring_rows_ = 1;
  std::int32_t until_next_ = 1;
  std::uint32_t holdoff_ = 0;
  bool was_so_ = true, survived_ = false;
};

}  // namespace firmware
