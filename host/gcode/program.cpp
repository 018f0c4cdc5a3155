#include "host/gcode/program.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

constexpr double kInch_mm = 25.4;
constexpr double kUsualTolerance_mm = 0.05;
// An arc's radii at its beginning and end may differ by this length or by 0.1 %, as in LinuxCNC.
constexpr double kRadiusTolerance_mm = 0.0127, kRadiusShare = 0.001;
constexpr double kFarthest_mm = 1e6;  ///< larger than any machine, and sums are still exact enough

struct Word {
  char letter;
  double value;
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, const PathPoint& start, const GcodeMachine& machine)
      : text_(text), name_(name), machine_(machine), at_(start) {
    is_known_.fill(!machine.begins_anywhere);
  }

  GcodeProgram read() {
    for (std::size_t begin = 0; begin <= text_.size() && !has_ended_;) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      ++line_;
      take(text_.substr(begin, end - begin));
      begin = end + 1;
    }
    program_.lines = line_;
    return std::move(program_);
  }

 private:
  enum class Motion { none, rapid, feed, clockwise, counter_clockwise, probe };

  [[noreturn]] void fail(const std::string& what) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}:{}: {}", name_, line_, what));
  }

  /// Splits a line into words; removes comments, block delete and the tape's `%`.
  std::vector<Word> words_of(std::string_view line) const {
    std::vector<Word> words;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    std::size_t i = 0;
    const auto skip_space = [&] {
      while (i < line.size() && (line[i] == ' ' || line[i] == '\t')) ++i;
    };
    skip_space();
    if (i < line.size() && (line[i] == '%' || line[i] == '/')) return words;
    for (skip_space(); i < line.size(); skip_space()) {
      if (line[i] == ';') break;
      if (line[i] == '(') {
        const std::size_t close = line.find(')', i);
        if (close == std::string_view::npos) fail("comment without a closing )");
        i = close + 1;
        continue;
      }
      const char letter = static_cast<char>(line[i] >= 'a' && line[i] <= 'z' ? line[i] - 'a' + 'A' : line[i]);
      if (letter < 'A' || letter > 'Z')
        fail(fmt::format("unexpected '{}': variables and expressions are not supported", printable(line[i])));
      ++i;
      skip_space();
      const std::size_t begin = i;
      if (i < line.size() && line[i] == '+') ++i;
      double value = 0.0;
      const auto [end, error] =
          std::from_chars(line.data() + i, line.data() + line.size(), value, std::chars_format::fixed);
      if (error != std::errc() || !std::isfinite(value) || std::abs(value) > 1e9)
        fail(fmt::format("{} needs a number after it", letter));
      i = static_cast<std::size_t>(end - line.data());
      if (i == begin) fail(fmt::format("{} needs a number after it", letter));
      words.push_back({letter, value});
    }
    return words;
  }

  static std::string printable(char c) {
    return c >= ' ' && c <= '~' ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }

  void take(std::string_view line) {
    const std::vector<Word> words = words_of(line);
    if (words.empty()) return;
    block_ = {};
    for (std::size_t i = 0; i < words.size(); ++i) take_word(words[i], i == 0);
    run();
  }

  void set_once(std::optional<double>& place, const Word& word) const {
    if (place) fail(fmt::format("{} occurs twice in this line", word.letter));
    place = word.value;
  }

  void take_word(const Word& word, bool is_first) {
    switch (word.letter) {
      case 'N':
        if (!is_first) fail("N must be at the beginning of a line");
        return;
      case 'X':
      case 'Y':
      case 'Z': {
        const auto axis = static_cast<std::size_t>(word.letter - 'X');
        if (axis >= machine_.axes) fail(fmt::format("this machine has no axis {}", word.letter));
        return set_once(block_.axis[axis], word);
      }
      case 'I':
      case 'J':
        return set_once(block_.centre[static_cast<std::size_t>(word.letter - 'I')], word);
      case 'R':
        return set_once(block_.radius, word);
      case 'P':
        return set_once(block_.p, word);
      case 'F':
        if (!(word.value > 0.0)) fail("F must be above 0");
        return set_once(block_.feed, word);
      case 'G':
        return take_g(word.value);
      case 'M':
        return take_m(word.value);
      default:
        fail(fmt::format("{} is not supported; the words are F G I J M N P R X Y Z", word.letter));
    }
  }

  /// Refuses two words of one group in one line, because they contradict each other.
  void claim(const char* group) {
    if (!block_.groups.insert(group).second) fail(fmt::format("two words of group '{}' in one line", group));
  }

  void take_g(double value) {
    const long tenths = std::lround(value * 10.0);
    if (std::abs(value * 10.0 - static_cast<double>(tenths)) > 1e-9) fail(fmt::format("G{:g} is not supported", value));
    switch (tenths) {
      case 0:
      case 10:
      case 20:
      case 30:
        claim("motion");
        motion_ = tenths == 0    ? Motion::rapid
                  : tenths == 10 ? Motion::feed
                  : tenths == 20 ? Motion::clockwise
                                 : Motion::counter_clockwise;
        return;
      case 382:
      case 383:
      case 384:
      case 385:
        claim("motion");
        motion_ = Motion::probe;
        probe_ = {.is_away = tenths >= 384, .must_succeed = tenths % 2 == 0};
        return;
      case 40:
        claim("dwell");
        block_.dwells = true;
        return;
      case 170:
        return claim("plane");
      case 200:
      case 210:
        claim("units");
        unit_mm_ = tenths == 200 ? kInch_mm : 1.0;
        return;
      case 280:
        claim("dwell");
        block_.goes_home = true;
        return;
      case 540:
        return claim("coordinate system");
      case 610:
      case 640:
        claim("path control");
        block_.blends = tenths == 640;
        return;
      case 900:
      case 910:
        claim("distance");
        is_relative_ = tenths == 910;
        return;
      default:
        fail(
            fmt::format("G{:g} is not supported; G0 G1 G2 G3 G4 G17 G20 G21 G28 G38.2 to G38.5 G54 G61 G64 G90 "
                        "G91 are",
                        value));
    }
  }

  void take_m(double value) {
    claim("program");
    if (value == 2.0 || value == 30.0)
      block_.ends = true;
    else if (value == 0.0 || value == 1.0)
      block_.pauses = true;
    else
      fail(fmt::format("M{:g} is not supported; M0 M1 M2 M30 are", value));
  }

  void run() {
    if (block_.feed) feed_mm_s_ = *block_.feed * unit_mm_ / 60.0;
    const bool has_target = block_.axis[0] || block_.axis[1] || block_.axis[2];
    const bool is_arc = motion_ == Motion::clockwise || motion_ == Motion::counter_clockwise;
    if (block_.blends) {
      if (block_.p && *block_.blends && !(*block_.p >= 0.0)) fail("P of G64 must be at least 0");
      if (block_.p && !*block_.blends) fail("G61 has no P");
      tolerance_mm_ = !*block_.blends ? 0.0 : block_.p ? *block_.p * unit_mm_ : kUsualTolerance_mm;
    }
    if (block_.p && !block_.blends && !block_.dwells) fail("P belongs to G4 or G64");
    if (block_.dwells) dwell(block_.p);
    if (block_.goes_home) {
      go_home();
    } else if (has_target || (is_arc && (block_.centre[0] || block_.centre[1]))) {
      if (block_.dwells) fail("G4 must be alone in its line");
      move();
    } else if (block_.centre[0] || block_.centre[1] || block_.radius) {
      fail("I, J and R are for arcs only, G2 or G3");
    }
    if (block_.pauses) stand(0.0, PathMoveKind::stop);
    if (block_.ends) has_ended_ = true;
  }

  void dwell(const std::optional<double>& seconds) {
    if (!seconds || !(*seconds >= 0.0) || *seconds > 86'400.0) fail("G4 needs P, 0 to 86400 seconds");
    stand(*seconds);
  }

  void stand(double seconds, PathMoveKind kind = PathMoveKind::dwell) {
    PathMove move;
    move.kind = kind;
    move.curve = PathCurve::line(at_, at_);
    move.dwell_s = seconds;
    move.line = line_;
    append(move, seconds);
  }

  PathPoint target() {
    PathPoint to = at_;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      if (!block_.axis[i]) continue;
      to[axis] = *block_.axis[i] * unit_mm_ + (is_relative_ ? at_[axis] : 0.0);
      if (!is_relative_) program_.is_absolute = is_known_[i] = true;
      if (!(std::abs(to[axis]) < kFarthest_mm)) fail(fmt::format("the position is beyond {:g} mm", kFarthest_mm));
    }
    return to;
  }

  void add(const PathCurve& curve, bool is_rapid) {
    if (!is_rapid && !(feed_mm_s_ > 0.0))
      fail("no feed: give F, in units per minute, before the first G1, G2, G3 or G38");
    PathMove move;
    move.curve = curve;
    move.feed_mm_s = is_rapid ? rapid_mm_s(curve) : feed_mm_s_ * machine_.feed_share;
    move.tolerance_mm = tolerance_mm_;
    move.line = line_;
    if (is_rapid && (program_.rapid_lines.empty() || program_.rapid_lines.back() != line_))
      program_.rapid_lines.push_back(line_);
    append(move, curve.length() / move.feed_mm_s);
  }

  /// Speed of a rapid along a line. Without an override only the plan limits it.
  double rapid_mm_s(const PathCurve& line) const {
    if (!(machine_.rapid_share < 1.0) || !(line.length() > 0.0)) return 1e9;
    const PathPoint way = (line.end() - line.begin()).cwiseAbs();
    return machine_.rapid_share * line.length() / way.cwiseQuotient(machine_.fastest_mm_s).maxCoeff();
  }

  /// `least_s`: minimum duration.
  void append(const PathMove& move, double least_s) {
    duration_s_ += least_s;
    if (duration_s_ > kLongestPath_s)
      fail(fmt::format("the program lasts longer than {:g} h, the limit: raise F or split the program",
                       kLongestPath_s / 3600.0));
    if (program_.moves.size() == kMostPathMoves)
      fail(fmt::format("the program has more than {} moves, the limit: split it", kMostPathMoves));
    program_.moves.push_back(move);
  }

  void go_home() {
    // G28 moves through the point on the line, as in the standard.
    const PathPoint by = target();
    if ((by - at_).norm() > 0.0) add(PathCurve::line(at_, by), true);
    PathPoint home = machine_.home;
    for (std::size_t i = machine_.axes; i < 3; ++i)
      home[static_cast<Eigen::Index>(i)] = by[static_cast<Eigen::Index>(i)];
    add(PathCurve::line(by, home), true);
    at_ = home;
    program_.is_absolute = true;
    is_known_ = {true, true, true};
  }

  void move() {
    const bool begins_somewhere = is_known_[0] && is_known_[1];
    const PathPoint to = target();
    switch (motion_) {
      case Motion::none:
        fail("position without G0, G1, G2, G3 or G38 before it");
      case Motion::rapid:
      case Motion::feed:
        if (block_.centre[0] || block_.centre[1] || block_.radius) fail("I, J and R are for arcs only, G2 or G3");
        add(PathCurve::line(at_, to), motion_ == Motion::rapid);
        break;
      case Motion::probe:
        return probe(to);
      default:
        arc(to, begins_somewhere);
    }
    at_ = to;
  }

  /// The axes stand before and after it; their position afterwards depends on the probe.
  void probe(const PathPoint& to) {
    if (block_.centre[0] || block_.centre[1] || block_.radius) fail("I, J and R are for arcs only, G2 or G3");
    const bool is_certain = !machine_.begins_anywhere && program_.probes.size() <= machine_.probed.size();
    if (is_certain && !((to - at_).norm() > 0.0)) fail("G38 has no motion: its target is the present position");
    add(PathCurve::line(at_, to), false);
    program_.moves.back().kind = PathMoveKind::probe;
    probe_.move = program_.moves.size() - 1;
    program_.probes.push_back(probe_);
    const std::size_t count = program_.probes.size();
    at_ = count <= machine_.probed.size() ? machine_.probed[count - 1] : to;
  }

  void arc(const PathPoint& to, bool begins_somewhere) {
    const bool by_radius = block_.radius.has_value(), by_centre = block_.centre[0] || block_.centre[1];
    if (by_radius == by_centre) fail("an arc needs either R, or I and J");
    if (!begins_somewhere && !is_relative_) return add(PathCurve::line(at_, to), false);
    const PathPoint centre = by_radius ? centre_by_radius(to) : centre_by_offset(to);
    const double sense = motion_ == Motion::clockwise ? -1.0 : 1.0;
    const double begin = std::atan2(at_.y() - centre.y(), at_.x() - centre.x());
    const double end = std::atan2(to.y() - centre.y(), to.x() - centre.x());
    double angle = std::remainder(end - begin, 2.0 * std::numbers::pi) * sense;
    const bool is_whole = to.x() == at_.x() && to.y() == at_.y();
    if (is_whole)
      angle = 2.0 * std::numbers::pi;
    else if (angle <= 0.0)
      angle += 2.0 * std::numbers::pi;
    add(PathCurve::arc(at_, centre, sense * angle, to.z()), false);
    // If the radii at both ends differ slightly, a line closes the gap, which is below the tolerance of arcs.
    const PathPoint reached = program_.moves.back().curve.end();
    if ((reached - to).norm() > 1e-9) program_.moves.back().curve = closed_arc(centre, sense * angle, to);
  }

  /// The same arc about a centre with equal distance from both ends.
  PathCurve closed_arc(const PathPoint& centre, double angle, const PathPoint& to) const {
    const double dx = to.x() - at_.x(), dy = to.y() - at_.y(), chord_2 = dx * dx + dy * dy;
    if (!(chord_2 > 0.0)) return PathCurve::arc(at_, centre, angle, to.z());
    // Projects the old centre onto the perpendicular bisector of the chord.
    const double mx = (at_.x() + to.x()) / 2.0, my = (at_.y() + to.y()) / 2.0;
    const double along = ((centre.x() - mx) * dx + (centre.y() - my) * dy) / chord_2;
    const PathPoint moved(centre.x() - along * dx, centre.y() - along * dy, 0.0);
    const double begin = std::atan2(at_.y() - moved.y(), at_.x() - moved.x());
    const double end = std::atan2(to.y() - moved.y(), to.x() - moved.x());
    double turned = std::remainder(end - begin, 2.0 * std::numbers::pi);
    const double turn = std::copysign(2.0 * std::numbers::pi, angle);
    while (std::abs(turned + turn - angle) < std::abs(turned - angle)) turned += turn;
    while (std::abs(turned - turn - angle) < std::abs(turned - angle)) turned -= turn;
    return PathCurve::arc(at_, moved, turned, to.z());
  }

  PathPoint centre_by_offset(const PathPoint& to) const {
    const PathPoint centre(at_.x() + block_.centre[0].value_or(0.0) * unit_mm_,
                           at_.y() + block_.centre[1].value_or(0.0) * unit_mm_, 0.0);
    const double begin = std::hypot(at_.x() - centre.x(), at_.y() - centre.y());
    const double end = std::hypot(to.x() - centre.x(), to.y() - centre.y());
    if (!(begin > 0.0)) fail("the arc's radius is 0");
    if (!(begin < kFarthest_mm)) fail(fmt::format("the arc's radius exceeds {:g} mm; use a line", kFarthest_mm));
    const double difference = std::abs(begin - end);
    if (difference > kRadiusTolerance_mm && difference > kRadiusShare * begin)
      fail(fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre; both must be equal", begin, end));
    return centre;
  }

  PathPoint centre_by_radius(const PathPoint& to) const {
    const double radius = std::abs(*block_.radius) * unit_mm_;
    const double dx = to.x() - at_.x(), dy = to.y() - at_.y(), chord = std::hypot(dx, dy);
    if (!(radius > 0.0)) fail("R must not be 0");
    if (!(radius < kFarthest_mm)) fail(fmt::format("the arc's radius exceeds {:g} mm; use a line", kFarthest_mm));
    if (!(chord > 0.0)) fail("an arc by R must end elsewhere than it starts; use I and J for a full circle");
    const double half = chord / 2.0;
    if (half > radius * (1.0 + kRadiusShare) && half - radius > kRadiusTolerance_mm)
      fail(fmt::format("the arc's ends are {:.4f} mm apart, more than twice its radius", chord));
    const double height = std::sqrt(std::max(radius * radius - half * half, 0.0));
    // Seen along the chord, the centre of the shorter counter-clockwise arc is on the left. R below 0 selects the
    // longer arc.
    const double side = (motion_ == Motion::counter_clockwise) == (*block_.radius > 0.0) ? 1.0 : -1.0;
    return {(at_.x() + to.x()) / 2.0 - side * height * dy / chord,
            (at_.y() + to.y()) / 2.0 + side * height * dx / chord, 0.0};
  }

  struct Block {
    std::array<std::optional<double>, 3> axis;
    std::array<std::optional<double>, 2> centre;
    std::optional<double> radius, p, feed;
    std::optional<bool> blends;
    bool dwells = false, goes_home = false, pauses = false, ends = false;
    std::set<std::string> groups;
  };

  std::string_view text_;
  const std::string& name_;
  const GcodeMachine& machine_;
  GcodeProgram program_;
  std::size_t line_ = 0;
  Block block_;
  PathPoint at_;
  Motion motion_ = Motion::none;
  GcodeProbe probe_;
  double unit_mm_ = 1.0, feed_mm_s_ = 0.0, tolerance_mm_ = 0.0, duration_s_ = 0.0;
  std::array<bool, 3> is_known_{};  ///< whether the axis's position is known
  bool is_relative_ = false, has_ended_ = false;
};

}  // namespace

GcodeProgram read_gcode(std::string_view text, const std::string& name, const PathPoint& start,
                        const GcodeMachine& machine) {
  return Reader(text, name, start, machine).read();
}

}  // namespace host
