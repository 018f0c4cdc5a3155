#include "host/path/speed_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace host {

namespace {

constexpr double kRounding = 1.0 + 1e-9;
constexpr int kDeepest = 200;  ///< of the recursion: more than the levels of speed of any path

double ramp_time(double change, const TangentialLimits& l) {
  const double full = l.acceleration * l.acceleration / l.jerk;
  return change >= full ? change / l.acceleration + l.acceleration / l.jerk : 2.0 * std::sqrt(change / l.jerk);
}
double ramp_length(double from, double to, const TangentialLimits& l) {
  return (from + to) / 2.0 * ramp_time(std::abs(to - from), l);
}

void add_phase(std::vector<SpeedPhase>& phases, double duration_s, double jerk) {
  if (duration_s > 0.0) phases.push_back({duration_s, jerk});
}

void add_ramp(std::vector<SpeedPhase>& phases, double from, double to, const TangentialLimits& l) {
  const double change = std::abs(to - from), whole = ramp_time(change, l);
  const double peak = std::min(l.acceleration, std::sqrt(change * l.jerk));
  const double jerk_time = peak / l.jerk, jerk = std::copysign(l.jerk, to - from);
  add_phase(phases, jerk_time, jerk);
  add_phase(phases, whole - 2.0 * jerk_time, 0.0);
  add_phase(phases, jerk_time, -jerk);
}

/// A hump over a given length: up from one speed, cruise, and down to another speed.
struct Hump {
  double from = 0.0, top = 0.0, to = 0.0, length = 0.0;
  TangentialLimits rising, falling;

  double up() const { return ramp_length(from, top, rising); }
  double down() const { return ramp_length(top, to, falling); }
  bool fits() const { return up() + down() <= length * kRounding; }
  double cruise() const { return std::max(length - up() - down(), 0.0); }
  double time() const {
    const double level = cruise();
    return ramp_time(top - from, rising) + ramp_time(top - to, falling) + (level > 0.0 ? level / top : 0.0);
  }
};

class Profile {
 public:
  explicit Profile(std::span<const SpeedInterval> intervals) : all_(intervals) {}

  std::vector<SpeedPhase> take() {
    plan(all_.front().begin, 0.0, all_.back().end, 0.0, 0);
    return std::move(phases_);
  }

 private:
  std::span<const SpeedInterval> between(double begin, double end) const {
    const auto first = std::partition_point(all_.begin(), all_.end(), [&](const auto& i) { return i.end <= begin; });
    const auto last = std::partition_point(first, all_.end(), [&](const auto& i) { return i.begin < end; });
    return {first, last};
  }

  static void lessen(TangentialLimits& limits, const SpeedInterval& interval, double speed) {
    const TangentialLimits own = interval.limits(speed);
    limits.acceleration = std::min(limits.acceleration, own.acceleration);
    limits.jerk = std::min(limits.jerk, own.jerk);
  }
  static bool are_usable(const TangentialLimits& l) { return l.acceleration > 0.0 && l.jerk > 0.0; }

  /// The hump with this top speed; applies only the limits of the intervals that its ramps cover. Empty if a ramp is
  /// impossible.
  static std::optional<Hump> hump_to(double top, std::span<const SpeedInterval> region, double begin, double from,
                                     double end, double to) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    Hump hump{from, top, to, end - begin, {kNone, kNone}, {kNone, kNone}};
    if (!(top > from)) hump.rising = {1.0, 1.0};
    if (!(top > to)) hump.falling = {1.0, 1.0};
    for (const SpeedInterval& interval : region) {
      if (!(top > from)) break;
      lessen(hump.rising, interval, top);
      if (!are_usable(hump.rising)) return {};
      if (begin + hump.up() <= interval.end) break;
    }
    for (std::size_t i = region.size(); i-- > 0 && top > to;) {
      lessen(hump.falling, region[i], top);
      if (!are_usable(hump.falling)) return {};
      if (end - hump.down() >= region[i].begin) break;
    }
    return hump;
  }

  /// The hump with the highest top speed, at most `most`, that fits the length; empty if the length is too short for
  /// the change of speed.
  static std::optional<Hump> hump(std::span<const SpeedInterval> region, double begin, double from, double end,
                                  double to, double most) {
    auto found = hump_to(most, region, begin, from, end, to);
    if (found && found->fits()) return found;
    double low = std::max(from, to), high = most;
    found = hump_to(low, region, begin, from, end, to);
    if (!found || !found->fits()) return {};
    for (int k = 0; k < 100 && high - low > 1e-12 * high; ++k) {
      const double middle = (low + high) / 2.0;
      const auto tried = hump_to(middle, region, begin, from, end, to);
      const bool fits = tried && tried->fits();
      if (fits) found = tried;
      (fits ? low : high) = middle;
    }
    return found;
  }

  /// Tries several top speeds and returns the quickest hump, because a higher speed on a curve leaves less acceleration
  /// for the ramps.
  static std::optional<Hump> quickest(std::span<const SpeedInterval> region, double begin, double from, double end,
                                      double to, double most) {
    std::optional<Hump> best;
    const double least_top = std::max(from, to);
    for (const double share : {1.0, 0.99, 0.97, 0.94, 0.9, 0.84, 0.76, 0.66, 0.54, 0.4}) {
      const double top = std::max(most * share, least_top);
      const auto tried = hump(region, begin, from, end, to, top);
      if (tried && (!best || tried->time() < best->time() * (1.0 - 1e-9))) best = tried;
      if (top == least_top) break;
    }
    return best;
  }

  /// Plans a region. The speeds at both ends are allowed throughout, and one can be reached from the other.
  void plan(double begin, double from, double end, double to, int depth) {
    if (!(end > begin)) return;
    const auto region = between(begin, end);
    double most = std::numeric_limits<double>::infinity();
    for (const SpeedInterval& interval : region) most = std::min(most, interval.speed);
    most = std::max({most, from, to});
    const auto found = quickest(region, begin, from, end, to, most);
    if (!found) return keep(begin, from, end, to, region, most);
    const double cruise_begin = begin + found->up(), cruise_end = end - found->down();
    const double top = found->top;
    if (!(cruise_end > cruise_begin) || depth == kDeepest) return add(*found);
    const double binding = top * 1.005;
    // Separates the parts of the cruise that may be faster from those that may not.
    double first_bound = end, last_bound = begin;
    for (const SpeedInterval& interval : region) {
      if (interval.speed > binding || interval.end <= cruise_begin || interval.begin >= cruise_end) continue;
      first_bound = std::min(first_bound, std::max(interval.begin, begin));
      last_bound = std::max(last_bound, std::min(interval.end, end));
    }
    if (first_bound >= last_bound) return climb(*found, begin, end, depth);
    const bool has_own_begin = first_bound >= cruise_begin && first_bound > begin;
    if (has_own_begin)
      plan(begin, from, first_bound, top, depth + 1);
    else
      add_ramp(phases_, from, top, found->rising);
    const double level_begin = has_own_begin ? first_bound : cruise_begin;
    const bool has_own_end = last_bound <= cruise_end && last_bound < end;
    const double level_end = has_own_end ? last_bound : cruise_end;
    level(region, level_begin, level_end, top, binding, depth);
    if (has_own_end)
      plan(last_bound, top, end, to, depth + 1);
    else
      add_ramp(phases_, top, to, found->falling);
  }

  /// Plans the cruise from the first limiting part to the last; it may be faster in between.
  void level(std::span<const SpeedInterval> region, double begin, double end, double top, double binding, int depth) {
    double here = begin;
    for (const SpeedInterval& interval : region) {
      if (interval.speed > binding || interval.end <= here || interval.begin >= end) continue;
      if (interval.begin > here) plan(here, top, interval.begin, top, depth + 1);
      const double next = std::min(interval.end, end);
      const double from = std::max(interval.begin, here);
      if (next > from) add_phase(phases_, (next - from) / top, 0.0);
      here = next;
    }
    if (here < end) plan(here, top, end, top, depth + 1);
  }

  /// No limit applies at this top speed, which was chosen for its acceleration. Tries another, smaller rise of speed in
  /// between if that saves time.
  void climb(const Hump& found, double begin, double end, int depth) {
    const double cruise_begin = begin + found.up(), cruise_end = end - found.down();
    const auto region = between(cruise_begin, cruise_end);
    double most = std::numeric_limits<double>::infinity();
    for (const SpeedInterval& interval : region) most = std::min(most, interval.speed);
    const auto next = quickest(region, cruise_begin, found.top, cruise_end, found.top, most);
    if (!next || next->top < found.top * 1.005) return add(found);
    add_ramp(phases_, found.from, found.top, found.rising);
    plan(cruise_begin, found.top, cruise_end, found.top, depth + 1);
    add_ramp(phases_, found.top, found.to, found.falling);
  }

  /// Keeps at most the higher of both speeds, because they were reached with other limits than those at a higher speed.
  void keep(double begin, double from, double end, double to, std::span<const SpeedInterval> region, double most) {
    const double top = std::max(from, to);
    if (const auto found = hump(region, begin, from, end, to, std::min(most, top))) return add(*found);
    // The same as in the ramp of the previous level.
    const double time = 2.0 * (end - begin) / (from + to);
    const double jerk = 4.0 * (to - from) / (time * time);
    add_phase(phases_, time / 2.0, jerk);
    add_phase(phases_, time / 2.0, -jerk);
  }

  void add(const Hump& h) {
    add_ramp(phases_, h.from, h.top, h.rising);
    if (h.cruise() > 0.0) add_phase(phases_, h.cruise() / h.top, 0.0);
    add_ramp(phases_, h.top, h.to, h.falling);
  }

  std::span<const SpeedInterval> all_;
  std::vector<SpeedPhase> phases_;
};

}  // namespace

SpeedState after(const SpeedState& state, double time_s, double jerk) {
  return {state.length + time_s * (state.speed + time_s * (state.acceleration / 2.0 + time_s * jerk / 6.0)),
          state.speed + time_s * (state.acceleration + time_s * jerk / 2.0), state.acceleration + time_s * jerk};
}

std::vector<SpeedPhase> speed_profile(const std::vector<SpeedInterval>& intervals) { return Profile(intervals).take(); }

}  // namespace host
