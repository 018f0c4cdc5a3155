#include "host/axes/circle_signatures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include "host/statistics.hpp"

namespace host {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kRowsAPass = 800;
constexpr double kUsual_um = 10.0;  ///< prior standard deviation of a cause
constexpr double kLeastNoise_um = 0.02;
constexpr double kLeastLagAngle = 0.02;  ///< rad: below it, lag and delay have the same effect on the circle
constexpr double kFirstKnot_s = 0.003, kKnotRatio = 1.6, kSpikeForms = 12.0;
constexpr int kSpikeKnots = 7;
/// Boundary lubrication, in which an axis sticks, lies below it: the paper's jogs at 0.1, 0.3 and 0.5 mm/s (p. 1504).
constexpr double kStickSlip_mm_s = 0.5;

constexpr int kLoopPowers = 5;

double sign(double value) { return value < 0.0 ? -1.0 : 1.0; }

/// Angle since the axis reversed at its positive end, 0 to 2 pi; at pi it reverses at the other end.
double since_positive_end(const CirclePass& pass, std::size_t k, char axis) {
  const double end = axis == 'x' ? 0.0 : kPi / 2.0;
  const double angle = std::fmod(pass.direction() * (pass.angle_rad[k] - end), 2.0 * kPi);
  return angle < 0.0 ? angle + 2.0 * kPi : angle;
}

/// Radial component of an error along an axis.
double radial_part(const CirclePass& pass, std::size_t k, char axis) {
  return axis == 'x' ? std::cos(pass.angle_rad[k]) : std::sin(pass.angle_rad[k]);
}

/// Sign of an axis' speed: +1 towards its positive end.
double moving(const CirclePass& pass, std::size_t k, char axis) {
  return axis == 'x' ? -pass.direction() * sign(std::sin(pass.angle_rad[k]))
                     : pass.direction() * sign(std::cos(pass.angle_rad[k]));
}

double most(const std::vector<CirclePass>& passes, double (*value)(const CirclePass&)) {
  double largest = 0.0;
  for (const CirclePass& pass : passes) largest = std::max(largest, value(pass));
  return largest;
}
double feed_of(const CirclePass& pass) { return pass.feed_mm_s; }
double radius_of(const CirclePass& pass) { return pass.radius_mm; }
double acceleration_of(const CirclePass& pass) { return pass.feed_mm_s * pass.turn_rad_s(); }
double lag_angle_of(const CirclePass& pass) { return std::abs(pass.lag_s) * pass.turn_rad_s(); }

bool has_both_directions(const std::vector<CirclePass>& passes) {
  return std::ranges::any_of(passes, [](const CirclePass& one) { return one.is_ccw; }) &&
         std::ranges::any_of(passes, [](const CirclePass& one) { return !one.is_ccw; });
}

CircleCause cause(const CircleRows& rows, const char* kind, const std::string& axis,
                  const std::vector<CircleRows::Signature>& signatures, bool outer_only, double log_prior = 0.0) {
  const auto count = static_cast<Eigen::Index>(signatures.size());
  CircleCause made{kind,
                   axis,
                   signatures,
                   outer_only,
                   Eigen::MatrixXd(rows.deviation().size(), count),
                   Eigen::VectorXd::Constant(count, kUsual_um),
                   log_prior,
                   {},
                   {}};
  for (Eigen::Index c = 0; c < count; ++c)
    made.columns.col(c) = rows.column(signatures[static_cast<std::size_t>(c)], outer_only);
  return made;
}

CircleCause with_amount(CircleCause made, double per_um, const char* unit) {
  made.amount_per_um = per_um;
  made.amount_unit = unit;
  return made;
}

/// Feeds that differ by more than the variation within a pass.
std::vector<double> feeds_of(const std::vector<CirclePass>& passes) {
  std::vector<double> feeds;
  for (const CirclePass& pass : passes)
    if (std::ranges::none_of(feeds, [&](double one) { return std::abs(one - pass.feed_mm_s) < 0.05 * one; }))
      feeds.push_back(pass.feed_mm_s);
  return feeds;
}

using SpikeForm = std::function<double(double)>;

/// A spike of lag after each reversal of the axis, with separate factors for each feed, and for each end if `by_end`.
/// `forms`: its shapes over the time since the reversal, for passes whose rows last so long.
CircleCause spike(const CircleRows& rows, char axis, const std::function<std::vector<SpikeForm>(double row_s)>& forms,
                  bool by_end) {
  std::vector<CircleRows::Signature> signatures;
  for (const double feed : feeds_of(rows.passes())) {
    const auto is_of_feed = [=](const CirclePass& pass) { return std::abs(pass.feed_mm_s - feed) <= 0.05 * feed; };
    double row_s = 0.0;
    for (std::size_t i = 0; i < rows.passes().size(); ++i)
      if (is_of_feed(rows.passes()[i])) row_s = std::max(row_s, rows.row_s(i));
    for (const int end : by_end ? std::vector<int>{1, -1} : std::vector<int>{0})
      for (const SpikeForm& form : forms(row_s))
        signatures.emplace_back([=](const CirclePass& pass, std::size_t k) {
          const double since = since_positive_end(pass, k, axis);
          if (!is_of_feed(pass) || (end != 0 && (since < kPi) != (end > 0))) return 0.0;
          return form(std::fmod(since, kPi) / pass.turn_rad_s()) * std::abs(radial_part(pass, k, axis));
        });
  }
  return cause(rows, "reversal_spike", {axis}, signatures, false, -std::log(kSpikeForms));
}

/// Straight lines between times at least one row apart: the rows of a slow pass do not show what lies between them.
std::vector<SpikeForm> hats_over(double row_s) {
  std::vector<SpikeForm> hats;
  double before = 0.0, at = std::max(kFirstKnot_s, row_s);
  for (int knot = 0; knot < kSpikeKnots; ++knot) {
    const double after = kKnotRatio * at;
    hats.emplace_back(
        [=](double t) { return std::max(0.0, std::min((t - before) / (at - before), (after - t) / (after - at))); });
    before = at;
    at = after;
  }
  return hats;
}

/// Rests between which an axis jumps; nothing if it does not. Factors: the breakaway lag, um, its fall with the speed,
/// and the part of the circle's way that is missing while the axis rests.
std::optional<CircleCause> sticking(const CircleRows& rows, char axis) {
  const std::size_t at = axis == 'x' ? 0 : 1;
  if (std::ranges::none_of(rows.passes(), [=](const CirclePass& pass) { return pass.rests[at].jumps; }))
    return std::nullopt;
  const auto signature = [=](std::vector<double> AxisRests::*list, double factor) -> CircleRows::Signature {
    return [=](const CirclePass& pass, std::size_t k) {
      const std::vector<double>& values = pass.rests[at].*list;
      return values.empty() ? 0.0 : factor * values[k] * radial_part(pass, k, axis);
    };
  };
  CircleCause made = cause(rows, "stick_slip", {axis},
                           {signature(&AxisRests::level, -1.0), signature(&AxisRests::level_by_speed, 1.0),
                            signature(&AxisRests::ahead_um, 1.0)},
                           false);
  made.deviations(2) = 1.0;
  return made;
}

/// The same with spikes of lag in the passes in which the axis does not stick, by the same friction.
CircleCause with_spikes(const CircleRows& rows, CircleCause sticks, const CircleCause& spikes) {
  const std::size_t at = sticks.axis == "x" ? 0 : 1;
  Eigen::MatrixXd columns(sticks.columns.rows(), sticks.columns.cols() + spikes.columns.cols());
  columns << sticks.columns, spikes.columns;
  for (const CircleBlock& block : rows.blocks())
    if (rows.passes()[block.pass].rests[at].jumps)
      columns.block(block.first, sticks.columns.cols(), block.end - block.first, spikes.columns.cols()).setZero();
  Eigen::VectorXd deviations(columns.cols());
  deviations << sticks.deviations, spikes.deviations;
  for (const CircleRows::Signature& one : spikes.signatures)
    sticks.signatures.emplace_back(
        [=](const CirclePass& pass, std::size_t k) { return pass.rests[at].jumps ? 0.0 : one(pass, k); });
  sticks.columns = columns;
  sticks.deviations = deviations;
  sticks.log_prior += spikes.log_prior;
  return sticks;
}

/// Adds spikes with two shapes: a rise with exponential decay, and straight lines; and stick-slip with them.
void add_spikes(const CircleRows& rows, char axis, std::vector<CircleCause>& list) {
  const std::size_t begin = list.size();
  for (const bool by_end : {false, true}) {
    for (const double decay_s : {0.004, 0.007, 0.012, 0.02, 0.035}) {
      const SpikeForm rise = [=](double t) { return t / decay_s * std::exp(1.0 - t / decay_s); };
      list.push_back(spike(
          rows, axis, [=](double) { return std::vector{rise}; }, by_end));
    }
    list.push_back(spike(rows, axis, hats_over, by_end));
  }
  if (const auto sticks = sticking(rows, axis))
    for (std::size_t i = begin, end = list.size(); i < end; ++i) list.push_back(with_spikes(rows, *sticks, list[i]));
}

/// Adds differences between the axes' loops. A lag reduces the radius, a delay does not.
void add_servo(const CircleRows& rows, std::vector<CircleCause>& list) {
  const double feed = most(rows.passes(), feed_of), acceleration = most(rows.passes(), acceleration_of);
  const auto late = [=](const CirclePass& pass, std::size_t k) {
    return 0.5 * pass.feed_mm_s / feed * pass.direction() * std::sin(2.0 * pass.angle_rad[k]);
  };
  const auto lag = [=](const CirclePass& pass, std::size_t k) {
    return late(pass, k) -
           0.5 * pass.feed_mm_s / feed * pass.lag_s * pass.turn_rad_s() * std::cos(2.0 * pass.angle_rad[k]);
  };
  const auto gain = [=](const CirclePass& pass, std::size_t k) {
    return 0.5 * acceleration_of(pass) / acceleration * std::cos(2.0 * pass.angle_rad[k]);
  };
  const double ms_per_um = 1.0 / feed;
  list.push_back(with_amount(cause(rows, "servo_mismatch", "xy", {lag}, false), ms_per_um, "ms"));
  list.push_back(with_amount(cause(rows, "servo_mismatch", "xy", {late, gain}, false), ms_per_um, "ms"));
  if (most(rows.passes(), lag_angle_of) > kLeastLagAngle)
    list.push_back(
        with_amount(cause(rows, "delay_between_axes", "xy", {late}, false, -std::log(9.0)), ms_per_um, "ms"));
}

/// Where the table is within a gap about the motor, as the encoder shows the motor's way: -0.5 to 0.5 of the gap.
std::vector<double> seats_in_gap(const CirclePass& pass, char axis, double gap_um) {
  std::vector<double> seats;
  double seat_um = 0.0;
  for (std::size_t k = 0; k < pass.t_s.size(); ++k) {
    const double motor_um = (1e3 * pass.radius_mm + pass.encoder_um[k]) * radial_part(pass, k, axis);
    if (k == 0) seat_um = motor_um - 0.5 * gap_um * moving(pass, k, axis);
    seat_um = std::clamp(seat_um, motor_um - 0.5 * gap_um, motor_um + 0.5 * gap_um);
    seats.push_back((seat_um - motor_um) / gap_um);
  }
  return seats;
}

/// Adds causes that only a sensor at the table shows.
void add_geometry(const CircleRows& rows, std::vector<CircleCause>& list) {
  const double radius = most(rows.passes(), radius_of);
  const auto outer = [&](const char* kind, const std::string& axis, const CircleRows::Signature& signature) {
    return cause(rows, kind, axis, {signature}, true);
  };
  const auto twice = [=](double (*wave)(double)) {
    return [=](const CirclePass& pass, std::size_t k) {
      return 0.5 * pass.radius_mm / radius * wave(2.0 * pass.angle_rad[k]);
    };
  };
  list.push_back(
      with_amount(outer("squareness", "xy", twice([](double a) { return std::sin(a); })), 1e3 / radius, "um/m"));
  list.push_back(
      with_amount(outer("scale_mismatch", "xy", twice([](double a) { return std::cos(a); })), 1e3 / radius, "ppm"));
  // Equal to squareness at one feed; both axes' coupling gives one circle. As likely as a delay between the axes.
  const double acceleration_mm_s2 = most(rows.passes(), acceleration_of);
  CircleCause coupling = outer("coupling", "xy", [=](const CirclePass& pass, std::size_t k) {
    return -0.5 * acceleration_of(pass) / acceleration_mm_s2 * std::sin(2.0 * pass.angle_rad[k]);
  });
  coupling.log_prior = -std::log(9.0);
  list.push_back(with_amount(coupling, 1e3 / acceleration_mm_s2, "um/(m/s2)"));
  for (const char axis : {'x', 'y'}) {
    const std::string name{axis};
    list.push_back(backlash_cause(rows, axis, kUsual_um));
    const char other = axis == 'x' ? 'y' : 'x';
    list.push_back(outer("straightness", name, [=](const CirclePass& pass, std::size_t k) {
      return std::pow(radial_part(pass, k, axis), 2) * radial_part(pass, k, other);
    }));
    if (has_both_directions(rows.passes()))
      list.push_back(outer("lateral_play", name, [=](const CirclePass& pass, std::size_t k) {
        return 0.5 * moving(pass, k, axis) * radial_part(pass, k, other);
      }));
  }
}

}  // namespace

CircleRows::CircleRows(const std::vector<CirclePass>& passes) : passes_(passes) {
  row_s_ = HUGE_VAL;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const std::size_t samples = std::max<std::size_t>(1, (passes[i].t_s.size() + kRowsAPass - 1) / kRowsAPass);
    samples_a_row_.push_back(samples);
    row_s_ = std::min(row_s_, static_cast<double>(samples) * passes[i].period_s);
    add(i, false);
    if (!passes[i].outer_um.empty()) add(i, true);
  }
}

void CircleRows::add(std::size_t at, bool is_outer) {
  const CirclePass& pass = passes_[at];
  const auto samples = samples_a_row_[at];
  const auto count = static_cast<Eigen::Index>(pass.t_s.size() / samples), first = deviation_.size();
  CircleBlock block{at, is_outer, first, first + count, 1.0};
  has_outer_ = has_outer_ || is_outer;
  const std::vector<double>& values = is_outer ? pass.outer_um : pass.encoder_um;
  const Eigen::VectorXd mean = block_column([&](const CirclePass&, std::size_t k) { return values[k]; }, block);
  block.weight = 1.0 / std::max(noise_of(mean), kLeastNoise_um);
  blocks_.push_back(block);
  for (Eigen::VectorXd* list : {&deviation_, &weights_, &angle_, &time_}) list->conservativeResize(block.end);
  deviation_.segment(first, count) = block.weight * mean;
  weights_.segment(first, count).setConstant(block.weight);
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::size_t middle = static_cast<std::size_t>(row) * samples + samples / 2;
    angle_(first + row) = pass.angle_rad[middle];
    time_(first + row) = pass.t_s[middle];
  }
}

Eigen::VectorXd CircleRows::block_column(const Signature& signature, const CircleBlock& block) const {
  const CirclePass& pass = passes_[block.pass];
  const std::size_t samples = samples_a_row_[block.pass];
  Eigen::VectorXd values(block.end - block.first);
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    double sum = 0.0;
    for (std::size_t k = 0; k < samples; ++k) sum += signature(pass, static_cast<std::size_t>(row) * samples + k);
    values(row) = block.weight * sum / static_cast<double>(samples);
  }
  return values;
}

Eigen::VectorXd CircleRows::column(const Signature& signature, bool outer_only) const {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(deviation_.size());
  for (const CircleBlock& block : blocks_)
    if (block.is_outer || !outer_only)
      values.segment(block.first, block.end - block.first) = block_column(signature, block);
  return values;
}

std::vector<CircleCause> plain_causes(const CircleRows& rows) {
  std::vector<CircleCause> list;
  add_servo(rows, list);
  for (const char axis : {'x', 'y'}) add_spikes(rows, axis, list);
  if (rows.has_outer()) add_geometry(rows, list);
  return list;
}

CircleCause backlash_cause(const CircleRows& rows, char axis, double gap_um) {
  auto seats = std::make_shared<std::vector<std::vector<double>>>();
  for (const CirclePass& pass : rows.passes()) seats->push_back(seats_in_gap(pass, axis, gap_um));
  const CircleRows::Signature signature = [axis, seats, first = rows.passes().data()](const CirclePass& pass,
                                                                                      std::size_t k) {
    return (*seats)[static_cast<std::size_t>(&pass - first)][k] * radial_part(pass, k, axis);
  };
  return cause(rows, "backlash", {axis}, {signature}, true);
}

bool shows_through(double frequency_Hz, double row_s) {
  constexpr double kLeast = 0.2;
  const double half = kPi * frequency_Hz * row_s;
  return std::abs(std::sin(half)) > kLeast * half;
}

CircleCause wave_cause(const CircleRows& rows, WaveKind kind, char axis, double value) {
  constexpr double kPlaces = 200.0;  // number of distinguishable periods or frequencies within a circle
  using Wave = double (*)(double);
  const Wave waves[] = {[](double a) { return std::cos(a); }, [](double a) { return std::sin(a); }};
  std::vector<CircleRows::Signature> signatures;
  if (kind == WaveKind::vibration) {
    for (std::size_t i = 0; i < rows.passes().size(); ++i)
      for (const Wave wave : waves)
        signatures.emplace_back([=, own = &rows.passes()[i]](const CirclePass& pass, std::size_t k) {
          return &pass == own ? wave(2.0 * kPi * pass.t_s[k] * value) * radial_part(pass, k, axis) : 0.0;
        });
  } else {
    // The loop's response to a torque, as a series in j times the frequency, which is proportional to the axis's speed.
    const double top = most(rows.passes(), feed_of);
    for (int power = 0; power < (kind == WaveKind::torque_ripple ? kLoopPowers : 1); ++power)
      for (const Wave wave : waves)
        signatures.emplace_back([=](const CirclePass& pass, std::size_t k) {
          const double along = radial_part(pass, k, axis);
          const double speed =
              moving(pass, k, axis) * pass.feed_mm_s / top * std::sqrt(std::max(0.0, 1.0 - along * along));
          return std::pow(speed, power) * wave(2.0 * kPi * pass.radius_mm * along / value) * along;
        });
  }
  const char* name = kind == WaveKind::cyclic_error    ? "cyclic_error"
                     : kind == WaveKind::torque_ripple ? "torque_ripple"
                                                       : "vibration";
  CircleCause made = cause(rows, name, {axis}, signatures, kind == WaveKind::cyclic_error, -std::log(kPlaces));
  (kind == WaveKind::vibration ? made.frequency_Hz : made.period_mm) = value;
  // Rows that hardly show the wave still contain a part of it, as an alias; its size comes from the other passes.
  for (std::size_t i = 0; kind == WaveKind::vibration && i < made.signatures.size(); ++i)
    if (!shows_through(value, rows.row_s(i / std::size(waves))))
      made.signatures[i] = [](const CirclePass&, std::size_t) { return 0.0; };
  return made;
}

CircleCause ripple_through_any_loop(const CircleRows& rows, char axis, double period_mm) {
  constexpr int kKnots = 6;
  const double top = most(rows.passes(), feed_of);
  std::vector<CircleRows::Signature> signatures;
  for (int knot = 0; knot < kKnots; ++knot)
    for (const bool is_late : {false, true})
      for (const bool is_sine : {false, true}) {
        if (knot == 0 && is_late) continue;  // a constant force has no phase
        signatures.emplace_back([=](const CirclePass& pass, std::size_t k) {
          const double along = radial_part(pass, k, axis), phase = 2.0 * kPi * pass.radius_mm * along / period_mm;
          const double speed = pass.feed_mm_s / top * std::sqrt(std::max(0.0, 1.0 - along * along));
          const double hat = std::max(0.0, 1.0 - std::abs((kKnots - 1) * speed - knot));
          return hat * (is_late ? moving(pass, k, axis) : 1.0) * (is_sine ? std::sin(phase) : std::cos(phase)) * along;
        });
      }
  CircleCause made = cause(rows, "torque_ripple", {axis}, signatures, false, -std::log(200.0));
  made.period_mm = period_mm;
  return made;
}

std::vector<Unseen> unseen_causes(const CircleRows& rows) {
  std::vector<Unseen> list;
  if (!rows.has_outer()) {
    const char* why =
        "the motors' encoders do not see the table: use a ballbar (radius_mm) or scales at the table (x2_mm, y2_mm)";
    for (const char* kind :
         {"squareness", "scale_mismatch", "coupling", "backlash", "lateral_play", "straightness", "cyclic_error"})
      list.push_back({kind, why});
  } else if (!has_both_directions(rows.passes())) {
    list.push_back({"lateral_play", "it differs by direction: record the circle clockwise and counter-clockwise"});
  }
  double slow = HUGE_VAL;
  for (const CirclePass& pass : rows.passes()) slow = std::min(slow, stick_slip_speed(pass));
  const bool sticks = std::ranges::any_of(
      rows.passes(), [](const CirclePass& pass) { return std::ranges::any_of(pass.rests, &AxisRests::jumps); });
  if (slow > kStickSlip_mm_s && !sticks)
    list.push_back({"stick_slip",
                    "at these feeds an axis rests once at its reversal, which is a reversal spike: record "
                    "a circle at a feed lower by a factor of " +
                        std::to_string(static_cast<int>(std::ceil(slow / kStickSlip_mm_s)))});
  list.push_back(
      {"screw_pitch", "on a circle it looks like straightness and scale errors: measure positions along one axis"});
  if (!(most(rows.passes(), lag_angle_of) > kLeastLagAngle))
    list.push_back({"delay_between_axes",
                    "if the axes follow without lag, a delayed axis gives the same circle as servo mismatch; lines "
                    "with stops separate them"});
  return list;
}

CauseText cause_text(const std::string& kind) {
  static const std::pair<const char*, CauseText> texts[] = {
      {"servo_mismatch",
       {"The axes' loops differ: an ellipse at 45 degrees whose tilt changes with the direction and which grows with "
        "the feed",
        "axistool design x.toml y.toml -o DIR gives both axes one loop"}},
      {"delay_between_axes",
       {"One axis is delayed by a fixed time: like servo mismatch, but with unchanged radius",
        "compare the axes' bus cycles and filters; give both the same notch and low-pass"}},
      {"reversal_spike",
       {"Friction holds the axis after a reversal: an outward spike at the quadrants",
        "axistool friction, then design: friction feed-forward; where it is on, axistool diagnose"}},
      {"stick_slip",
       {"The axis rests by static friction and jumps when its loop overcomes it: steps beside the quadrants at low "
        "speed",
        "oil, gibs and wipers; then a stiffer loop shortens the steps: axistool bode, design --notch auto"}},
      {"squareness",
       {"The axes are not square: an ellipse at 45 degrees, the same in both directions", "align the axes"}},
      {"scale_mismatch",
       {"The axes' scales differ: an ellipse along the axes at any feed", "correct lead or scale of one axis"}},
      {"coupling",
       {"The acceleration of one axis displaces the other: an ellipse at 45 degrees that grows with the square of the "
        "feed, the same in both directions",
        "stiffen guides and frame, or lower limits.acceleration"}},
      {"backlash",
       {"The table does not move over this gap after a reversal: steps at the quadrants",
        "backlash compensation (backlash.* parameters), or preload, nut and bearings"}},
      {"lateral_play",
       {"The axis shifts sideways with the direction: its guide has play", "adjust the guide's gibs or preload"}},
      {"straightness", {"The axis follows a bow: three lobes", "level and align the guideway"}},
      {"cyclic_error",
       {"The position error is periodic: screw, coupling or encoder",
        "align screw and encoder; if the period is the encoder's grating, adjust the encoder"}},
      {"torque_ripple",
       {"A torque periodic in position disturbs the motor: cogging, or ripple of the drive",
        "axistool diagnose names it; cogging compensation (cogging.* parameters)"}},
      {"vibration", {"An oscillation at a fixed frequency", "axistool bode shows the resonance; design --notch auto"}}};
  for (const auto& [name, text] : texts)
    if (kind == name) return text;
  return {"", ""};
}

}  // namespace host
