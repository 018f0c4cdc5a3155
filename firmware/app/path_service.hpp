// Carries out the host's requests for paths.
#pragma once

#include <cstring>
#include <span>

#include "firmware/app/motion_owner.hpp"
#include "firmware/app/probe_service.hpp"
#include "firmware/app/protocol/path_messages.hpp"
#include "firmware/app/refusal_status.hpp"
#include "firmware/core/axis_check.hpp"
#include "firmware/core/path/path_follower.hpp"

namespace firmware {

/// `Group`: an AxisGroup on a hal::Board.
template <typename Group, typename Board>
class PathService {
 public:
  using ShutOut = typename Board::ControlShutOut;
  static constexpr std::size_t kAxes = Group::kAxes;
  /// 2 s of path if a piece lasts 5 ms on average.
  static constexpr std::size_t kNodes = 400;

  using Probe = ProbeService<Group, Board>;
  PathService(Group& axes, Probe& probe) : axes_(axes), probe_(probe) {}

  bool is_moving() const { return follower_.is_moving(); }
  bool is_open() const { return follower_.is_open(); }
  /// Nodes, start and rate are accepted only from the client that opened the path, or took it over in motion.
  bool is_others(ClientToken client) const { return is_open() && client != client_; }
  void take_over(ClientToken client) {
    if (is_moving()) client_ = client;
  }
  bool leads(std::size_t axis) const { return follower_.is_open() && follower_.is_led(axis); }

  /// The axes of the mask must be enabled and at rest. `contact`: how the probe is wired.
  Status open(const OpenPathRequest& request, ClientToken client, ProbeContact contact, OpenPathPayload& opened) {
    if (request.node_format != kPathNodeFormat) return Status::wrong_version;
    if (request.mask == 0 || request.mask >> kAxes != 0 || request.relative > 1 || !is_possible(request.units) ||
        request.probe > ProbeStop::release)
      return Status::malformed;
    if (request.probe != ProbeStop::none && (!Probe::kIsThere || contact == ProbeContact::none))
      return Status::no_probe;
    std::array<CountPosition, kAxes> start{};
    std::array<PathLimits, kAxes> limits_of_axes{};
    const ShutOut guard;
    if (is_moving()) return Status::wrong_state;
    for (std::size_t i = 0; i < kAxes; ++i) {
      if ((request.mask >> i & 1u) == 0) continue;
      if (request.relative == 0 && !axes_[i].is_homed()) return Status::not_homed;
      start[i] = axes_[i].leading();
      const MotionLimits limits = motion_limits(axes_[i].parameters());
      using Traits = ScalarTraits<float>;
      limits_of_axes[i] = {Traits::from_increment(limits.velocity), Traits::from_increment(limits.acceleration),
                           Traits::from_increment(limits.jerk)};
    }
    follower_.open(request.mask, request.units, start, limits_of_axes);
    is_held_for_process_ = false;
    contact_ = contact;
    probe_stop_ = request.probe;
    for (std::size_t i = 0; i < kAxes; ++i)
      opened.axis[i] = {static_cast<std::uint32_t>(start[i].counts), static_cast<std::int32_t>(start[i].counts >> 32),
                        static_cast<std::uint32_t>(start[i].fraction >> (kFractionBits - 32))};
    opened.room = kNodes;
    client_ = client;
    return Status::ok;
  }

  /// Takes whole nodes in the format of the report; nodes before a refused one are kept.
  Status push(std::span<const std::byte> bytes) {
    if (!follower_.is_open()) return Status::wrong_state;
    const std::size_t size = path_node_size(static_cast<std::size_t>(std::popcount(follower_.mask())));
    if (bytes.empty() || bytes.size() % size != 0) return Status::malformed;
    const auto is_inside = [this](std::size_t axis, std::int64_t counts) { return axes_[axis].may_reach(counts); };
    for (; !bytes.empty(); bytes = bytes.subspan(size)) {
      bool is_last = false;
      const Node node = node_of(bytes.first(size), is_last);
      typename Follower::Step step;
      const Refusal refusal = follower_.examine(node, is_last, is_inside, step);
      if (refusal != Refusal::none) return status_of(refusal);
      const ShutOut guard;
      const Status taken = status_of(follower_.take(node, is_last, step));
      if (taken != Status::ok) return taken;
    }
    return Status::ok;
  }

  /// The axes must still be where the path begins.
  Status start() {
    const ShutOut guard;
    for (std::size_t i = 0; i < kAxes; ++i)
      if (follower_.is_led(i) &&
          (axes_[i].state() != SupervisorState::enabled || !(axes_[i].leading() == follower_.start_position()[i])))
        return Status::wrong_state;
    if (!probe_.begin(contact_, probe_stop_)) return Status::probe_already;
    if (!follower_.start()) return Status::wrong_state;
    axes_.board().host_commands(true);
    return Status::ok;
  }

  void stop() {
    const ShutOut guard;
    follower_.stop();
  }
  void stop_at(PathEnd end) { follower_.stop(end); }  ///< in the control interrupt

  Status set_rate(const PathRateRequest& request) {
    if (request.permille > 1000 || request.held > 1) return Status::malformed;
    const ShutOut guard;
    if (!follower_.is_open()) return Status::wrong_state;
    follower_.hold(request.held != 0);
    if (request.held == 0) is_held_for_process_ = false;
    follower_.override_rate(request.permille == 1000 ? kOneCount : kOneCount / 1000 * request.permille);
    return Status::ok;
  }

  /// Holds the feed until set_rate() releases it. For the background.
  void hold_for_process() {
    const ShutOut guard;
    if (!is_moving()) return;
    follower_.hold(true);
    is_held_for_process_ = true;
  }

  PathStatePayload state() const {
    const ShutOut guard;
    PathStatePayload state;
    state.phase = static_cast<std::uint8_t>(follower_.phase());
    state.end = static_cast<std::uint8_t>(follower_.end());
    state.mask = static_cast<std::uint8_t>(follower_.mask());
    state.held = !follower_.is_held() ? 0 : is_held_for_process_ ? kHeldForProcess : 1;
    state.elapsed = follower_.elapsed();
    state.ahead = follower_.ahead();
    state.passed_nodes = follower_.passed_nodes();
    state.room = static_cast<std::uint16_t>(follower_.room());
    state.permille = static_cast<std::uint16_t>((follower_.rate() * 1000 + kOneCount / 2) >> kFractionBits);
    return state;
  }

  /// True if the axis is on its path: then all axes stop on the path, and this one is disabled afterwards. A path that
  /// has not begun ends.
  bool disables_at_end(std::size_t axis) {
    const ShutOut guard;
    if (!leads(axis)) return false;
    const bool is_on_its_way = is_moving();
    follower_.stop();
    if (!is_on_its_way) return false;
    disabled_at_end_ |= 1u << axis;
    return true;
  }

  /// Work of the background, once a round.
  void poll() {
    if (follower_.is_open()) follower_.prepare();
    if (follower_.phase() == PathPhase::open) end_without_axes();
    if (disabled_at_end_ == 0 || is_moving()) return;
    const ShutOut guard;
    for (std::size_t i = 0; i < kAxes; ++i)
      if ((disabled_at_end_ >> i & 1u) != 0) axes_[i].disable();
    disabled_at_end_ = 0;
  }

  /// Call it in the control interrupt, before the axes' steps, while is_moving().
  [[gnu::noinline]] void before_step() {
    if (axes_.board().is_host_lost()) follower_.stop(PathEnd::host_lost);
    follower_.before_step(axes_);
    axes_.board().excuse_silence(is_moving());
  }

 private:
  /// Nodes that were loaded for enabled axes are discarded when their enables drop.
  void end_without_axes() {
    const ShutOut guard;
    for (std::size_t i = 0; i < kAxes; ++i)
      if (follower_.is_led(i) && axes_[i].state() != SupervisorState::enabled) follower_.stop(PathEnd::fault);
  }

  using Follower = PathFollower<kAxes, kNodes>;
  using Node = typename Follower::Node;

  Node node_of(std::span<const std::byte> bytes, bool& is_last) const {
    const auto word = [&bytes](std::size_t place) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + 4 * place, sizeof value);
      return value;
    };
    Node node;
    is_last = (word(0) & kLastNode) != 0;
    node.set_time(word(0));
    std::size_t place = 1;
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (!follower_.is_led(i)) continue;
      node.axis[i] = {static_cast<std::int32_t>(word(place)), static_cast<std::int32_t>(word(place + 1)),
                      static_cast<std::int32_t>(word(place + 2))};
      place += 3;
    }
    return node;
  }

  Group& axes_;
  Probe& probe_;
  Follower follower_;
  ProbeContact contact_ = ProbeContact::none;
  ProbeStop probe_stop_ = ProbeStop::none;
  bool is_held_for_process_ = false;
  unsigned disabled_at_end_ = 0;  ///< axes
  ClientToken client_ = 0;
};

}  // namespace firmware
