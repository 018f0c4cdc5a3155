// A path that the host streams and the board follows by itself, with one clock for all axes.
#pragma once

#include <atomic>
#include <limits>

#include "firmware/core/path/path_clock.hpp"
#include "firmware/core/path/path_load.hpp"
#include "firmware/core/path/path_piece.hpp"
#include "firmware/core/refusal.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"

namespace firmware {

/// Numbers are permanent, because replies contain them.
enum class PathPhase : std::uint8_t {
  idle = 0,
  open = 1,  ///< takes nodes, and waits for its start
  running = 2,
  stopping = 3,  ///< comes to rest on the path, and ends there
  done = 4,
};

enum class PathEnd : std::uint8_t {
  none = 0,
  completed = 1,  ///< its last node was reached
  asked = 2,      ///< it was stopped by request
  starved = 3,    ///< nodes came too slowly
  host_lost = 4,  ///< the host is silent
  fault = 5,      ///< an axis stopped on its own and left the path
  probed = 6,     ///< the probe reached the state that the path looked for
  touched = 7,    ///< the probe made contact on a path that does not probe
};

/// push() adds nodes to a ring of `nodes`; prepare() makes the next few polynomials of them; both run in the
/// background. before_step() runs in the control interrupt. Functions for both contexts say so.
///
/// The clock runs at the override's rate. It stops for a hold, a stop, a silent host, and when the remaining nodes
/// might not last for a stop: then it stops in time to end on the path. Nodes at rest need no stop.
template <std::size_t axes, std::size_t nodes>
class PathFollower {
 public:
  static constexpr std::size_t kAxes = axes;
  static constexpr std::size_t kNodes = nodes;
  using Node = PathNode<axes>;

  // For the background, while the control interrupt is disabled.

  /// The axes of the mask are at rest; `start`: positions of their references. `limits` are above 0.
  constexpr void open(unsigned mask, const PathUnits& units, const std::array<CountPosition, axes>& start,
                      const std::array<PathLimits, axes>& limits) {
    mask_ = mask;
    units_ = units;
    limits_ = limits;
    for (std::size_t i = 0; i < axes; ++i) {
      // Nodes are on a grid; if the start lies between two of its points, the first sample moves to the grid.
      planned_[i] = start[i];
      const Increment offset = start[i].fraction & ((Increment{1} << (kFractionBits - units.travel_bits)) - 1);
      planned_[i].fraction -= offset;
      seen_[i] = static_cast<std::uint64_t>(offset);
      last_increment_[i] = 0;
    }
    start_ = start;
    float change = 1.0F, ramp = 1.0F;
    for (std::size_t i = 0; i < axes; ++i) {
      if (!is_led(i)) continue;
      const PathLimits& limit = limits[i];
      change = std::min(change, PathClock::change_limit(limit.velocity, limit.acceleration, limit.jerk));
      ramp = std::min(ramp, PathClock::ramp_limit(limit.velocity, limit.jerk));
    }
    clock_.configure(ScalarTraits<float>::to_increment(change), ScalarTraits<float>::to_increment(ramp));
    run_out_ = std::uint64_t{static_cast<std::uint32_t>(1.1F * change / ramp) + 9} * kShortestPiece;
    made_time_ = 0;
    near_ = kHeadrooms.size() - 1;
    ring_first_ = ring_count_ = 0;
    made_.store(0);
    used_.store(0);
    newest_ = {};
    accepted_ = passed_time_ = 0;
    slack_ = -((clock_.longest_stop() + 1) << kPathTimeBits);
    time_ = 0;
    ends_at_rest_ = true;
    note_slack();
    is_complete_ = is_held_ = is_settled_ = is_starved_ = false;
    end_ = PathEnd::none;
    phase_ = PathPhase::open;
  }

  /// False if there are no nodes to follow yet.
  constexpr bool start() {
    if (phase_ != PathPhase::open || accepted_ == 0) return false;
    phase_ = PathPhase::running;
    clock_.begin(is_ample() ? wanted_rate() : 0);
    return true;
  }

  /// Comes to rest on the path. A path that has not begun just ends.
  constexpr void stop(PathEnd why = PathEnd::asked) {
    if (phase_ == PathPhase::open) finish(why);
    if (phase_ != PathPhase::running) return;
    phase_ = PathPhase::stopping;
    end_ = why;
    is_settled_ = false;
  }

  constexpr void hold(bool held) {
    is_held_ = held;
    is_settled_ = false;
  }
  /// 0..kOneCount.
  constexpr void override_rate(Increment rate) {
    override_ = rate < 0 ? 0 : rate > kOneCount ? kOneCount : rate;
    is_settled_ = false;
  }

  /// Adds the next node; `last`: it is the final one. `is_inside(axis, counts)` says whether an axis may go there.
  template <typename IsInside>
  constexpr Refusal push(Node node, bool last, IsInside is_inside) {
    Step step;
    const Refusal refusal = examine(node, last, is_inside, step);
    return refusal != Refusal::none ? refusal : take(node, last, step);
  }

  // For the background, at any time.

  /// Position of a node, and the headroom that it leaves to the clock.
  struct Step {
    std::array<CountPosition, axes> there{};
    std::uint8_t headroom = 0;
  };

  /// Information for take() about a node, which must follow. A node states the headroom of its geometry, or less; the
  /// geometry decides.
  template <typename IsInside>
  constexpr Refusal examine(const Node& node, bool last, IsInside is_inside, Step& step) const {
    if ((phase_ != PathPhase::open && phase_ != PathPhase::running) || is_complete_) return Refusal::path_not_open;
    if (ring_count_ == nodes) return Refusal::path_full;
    if (node.duration < kShortestPiece || node.duration > kLongestPiece) return Refusal::path_too_fast;
    const auto piece = PathPiece<axes>::between(newest_, node, units_);
    if (!piece) return Refusal::path_too_fast;
    if (last && !node.is_at_rest()) return Refusal::path_ends_in_motion;
    const PathLoad<axes> load = path_load(*piece, mask_, limits_);
    constexpr float kRounding = 1.02F, kCorners = 1.05F;  // of words and of the points that are checked
    if (!(load.velocity < kRounding) || !(load.acceleration < kCorners)) return Refusal::path_too_fast;
    step.headroom = load.headroom();
    if (node.headroom_here > step.headroom + 1u) return Refusal::path_headroom;
    step.there = planned_;
    for (std::size_t i = 0; i < axes; ++i) {
      if (!is_led(i)) continue;
      const std::int64_t from = planned_[i].counts;
      step.there[i].counts += node.axis[i].travel >> units_.travel_bits;
      const std::int64_t part = node.axis[i].travel & ((std::int64_t{1} << units_.travel_bits) - 1);
      step.there[i].advance(part << (kFractionBits - units_.travel_bits));
      if (!is_inside(i, step.there[i].counts) || !is_inside(i, from + static_cast<std::int32_t>(load.least[i])) ||
          !is_inside(i, from + static_cast<std::int32_t>(load.most[i])))
        return Refusal::outside_travel;
    }
    return Refusal::none;
  }

  /// Call it while the control interrupt is disabled.
  constexpr Refusal take(Node node, bool last, const Step& step) {
    if (phase_ != PathPhase::open && phase_ != PathPhase::running) return Refusal::path_not_open;
    planned_ = step.there;
    newest_ = node.axis;
    // A third difference spans three samples, and some of them have begun.
    constexpr std::uint64_t kNear = 4 * kShortestPiece;
    const std::uint8_t here = std::min(step.headroom, near_);
    std::uint64_t between = 0;
    for (std::size_t k = ring_count_; k-- > 0 && between < run_out_;) {
      Node& before = ring_[(ring_first_ + k) % nodes];
      if (between < kNear && before.headroom_here > step.headroom) before.headroom_here = step.headroom & 15u;
      if (before.headroom_ahead > step.headroom) before.headroom_ahead = step.headroom & 15u;
      between += before.duration;
    }
    near_ = node.duration < kNear ? here : step.headroom;
    node.headroom_here = node.headroom_ahead = here & 15u;
    ring_[(ring_first_ + ring_count_) % nodes] = node;
    ++ring_count_;
    accepted_ += node.duration;
    slack_ += node.duration;
    ends_at_rest_ = node.is_at_rest();
    note_slack();
    is_complete_ = last;
    return Refusal::none;
  }

  /// Makes the next polynomials, for some tens of samples. Cheap if there is nothing to do. A node waits for those that
  /// determine its clock; one that is needed at once gets the smallest headroom ahead.
  constexpr void prepare() {
    while (ring_count_ > 0) {
      const std::uint32_t made = made_.load(std::memory_order_relaxed);
      if (made - used_.load(std::memory_order_acquire) == kPrepared) return;
      Node& node = ring_[ring_first_];
      const bool is_known = is_complete_ || accepted_ - made_time_ - node.duration >= run_out_;
      if (!is_known && made - used_.load(std::memory_order_acquire) >= 2) return;
      if (!is_known) node.headroom_ahead = 0;
      made_time_ += node.duration;
      pieces_[made % kPrepared] = *PathPiece<axes>::between(made == 0 ? Ends{} : prepared_to_, node, units_);
      prepared_to_ = node.axis;
      ring_first_ = (ring_first_ + 1) % nodes;
      --ring_count_;
      made_.store(made + 1, std::memory_order_release);
    }
  }

  constexpr std::size_t room() const { return nodes - ring_count_; }
  constexpr unsigned mask() const { return mask_; }
  constexpr bool is_led(std::size_t axis) const { return (mask_ >> axis & 1u) != 0; }
  constexpr bool is_open() const { return phase_ != PathPhase::idle && phase_ != PathPhase::done; }
  constexpr bool is_moving() const { return phase_ == PathPhase::running || phase_ == PathPhase::stopping; }
  constexpr PathPhase phase() const { return phase_; }
  constexpr PathEnd end() const { return end_; }
  constexpr bool is_held() const { return is_held_; }
  constexpr const std::array<CountPosition, axes>& start_position() const { return start_; }
  constexpr Increment rate() const { return clock_.rate(); }
  /// Path time in samples: from the start, and still to come.
  constexpr std::uint32_t elapsed() const {
    return static_cast<std::uint32_t>((passed_time_ >> kPathTimeBits) + (time_ >> kFractionBits));
  }
  constexpr std::uint32_t ahead() const { return static_cast<std::uint32_t>(time_ahead() >> kPathTimeBits); }
  constexpr std::uint32_t passed_nodes() const { return used_.load(); }

  // For the control interrupt.

  /// Call it before the axes' steps, while is_moving(): moves the axes of the mask. `group`: an AxisGroup.
  template <typename Group>
  constexpr void before_step(Group& group) {
    for (std::size_t i = 0; i < axes; ++i)
      if (is_led(i) && group[i].state() != SupervisorState::enabled) return leave(group);
    time_ += next_rate();
    const PathPiece<axes>* piece = find_piece();
    lead(group, piece);
    if (piece == nullptr && is_complete_ && passed_time_ == accepted_)
      finish(phase_ == PathPhase::stopping ? end_ : PathEnd::completed);
    else if (!is_settled_ && (phase_ == PathPhase::stopping || is_starved_) && clock_.stands())
      finish(phase_ == PathPhase::stopping ? end_ : PathEnd::starved);
  }

 private:
  using Ends = std::array<PathAxisNode, axes>;
  static constexpr std::uint32_t kPrepared = 8;
  static constexpr int kToIncrement = kFractionBits - path_piece::kBits;

  /// An axis leaves the path. The others are told in this step, and slow down from their present speed.
  template <typename Group>
  constexpr void leave(Group& group) {
    for (std::size_t i = 0; i < axes; ++i)
      if (is_led(i)) group[i].lead(last_increment_[i]);
    finish(PathEnd::fault);
  }

  constexpr void finish(PathEnd why) {
    end_ = why;
    phase_ = PathPhase::done;
    clock_.stand();
  }

  /// 2^-kPathTimeBits samples.
  constexpr std::int64_t time_ahead() const {
    return static_cast<std::int64_t>(accepted_ - passed_time_) - (time_ >> (kFractionBits - kPathTimeBits));
  }

  /// The nodes suffice for a stop from any rate.
  constexpr bool is_ample() const { return time_ < ample_until_; }
  constexpr void note_slack() {
    constexpr int kToTime = kFractionBits - kPathTimeBits;
    constexpr std::int64_t kMost = std::numeric_limits<Increment>::max() >> kToTime;
    const std::int64_t slack = slack_ < 0 ? 0 : slack_ + 1;
    ample_until_ = ends_at_rest_ || slack > kMost ? std::numeric_limits<Increment>::max() : slack << kToTime;
  }

  constexpr Increment next_rate() {
    return is_settled_ && is_ample() ? clock_.rate() : changing_rate();  // the former nearly always
  }
  [[gnu::noinline]] constexpr Increment changing_rate() {
    const Increment wanted = wanted_rate();
    // A stop that has begun continues until more nodes have come, so that the axes do not creep to the last node. A
    // full ring that is too short for a stop from the highest rate does not end the path.
    if (wanted == 0 || is_ample()) {
      is_starved_ = false;
    } else {
      const std::int64_t ahead = time_ahead() >> kPathTimeBits, way = clock_.way_of_stop();
      if (!is_starved_ && ahead <= way) {
        is_starved_ = true;
        starved_at_ = accepted_;
      } else if (is_starved_ && (accepted_ != starved_at_ || ring_count_ == nodes) && ahead > 2 * way) {
        is_starved_ = false;
      }
    }
    clock_.set_target(is_starved_ ? 0 : wanted);
    const std::uint32_t used = used_.load(std::memory_order_relaxed);
    const bool is_known = used != made_.load(std::memory_order_acquire);
    const PathPiece<axes>& piece = pieces_[used % kPrepared];
    const Increment rate = clock_.next(is_known ? piece.headroom_here() : 0, is_known ? piece.headroom_ahead() : 0);
    is_settled_ = clock_.is_steady() && rate == wanted && !(rate == 0 && phase_ == PathPhase::stopping);
    return rate;
  }

  constexpr Increment wanted_rate() const { return phase_ == PathPhase::stopping || is_held_ ? 0 : override_; }

  /// The piece that contains time_; none at the end of the available nodes.
  constexpr const PathPiece<axes>* find_piece() {
    const std::uint32_t made = made_.load(std::memory_order_acquire);
    std::uint32_t used = used_.load(std::memory_order_relaxed);
    // A piece lasts at least one sample, and the clock never runs faster: at most two pieces end.
    for (int k = 0; k < 3 && used != made; ++k) {
      const PathPiece<axes>& piece = pieces_[used % kPrepared];
      if (time_ < piece.duration()) return &piece;
      time_ -= piece.duration();
      const auto passed = piece.duration() >> (kFractionBits - kPathTimeBits);
      passed_time_ += static_cast<std::uint64_t>(passed);
      slack_ -= passed;
      note_slack();
      for (std::size_t i = 0; i < axes; ++i)
        seen_[i] -= static_cast<std::uint64_t>(piece.whole_travel(i)) << kToIncrement;
      used_.store(++used, std::memory_order_release);
    }
    time_ = 0;
    return nullptr;
  }

  template <typename Group>
  constexpr void lead(Group& group, const PathPiece<axes>* piece) {
    const std::uint32_t share = piece != nullptr ? piece->share(time_) : 0;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < axes; ++i) {
      if (!is_led(i)) continue;
      const std::int64_t travel = piece != nullptr ? piece->travel_at(i, share) : 0;
      const std::uint64_t here = static_cast<std::uint64_t>(travel) << kToIncrement;
      const auto increment = static_cast<Increment>(here - seen_[i]);
      seen_[i] = here;
      last_increment_[i] = increment;
      group[i].lead(increment);
    }
  }

  unsigned mask_ = 0;
  PathUnits units_{};
  PathPhase phase_ = PathPhase::idle;
  PathEnd end_ = PathEnd::none;
  bool is_complete_ = false;   ///< the last node has arrived
  bool ends_at_rest_ = false;  ///< the newest node is at rest
  bool is_held_ = false;
  bool is_starved_ = false;       ///< stops because the nodes might not last
  std::uint64_t starved_at_ = 0;  ///< time accepted when that began
  bool is_settled_ = false;       ///< the clock keeps its rate, which is the wanted one
  Increment override_ = kOneCount;
  PathClock clock_;
  std::uint64_t accepted_ = 0, passed_time_ = 0;  ///< 2^-kPathTimeBits samples
  Increment ample_until_ = 0;                     ///< time_ from which a stop might have to begin
  std::int64_t slack_ = 0;  ///< time in the piece until a stop might have to begin, 2^-kPathTimeBits samples
  Increment time_ = 0;      ///< in the piece, kOneCount a sample
  std::array<std::uint64_t, axes> seen_{};  ///< where the axes are in the piece, 2^-48 counts, modulo 2^64
  std::array<Increment, axes> last_increment_{};
  std::array<CountPosition, axes> start_{}, planned_{};
  Ends newest_{}, prepared_to_{};
  std::array<PathLimits, axes> limits_{};
  std::uint64_t run_out_ = 0;    ///< path time until a changing clock is steady again, 2^-kPathTimeBits samples
  std::uint64_t made_time_ = 0;  ///< path time of the nodes that are polynomials, 2^-kPathTimeBits samples
  std::uint8_t near_ = 0;        ///< headroom of the path just before the next node
  std::size_t ring_first_ = 0, ring_count_ = 0;
  std::atomic<std::uint32_t> made_ = 0, used_ = 0;  // pieces: the background writes made_, the interrupt used_
  std::array<PathPiece<axes>, kPrepared> pieces_{};
  std::array<Node, nodes> ring_{};
};

}  // namespace firmware
