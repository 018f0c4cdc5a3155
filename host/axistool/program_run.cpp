#include "host/axistool/program_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <numeric>
#include <optional>

#include "host/axes/path_force.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/typed_keys.hpp"
#include "host/device/motion.hpp"
#include "host/device/path_override.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/path/path_extents.hpp"
#include "host/record/read_record.hpp"
#include "host/stop_notice.hpp"

namespace axistool {

namespace {

using firmware::PathEnd;
using host::ExitCode;
using host::Failure;

std::atomic<bool> held = false;

/// Blocks signals until they are polled, because a signal during a report would look like a lost board.
class SignalsWait {
 public:
  SignalsWait() {
    sigemptyset(&signals_);
    for (const int one : {SIGINT, SIGTERM, SIGTSTP}) sigaddset(&signals_, one);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  ~SignalsWait() { pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

  /// Handles pending signals now.
  void let_in() {
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }

 private:
  sigset_t signals_{};
};

/// A progress line on the terminal, rewritten in place.
class RunLine {
 public:
  RunLine(bool shows, const host::PlannedPath& path) : shows_(shows && ::isatty(STDERR_FILENO) != 0), path_(path) {}
  ~RunLine() {
    if (has_line_) fmt::print(stderr, "\r\033[K");
  }

  void draw(const host::PathProgress& progress, bool is_held) {
    const auto now = std::chrono::steady_clock::now();
    if (!shows_ || (has_line_ && now - drawn_ < std::chrono::milliseconds(200))) return;
    drawn_ = now;
    has_line_ = true;
    fmt::print(stderr, "\r\033[Kline {}, {:.0f} %, {:.1f} s left, feed {:.0f} %{} ",
               host::line_at(path_, progress.elapsed_s), 100.0 * progress.elapsed_s / path_.duration_s(),
               path_.duration_s() - progress.elapsed_s, progress.state.permille / 10.0,
               progress.waits != nullptr
                   ? fmt::format(", WAITS at the stop in line {}: Enter continues", progress.waits->line)
               : is_held ? ", HELD: Ctrl-Z continues"
                         : "");
    std::fflush(stderr);
  }

 private:
  bool shows_, has_line_ = false;
  const host::PlannedPath& path_;
  std::chrono::steady_clock::time_point drawn_;
};

/// The operator's keys: overrides, and continuing a waiting program.
class Operator {
 public:
  Operator(host::BoardClient& board, const host::PathScale& scale, bool relative, const RunArguments& arguments)
      : board_(board), scale_(scale), relative_(relative), arguments_(arguments) {}

  host::PathWish wish(const host::PathProgress& progress, const Planned& planned) {
    const std::string typed = keys_.take();  // includes keys typed before a stop
    for (const char key : typed) override_.press(key);
    join_hold(progress, planned.path);
    const bool is_rapid =
        std::ranges::binary_search(planned.program.rapid_lines, host::line_at(planned.path, progress.elapsed_s));
    return {.held = held,
            .stop = interrupted() || ends_,
            .permille = override_.permille(is_rapid),
            .resume = goes_on(progress, typed.find('\n') != std::string::npos)};
  }

 private:
  /// The board holds the feed by itself until the operator releases it. Without an operator the program ends.
  void join_hold(const host::PathProgress& progress, const host::PlannedPath& path) {
    if (progress.state.held == firmware::kHeldForProcess && !is_joined_) {
      is_joined_ = held = true;
      ends_ = ::isatty(STDIN_FILENO) == 0;
      fmt::print(stderr, "\r\033[Kline {}: the force of the process exceeds feedback.hold_effort: {}\n",
                 host::line_at(path, progress.elapsed_s),
                 ends_ ? "the program ends" : "the feed is held; Ctrl-Z continues, Ctrl-C ends the program");
    }
    if (!held) is_joined_ = false;  // the operator has released it
  }

  bool goes_on(const host::PathProgress& progress, bool pressed) {
    if (progress.waits != announced_ && progress.waits != nullptr)
      fmt::print(stderr, "\r\033[Kline {}: the program waits{}\n", progress.waits->line,
                 arguments_.passes_stops ? ", and continues at once"
                                         : "; Enter continues, here or in the workbench, Ctrl-C ends it");
    const bool is_new = progress.waits != announced_;
    announced_ = progress.waits;
    if (is_new) notice_.reset();
    if (is_new && progress.waits != nullptr && !arguments_.passes_stops)
      notice_.emplace(arguments_.file, progress.waits->line);
    const bool is_continued = !is_new && (pressed || (notice_ && notice_->is_continued()));
    if (progress.waits == nullptr || !(arguments_.passes_stops || is_continued)) return false;
    require_startable(board_, scale_, relative_);
    return true;
  }

  TypedKeys keys_;
  host::PathOverride override_;
  host::BoardClient& board_;
  const host::PathScale& scale_;
  bool relative_;
  const RunArguments& arguments_;
  const host::PathStop* announced_ = nullptr;
  bool is_joined_ = false;  ///< the board's own hold has become the operator's
  bool ends_ = false;
  std::optional<host::StopNotice> notice_;  ///< for the workbench
};

/// Runs a program in parts: each probing move is one part, and the next part begins where it ended.
class Parts {
 public:
  Parts(host::BoardClient& board, const host::PathBoard& machine, bool relative, const RunArguments& arguments)
      : board_(board),
        machine_(machine),
        relative_(relative),
        arguments_(arguments),
        at_machine_(board, machine.scale, relative, arguments),
        recorder_(board, machine, arguments.capture.empty() ? 0 : arguments.models.size()) {}

  ProgramOutcome run(const std::string& text) {
    const host::PathPoint start = here();
    std::vector<host::PathPoint> probed;
    for (std::size_t begin = 0; outcome_.end == PathEnd::completed;) {
      planned_.program = read_program(text, arguments_, machine_, start, probed);
      const std::vector<host::PathMove>& moves = planned_.program.moves;
      if (probed.size() == planned_.program.probes.size()) {
        follow({moves.begin() + static_cast<std::ptrdiff_t>(begin), moves.end()});
        break;
      }
      const host::GcodeProbe probe = planned_.program.probes[probed.size()];
      const auto move = moves.begin() + static_cast<std::ptrdiff_t>(probe.move);
      follow({moves.begin() + static_cast<std::ptrdiff_t>(begin), move});
      if (outcome_.end != PathEnd::completed) break;
      if (!probe.must_succeed && is_there(probe)) {
        note_here(probe, move->line);
      } else {
        follow({*move}, probe.is_away ? firmware::ProbeStop::release : firmware::ProbeStop::contact);
        note(probe, move->line);
      }
      if (outcome_.end == PathEnd::probed) outcome_.end = PathEnd::completed;
      if (!outcome_.failure.empty() || outcome_.end != PathEnd::completed) break;
      probed.push_back(here());
      begin = probe.move + 1;
    }
    recorder_.stop();
    compare_with_plan();
    return outcome_;
  }

 private:
  host::PathPoint here() const { return point_of(host::path_start(board_, machine_.scale, relative_), machine_.scale); }

  void follow(const std::vector<host::PathMove>& moves, firmware::ProbeStop stop = firmware::ProbeStop::none) {
    planned_.path = plan_moves(moves, arguments_, machine_);
    if (planned_.path.knots.size() < 2) return;
    followed_.push_back({planned_.path, recorder_.capture().number.size()});
    host::PathOutcome part;
    {
      RunLine line(talks(arguments_), planned_.path);
      SignalsWait signals;
      part = host::run_path(
          board_, planned_.path, machine_, relative_, recorder_,
          [&](const host::PathProgress& progress) {
            signals.let_in();
            line.draw(progress, held);
            return at_machine_.wish(progress, planned_);
          },
          stop);
    }
    outcome_.end = static_cast<PathEnd>(part.state.end);
    outcome_.path_s += part.state.elapsed / machine_.scale.rate_Hz;
    outcome_.clock_s += part.clock_s;
    outcome_.planned_s += planned_.path.duration_s();
  }

  /// Compares the record with the plan. Rows at rest belong to an adjacent part.
  void compare_with_plan() {
    const host::PathCapture& capture = recorder_.capture();
    outcome_.lost_rows = capture.lost;
    std::vector<double> all_um;
    for (std::size_t part = 0; part < followed_.size(); ++part) {
      const std::size_t end = part + 1 < followed_.size() ? followed_[part + 1].first_row : capture.number.size();
      const std::vector<double> contour_um =
          host::contour_error_um(capture, followed_[part].path, machine_.scale, followed_[part].first_row, end);
      all_um.insert(all_um.end(), contour_um.begin(), contour_um.end());
    }
    for (const double one : all_um) outcome_.worst_um = std::max(outcome_.worst_um, one);
    outcome_.rows = all_um.size();
    outcome_.squares_um2 = std::inner_product(all_um.begin(), all_um.end(), all_um.begin(), 0.0);
    if (arguments_.capture.empty() || followed_.empty()) return;
    host::Record record = host::path_record(capture, machine_, all_um);
    host::add_path_forces(record, capture, machine_, force_models());
    host::write_record(record, arguments_.capture);
  }

  std::vector<host::PathForceModel> force_models() const {
    std::vector<host::PathForceModel> models;
    if (arguments_.models.empty()) return models;
    const firmware::ParameterValues values = board_.read_values();
    for (std::size_t i = 0; i < arguments_.models.size(); ++i)
      models.push_back(
          {host::read_model(arguments_.models[i]), host::estimator_of(values.axis(machine_.scale.axes[i]))});
    return models;
  }

  /// Whether the probe is already in the state that the move seeks. G38.3 and G38.5 then end at once; G38.2 and G38.4
  /// are errors, reported by the board (as in LinuxCNC, motion/command.c).
  bool is_there(const host::GcodeProbe& probe) {
    const bool touches = (board_.probe_state().flags & firmware::kProbeTouches) != 0;
    return touches != probe.is_away;
  }

  void note_here(const host::GcodeProbe& probe, std::size_t line) {
    const host::PathPoint at = here();
    outcome_.probes.push_back({probe, line, {at.data(), at.data() + machine_.scale.axes.size()}});
  }

  void note(const host::GcodeProbe& probe, std::size_t line) {
    const auto mm = host::probed_mm(board_, machine_.scale);
    outcome_.probes.push_back({probe, line, mm.value_or(std::vector<double>{})});
    const bool has_ended = outcome_.end == PathEnd::completed || outcome_.end == PathEnd::probed;
    if (!mm && has_ended && probe.must_succeed)
      outcome_.failure = fmt::format("{}:{}: {} ended without {}; the axes stand at its end (G38.{} would go on)",
                                     arguments_.file, line, word_of(probe), sought_by(probe), probe.tenths() + 1);
  }

  struct Followed {
    host::PlannedPath path;
    std::size_t first_row;  ///< of the record
  };

  host::BoardClient& board_;
  const host::PathBoard& machine_;
  bool relative_;
  const RunArguments& arguments_;
  Operator at_machine_;
  host::PathRecorder recorder_;
  std::vector<Followed> followed_;
  Planned planned_;
  ProgramOutcome outcome_;
};

}  // namespace

void catch_signals() {
  catch_interrupts();
  std::signal(SIGTSTP, [](int) { held = !held; });
}

std::string_view end_name(PathEnd end) {
  switch (end) {
    case PathEnd::none:
      return "not ended";
    case PathEnd::completed:
      return "completed";
    case PathEnd::asked:
      return "interrupted";
    case PathEnd::starved:
      return "starved";
    case PathEnd::host_lost:
      return "host lost";
    case PathEnd::fault:
      return "fault";
    case PathEnd::probed:
      return "probed";
    case PathEnd::touched:
      return "unexpected contact";
  }
  return "unknown";
}

std::string word_of(const host::GcodeProbe& probe) { return fmt::format("G38.{}", probe.tenths()); }

host::GcodeProgram read_program(const std::string& text, const RunArguments& arguments, const host::PathBoard& board,
                                const host::PathPoint& start, const std::vector<host::PathPoint>& probed) {
  host::GcodeMachine machine;
  machine.axes = board.scale.axes.size();
  machine.home = board.home;
  machine.feed_share = 0.01 * arguments.feed_percent;
  machine.rapid_share = 0.01 * arguments.rapid_percent;
  machine.fastest_mm_s = board.limits.velocity;
  machine.probed = probed;
  return host::read_gcode(text, arguments.file, start, machine);
}

host::PlannedPath plan_moves(const std::vector<host::PathMove>& moves, const RunArguments& arguments,
                             const host::PathBoard& board) {
  host::PathPlanOptions options;
  options.limits = board.limits;
  options.count_mm = *std::min_element(board.scale.count_mm.begin(), board.scale.count_mm.end());
  options.shortest_s = std::max(options.shortest_s, 2.0 / board.scale.rate_Hz);
  options.time_unit_s = 1.0 / board.scale.rate_Hz / (1u << firmware::kPathTimeBits);
  host::PlannedPath path = host::plan_path(moves, options);
  host::require_inside(path, {board.least, board.most}, board.scale.axes.size(), arguments.file);
  return path;
}

host::PathPoint point_of(const std::vector<host::BoardPosition>& at, const host::PathScale& scale) {
  host::PathPoint point = host::PathPoint::Zero();
  for (std::size_t i = 0; i < at.size(); ++i)
    point[static_cast<Eigen::Index>(i)] = (static_cast<double>(at[i].counts) + at[i].fraction) * scale.count_mm[i];
  return point;
}

void require_startable(host::BoardClient& board, const host::PathScale& scale, bool relative) {
  const host::BoardState state = board.status();
  for (const std::size_t axis : scale.axes) {
    host::require_no_fault(state, static_cast<std::uint8_t>(axis));
    if (!relative && (state.axis.at(axis).flags & firmware::kAxisHomed) == 0)
      throw Failure(ExitCode::refused, fmt::format("axis {} is not homed: `axistool home {}` first, or --here, which "
                                                   "takes its present count as its position",
                                                   firmware::kAxisNames.at(axis), firmware::kAxisNames.at(axis)));
  }
}

ProgramOutcome run_program(host::BoardClient& board, const host::PathBoard& machine, bool relative,
                           const RunArguments& arguments, const std::string& text) {
  return Parts(board, machine, relative, arguments).run(text);
}

}  // namespace axistool
