// The touch probe while axes move: a probing motion ends at the probe's edge, and any other motion ends at an
// unexpected contact.
#pragma once

#include <algorithm>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/protocol/path_messages.hpp"
#include "firmware/core/path/path_follower.hpp"
#include "firmware/core/path/probe_watch.hpp"
#include "hal/encoder.hpp"

namespace firmware {

inline ProbeContact probe_contact(const ParameterValues& values) {
  return static_cast<ProbeContact>(values.get<"probe.input">());
}

/// Motions begin while the control interrupt is disabled; that interrupt calls watch(). `Group`: an AxisGroup on a
/// hal::Board.
template <typename Group, typename Board>
class ProbeService {
 public:
  static constexpr bool kIsThere = requires(Board & board) {
    board.probe();
    requires hal::LatchedEncoder<std::remove_reference_t<decltype(board.axis(0).encoder())>>;
  };

  ProbeService(Group& axes, Board& board) : axes_(axes), board_(board) {}

  /// A path begins. Returns false, without any change, if the probe is already in the state that the path looks for.
  bool begin([[maybe_unused]] ProbeContact contact, [[maybe_unused]] ProbeStop stop) {
    if constexpr (kIsThere) {
      std::int32_t samples = 0;
      for (std::size_t i = 0; i < Group::kAxes; ++i)
        samples = std::max(samples, axes_[i].parameters().monitors.input_samples);
      ProbeWatch watch;
      watch.configure(contact, stop, samples);
      if (watch.is_on() && !watch.begin(board_.probe())) return false;
      watch_ = watch;
      is_met_ = is_latched_ = false;
      is_watching_ = watch.is_on();
    }
    return true;
  }

  /// Any other motion begins. Returns false while axes still slow down after a contact.
  bool begin_motion(ProbeContact contact) {
    if (is_watching_) return true;
    return !(is_met_ && axes_.is_in_motion()) && begin(contact, ProbeStop::none);
  }

  bool is_watching() const { return is_watching_; }

  /// Call it before the axes' steps, while is_watching(): stops all motion on its path. If a path ends before the input
  /// has been in its state for long enough, the latch decides.
  template <typename Path>
  [[gnu::noinline, gnu::cold]] void watch(Path& path) {
    if constexpr (kIsThere) {
      auto& probe = board_.probe();
      const bool is_probing = watch_.is_probing(), path_moves = path.is_moving();
      const bool ends = !path_moves && (is_probing || !axes_.is_in_motion());
      const bool ends_there = ends && is_probing && probe.has_latched() && watch_.is_there(probe);
      const bool has_come = watch_.has_come(probe) || ends_there;
      is_watching_ = !has_come && !ends;
      if (ends && is_probing && !has_come) begin(watch_.contact(), ProbeStop::none);  // another axis may move on
      if (!has_come) return;
      note_place();
      if (path_moves) path.stop_at(is_probing ? PathEnd::probed : PathEnd::touched);
      for (std::size_t i = 0; i < Group::kAxes; ++i)
        if (axes_.is_in_motion(i) && !path.leads(i)) axes_[i].stop();
    }
  }

  /// `contact`: how the probe is wired now.
  ProbeStatePayload state([[maybe_unused]] ProbeContact contact) {
    ProbeStatePayload state;
    if constexpr (kIsThere) {
      const typename Board::ControlShutOut guard;
      const bool touches = board_.probe().is_closed() == (contact == ProbeContact::closes);
      if (contact != ProbeContact::none)
        state.flags = static_cast<std::uint8_t>(kProbeWired | (touches ? kProbeTouches : 0) |
                                                (is_met_ ? kProbeMet : 0) | (is_latched_ ? kProbeLatched : 0));
      for (std::size_t i = 0; i < Group::kAxes; ++i)
        state.axis[i] = {static_cast<std::uint32_t>(met_at_[i]), static_cast<std::int32_t>(met_at_[i] >> 32)};
    }
    return state;
  }

 private:
  void note_place() {
    is_met_ = true;
    is_latched_ = board_.probe().has_latched();
    for (std::size_t i = 0; i < Group::kAxes; ++i) {
      const hal::EncoderReading latched = axes_[i].hal().encoder().read_latch();
      is_latched_ = is_latched_ && latched.valid;
      met_at_[i] = axes_[i].table_counts_at(latched.counts);
    }
  }

  Group& axes_;
  Board& board_;
  ProbeWatch watch_;
  bool is_watching_ = false;
  bool is_met_ = false;                              ///< during the latest motion the probe reached the expected state
  bool is_latched_ = false;                          ///< the hardware latched the position
  std::array<std::int64_t, Group::kAxes> met_at_{};  ///< counts
};

}  // namespace firmware
