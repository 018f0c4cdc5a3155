// axistool run: a G-code program on a board.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <memory>
#include <numeric>
#include <optional>

#include "firmware/core/path/path_follower.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/json_output.hpp"
#include "host/axistool/typed_keys.hpp"
#include "host/device/motion.hpp"
#include "host/device/path_override.hpp"
#include "host/device/path_run.hpp"
#include "host/gcode/program.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/path/path_extents.hpp"
#include "host/read_file.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

using firmware::PathEnd;
using host::ExitCode;
using host::Failure;

struct RunArguments : DeviceArguments {
  std::string file, capture;
  std::vector<std::string> linear, params;
  double feed_percent = 100.0, rapid_percent = 100.0;
  bool here = false, passes_stops = false;
};

std::atomic<bool> held = false;

/// Ctrl-Z holds the feed and lets it go again; a terminal's other ways of stopping a program end the path.
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
  }
  return "unknown";
}

/// Start of the program: the present references.
host::PathPoint point_of(const std::vector<host::BoardPosition>& at, const host::PathScale& scale) {
  host::PathPoint point = host::PathPoint::Zero();
  for (std::size_t i = 0; i < at.size(); ++i)
    point[static_cast<Eigen::Index>(i)] = (static_cast<double>(at[i].counts) + at[i].fraction) * scale.count_mm[i];
  return point;
}

std::vector<host::BoardPosition> standing(const host::BoardState& status, const host::PathScale& scale) {
  std::vector<host::BoardPosition> at;
  for (const std::size_t axis : scale.axes) at.push_back({status.axis.at(axis).counts(), 0.0});
  return at;
}

struct Planned {
  host::GcodeProgram program;
  host::PlannedPath path;
};

Planned plan(const std::string& text, const RunArguments& arguments, const host::PathBoard& board,
             const std::vector<host::BoardPosition>& at) {
  host::GcodeMachine machine;
  machine.axes = board.scale.axes.size();
  machine.home = board.home;
  machine.feed_share = 0.01 * arguments.feed_percent;
  machine.rapid_share = 0.01 * arguments.rapid_percent;
  machine.fastest_mm_s = board.limits.velocity;
  Planned planned;
  planned.program = host::read_gcode(text, arguments.file, point_of(at, board.scale), machine);
  host::PathPlanOptions options;
  options.limits = board.limits;
  options.count_mm = *std::min_element(board.scale.count_mm.begin(), board.scale.count_mm.end());
  options.shortest_s = std::max(options.shortest_s, 2.0 / board.scale.rate_Hz);
  options.time_unit_s = 1.0 / board.scale.rate_Hz / (1u << firmware::kPathTimeBits);
  planned.path = host::plan_path(planned.program.moves, options);
  if (planned.path.knots.size() < 2)
    throw Failure(ExitCode::bad_input, fmt::format("{}: nothing in it moves", arguments.file));
  host::require_inside(planned.path, {board.least, board.most}, board.scale.axes.size(), arguments.file);
  return planned;
}

std::string box_text(const host::PathExtents& extents, std::size_t axes) {
  std::string text;
  for (std::size_t i = 0; i < axes; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    text += fmt::format("{}{} {:.3f} to {:.3f} mm", i > 0 ? ", " : "", firmware::kAxisNames.at(i), extents.least[k],
                        extents.most[k]);
  }
  return text;
}

nlohmann::json document_of(const RunArguments& arguments, const Planned& planned, std::size_t axes) {
  const host::PathExtents extents = host::extents_of(planned.path);
  nlohmann::json document = {{"format", "axis-run/1"},
                             {"file", arguments.file},
                             {"lines", planned.program.lines},
                             {"duration_s", planned.path.duration_s()},
                             {"nodes", planned.path.knots.size() - 1},
                             {"contour_um", nullptr},
                             {"contour_rms_um", nullptr}};
  for (std::size_t i = 0; i < axes; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    document["extents_mm"][std::string(firmware::kAxisNames.at(i))] = {extents.least[k], extents.most[k]};
  }
  return document;
}

/// Blocks signals until they are polled: in the middle of a report they would look like a lost board.
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

  /// Pending signals act now.
  void let_in() {
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }

 private:
  sigset_t signals_{};
};

/// Of the program, where the path is.
std::size_t line_at(const host::PlannedPath& path, double elapsed_s) {
  const auto next = std::ranges::upper_bound(path.curves, elapsed_s, {}, &host::PlannedCurve::time_s);
  return next == path.curves.begin() ? 0 : (next - 1)->line;
}

/// One line on a terminal, rewritten.
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
    fmt::print(stderr, "\r\033[Kline {}, {:.0f} %, {:.1f} s left, feed {:.0f} %{} ", line_at(path_, progress.elapsed_s),
               100.0 * progress.elapsed_s / path_.duration_s(), path_.duration_s() - progress.elapsed_s,
               progress.state.permille / 10.0,
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

bool has_terminal() { return ::isatty(STDIN_FILENO) != 0; }

/// A program that waits for an operator needs one.
void require_operator(const RunArguments& arguments, const host::PlannedPath& path) {
  if (path.stops.empty() || arguments.passes_stops || has_terminal()) return;
  throw Failure(ExitCode::refused,
                fmt::format("{} waits for the operator in line {} (M0, M1), but this is no terminal: run it on a "
                            "terminal, or with --pass-stops, which skips the stops",
                            arguments.file, path.stops.front().line));
}

/// Before a program starts or continues after a stop: the axes must be homed and without faults.
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

/// Whether a waiting program continues, and how fast it goes on.
class Operator {
 public:
  Operator(host::BoardClient& board, const host::PathScale& scale, bool relative, const RunArguments& arguments)
      : board_(board), scale_(scale), relative_(relative), arguments_(arguments) {}

  host::PathWish wish(const host::PathProgress& progress, const Planned& planned) {
    const std::string typed = keys_.take();  // also what was typed before a stop
    for (const char key : typed) override_.press(key);
    const bool is_rapid =
        std::ranges::binary_search(planned.program.rapid_lines, line_at(planned.path, progress.elapsed_s));
    return {.held = held,
            .stop = interrupted(),
            .permille = override_.permille(is_rapid),
            .resume = goes_on(progress, typed.find('\n') != std::string::npos)};
  }

 private:
  bool goes_on(const host::PathProgress& progress, bool pressed) {
    if (progress.waits != announced_ && progress.waits != nullptr)
      fmt::print(stderr, "\r\033[Kline {}: the program waits{}\n", progress.waits->line,
                 arguments_.passes_stops ? ", and continues at once" : "; Enter continues, Ctrl-C ends it");
    const bool is_new = progress.waits != announced_;
    announced_ = progress.waits;
    if (progress.waits == nullptr || !(arguments_.passes_stops || (pressed && !is_new))) return false;
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
};

void say_end(host::BoardClient& board, const host::PathBoard& axes, PathEnd end) {
  if (end == PathEnd::fault || end == PathEnd::host_lost)
    for (const std::size_t axis : axes.scale.axes)
      host::require_no_fault(board.status(), static_cast<std::uint8_t>(axis));
  if (end == PathEnd::starved)
    throw Failure(ExitCode::time_out,
                  "the program arrived too slowly, so the board stopped on the path: is this computer busy?");
  if (end != PathEnd::completed)
    throw Failure(ExitCode::answer_is_no, fmt::format("{} before its end; the axes stand on the path", end_name(end)));
}

/// Checks the program before it needs a machine.
void require_program(const std::string& text, const RunArguments& arguments) {
  host::GcodeMachine any;
  any.axes = 3;
  any.begins_anywhere = true;
  host::read_gcode(text, arguments.file, host::PathPoint::Zero(), any);
}

/// Empty for a dry run without a board: limits then come from files or are a new board's.
std::optional<host::BoardClient> board_of(const RunArguments& arguments) {
  if (arguments.dry_run && !arguments.params.empty()) return {};
  try {
    return open_board(arguments);
  } catch (const Failure& failure) {
    if (!arguments.dry_run || !arguments.device.empty() || failure.code != ExitCode::no_such_device) throw;
    return {};
  }
}

firmware::ParameterValues values_without_board(const RunArguments& arguments) {
  firmware::ParameterValues values{hal::kAxisCount};
  for (const std::string& file : arguments.params) host::put_file(values, file);
  if (talks(arguments))
    fmt::print("no board contacted: {}\n", arguments.params.empty()
                                               ? "checked against a new board's limits; --params FILE gives others"
                                               : "checked against the limits of the files");
  return values;
}

void run(const RunArguments& arguments) {
  const std::string text = host::read_file(arguments.file, host::kProgramSize);
  require_program(text, arguments);
  std::optional<host::BoardClient> asked = board_of(arguments);
  if (asked) asked->require_same_table();
  const firmware::ParameterValues values = asked ? asked->read_values() : values_without_board(arguments);
  const std::size_t axes = std::min<std::size_t>(asked ? asked->axis_count() : hal::kAxisCount, 3);
  const unsigned metres = arguments.linear.empty() ? 0u : axis_mask(arguments.linear, axes);
  const host::PathBoard machine = host::path_board(values, axes, metres, !arguments.dry_run);
  const auto mask = static_cast<std::uint8_t>((1u << axes) - 1u);

  Planned planned = plan(text, arguments, machine,
                         asked ? standing(asked->status(), machine.scale) : std::vector<host::BoardPosition>(axes));
  nlohmann::json document = document_of(arguments, planned, axes);
  const host::PathExtents extents = host::extents_of(planned.path);
  if (talks(arguments))
    fmt::print("{}: {} lines, {:.2f} s, {}\n", arguments.file, planned.program.lines, planned.path.duration_s(),
               box_text(extents, axes));
  if (arguments.dry_run) {
    document["stopped_because"] = "dry run";
    if (!arguments.json.empty()) write_json(document, arguments.json);
    return;
  }
  host::BoardClient& board = *asked;
  const bool relative = arguments.here || !planned.program.is_absolute;
  require_startable(board, machine.scale, relative);
  require_operator(arguments, planned.path);
  require_consent(arguments, fmt::format("Run {}? The axes move within {}.", arguments.file, box_text(extents, axes)));
  catch_signals();
  const bool was_enabled = host::are_enabled(board, mask);
  if (!was_enabled) host::enable_and_wait(board, mask);
  // From where the references stand, now that the loops are closed.
  planned = plan(text, arguments, machine, host::path_start(board, machine.scale, relative));
  host::PathOutcome outcome;
  {
    RunLine line(talks(arguments), planned.path);
    SignalsWait signals;
    Operator at_machine(board, machine.scale, relative, arguments);
    outcome = host::run_path(board, planned.path, machine, relative, true, [&](const host::PathProgress& progress) {
      signals.let_in();
      line.draw(progress, held);
      return at_machine.wish(progress, planned);
    });
  }
  if (!was_enabled) host::disable_and_wait(board, mask);
  const std::vector<double> contour_um = host::contour_error_um(outcome.capture, planned.path, machine.scale);
  const double worst_um = contour_um.empty() ? 0.0 : *std::max_element(contour_um.begin(), contour_um.end());
  if (!arguments.capture.empty())
    host::write_record(host::path_record(outcome, machine, contour_um), arguments.capture);
  const auto end = static_cast<PathEnd>(outcome.state.end);
  document["duration_s"] = outcome.state.elapsed / machine.scale.rate_Hz;
  document["planned_s"] = planned.path.duration_s();
  document["contour_um"] = worst_um;
  const double squares = std::inner_product(contour_um.begin(), contour_um.end(), contour_um.begin(), 0.0);
  document["contour_rms_um"] = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, contour_um.size())));
  document["stopped_because"] = end_name(end);
  document["lost_rows"] = outcome.capture.lost;
  if (!arguments.json.empty()) write_json(document, arguments.json);
  if (talks(arguments))
    fmt::print("{}: {:.2f} s, contour error {:.1f} um at most\n", end_name(end), document["duration_s"].get<double>(),
               worst_um);
  say_end(board, machine, end);
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a G-code program on the board's axes");
  add_input(*command, "FILE", arguments->file, "program (RS274/NGC)")->required();
  add_output(*command, "--capture", arguments->capture, "record to write (axis-record/1), with the contour error");
  command->add_option("--feed", arguments->feed_percent, "override of the feeds F, %; limits of the axes hold")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 120.0));
  command->add_option("--rapid", arguments->rapid_percent, "override of rapids (G0, G28), %")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 100.0));
  command->add_option("--linear", arguments->linear, "axes whose parameters are in metres")->delimiter(',');
  command->add_flag("--here", arguments->here, "for axes that are not homed: take their counts as positions");
  command->add_flag("--pass-stops", arguments->passes_stops, "skip the stops M0 and M1; watch the program");
  add_input(*command, "--params", arguments->params, "with --dry-run: take limits from these files, without a board");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool run part.ngc --dry-run              # time and extents, against the board's limits\n"
      "  axistool run part.ngc --capture part.csv\n"
      "  axistool run part.ngc --feed 120 --rapid 25\n"
      "Known: G0 G1 G2 G3 (I J, or R) G4 P G17 G20 G21 G28 G54 G61 G64 P G90 G91, F, M0 M1 M2 M30, X Y Z, N, "
      "comments;\n"
      "anything else is an error that names the line. The path is exact (G61) unless the program says G64; G64\n"
      "without P has a tolerance of 0.05 mm. On a terminal Ctrl-Z holds and resumes the feed, Ctrl-C stops on the "
      "path,\n"
      "M0 and M1 wait for Enter, - and + override the feeds while it runs, and < and > the rapids: in steps of 10 %, "
      "up "
      "to\n"
      "what was planned (--feed, --rapid).");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
