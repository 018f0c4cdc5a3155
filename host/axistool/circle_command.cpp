// axistool circle: causes of circle errors, from records or from circles that a board makes.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "host/axes/circle_report.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/axistool/program_run.hpp"
#include "host/device/closed_loops.hpp"
#include "host/device/motion.hpp"
#include "host/model/model_file.hpp"
#include "host/path/path_extents.hpp"
#include "host/record/read_record.hpp"
#include "host/report/terminal.hpp"

namespace axistool {

namespace {

struct CircleArguments : RunArguments {
  std::vector<std::string> records, axis_models;
  std::string report, folder;
  double radius_mm = 20.0;
  std::vector<double> feeds_mm_s = {20.0, 80.0};
};

constexpr int kTurns = 3;  // the first and the last also speed up and slow down

struct Pass {
  std::string name, program;
};

/// Both directions at every feed, about a centre on the positive side of x from the present position.
std::vector<Pass> passes_of(const CircleArguments& arguments) {
  std::vector<Pass> passes;
  for (const double feed : arguments.feeds_mm_s)
    for (const bool is_ccw : {true, false}) {
      Pass pass{fmt::format("{}-{:g}", is_ccw ? "ccw" : "cw", feed), "G21 G91\n"};
      for (int turn = 0; turn < kTurns; ++turn)
        pass.program += fmt::format("F{:.6f} G{} X0 Y0 I{:.6f} J0\n", 60.0 * feed, is_ccw ? 3 : 2, arguments.radius_mm);
      pass.program += "M2\n";
      passes.push_back(std::move(pass));
    }
  return passes;
}

void require_feeds(const CircleArguments& arguments, const host::PathBoard& machine) {
  for (const double feed : arguments.feeds_mm_s)
    for (int axis = 0; axis < 2; ++axis)
      if (feed > machine.limits.velocity[axis] || feed * feed / arguments.radius_mm > machine.limits.acceleration[axis])
        throw host::Failure(
            host::ExitCode::refused,
            fmt::format("{:g} mm/s about {:g} mm is beyond limits.velocity or limits.acceleration of {}: "
                        "give lower --feeds or a larger --radius",
                        feed, arguments.radius_mm, firmware::kAxisNames.at(static_cast<std::size_t>(axis))));
}

/// Makes the circles; returns the files of their records.
std::vector<std::string> make(CircleArguments arguments) {
  if (arguments.folder.empty())
    throw host::Failure(host::ExitCode::usage,
                        "give records of circles; or -o DIR, to make circles on a board and keep their records there");
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  if (board.axis_count() < 2)
    throw host::Failure(host::ExitCode::refused, "a circle needs two axes; this board has one");
  const firmware::ParameterValues values = board.read_values();
  const unsigned metres = arguments.linear.empty() ? 0u : axis_mask(arguments.linear, 2);
  const host::PathBoard machine = host::path_board(values, 2, metres);
  require_feeds(arguments, machine);
  require_startable(board, machine.scale, true);
  require_consent(arguments,
                  fmt::format("Circles of {:g} mm, both ways. x moves by {:g} mm to its positive side, y by {:g} "
                              "mm to either side. Move them?",
                              arguments.radius_mm, 2.0 * arguments.radius_mm, arguments.radius_mm));
  std::error_code fault;
  std::filesystem::create_directories(arguments.folder, fault);
  if (fault)
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: cannot make this folder: {}", arguments.folder, fault.message()));
  catch_signals();
  constexpr std::uint8_t kMask = 3;
  host::ClosedLoops loops(board, kMask);
  std::vector<std::string> files;
  for (const Pass& pass : passes_of(arguments)) {
    arguments.file = "circle " + pass.name;
    arguments.capture = (std::filesystem::path(arguments.folder) / (pass.name + ".csv")).string();
    const ProgramOutcome outcome = run_program(board, machine, true, arguments, pass.program);
    if (outcome.end != firmware::PathEnd::completed) {
      loops.open();
      for (const std::size_t axis : machine.scale.axes)
        host::require_no_fault(board.status(), static_cast<std::uint8_t>(axis));
      throw host::Failure(
          host::ExitCode::answer_is_no,
          fmt::format("circle {}: {} before its end; the axes stand on it", pass.name, end_name(outcome.end)));
    }
    files.push_back(arguments.capture);
    if (talks(arguments)) fmt::print("{}: contour error {:.1f} um at most\n", arguments.capture, outcome.worst_um);
  }
  loops.open();
  return files;
}

void run(const CircleArguments& arguments) {
  const std::vector<std::string> files = arguments.records.empty() ? make(arguments) : arguments.records;
  std::vector<host::Record> records;
  std::string names;
  for (const std::string& path : files) {
    records.push_back(host::read_record(path));
    names += (names.empty() ? "" : ", ") + path;
  }
  host::CircleDiagnosis diagnosis = host::diagnose_circle(host::circle_passes(records));
  for (const std::string& path : arguments.axis_models) host::tell_turns(diagnosis, host::read_model(path), path);
  if (!arguments.report.empty()) host::circle_report(diagnosis, names).write(arguments.report);
  if (!arguments.json.empty()) write_json(host::circle_json(diagnosis), arguments.json);
  if (arguments.json != "-") fmt::print("{}", host::circle_text(diagnosis, host::terminal_of(stdout)));
}

}  // namespace

void add_circle(CLI::App& app) {
  auto arguments = std::make_shared<CircleArguments>();
  CLI::App* command = app.add_subcommand("circle", "why a circle is not round: each cause in um, with its odds");
  add_input(*command, "RECORD", arguments->records,
            "records of circles: one with x_mm and y_mm, or pairs with one of each axis (# drive: x, # drive: y); "
            "without records, a board makes the circles");
  add_input(*command, "--model", arguments->axis_models,
            "models of the axes, X.toml Y.toml: periods are also given in turns");
  add_output(*command, "-o,--output", arguments->folder, "folder for the records of the circles that a board makes",
             FileRole::output_folder);
  command->add_option("--radius", arguments->radius_mm, "their radius, mm")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command->add_option("--feeds", arguments->feeds_mm_s, "their feeds, mm/s")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--linear", arguments->linear, "axes whose parameters are in metres")->delimiter(',');
  add_output(*command, "--report", arguments->report, "HTML page: the circle magnified, each cause's share");
  add_device_options(*command, *arguments);
  command->add_flag("-y,--yes", arguments->yes, "do not ask");
  command->footer(
      "Examples:\n"
      "  axistool circle circle-x.csv circle-y.csv\n"
      "  axistool circle both-ways-slow.csv both-ways-fast.csv --report circle.html --json -\n"
      "  axistool circle -o circles --radius 20 --feeds 20,80 --report circle.html   # made by a board\n"
      "Records: the file of `run --capture` (x_mm, x_ref_mm, y_mm, y_ref_mm in one), or those of `hil circle -o` (one\n"
      "for each axis, paired in order). Every turn at a steady feed counts, in either direction; a record may hold\n"
      "several. Give both directions at two feeds; `hil ballbar -o` simulates them. Stick-slip shows at a slow feed "
      "only,\n"
      "say 5 mm/s: cannot_see says so where a record is too fast for it. Sensors at the table: columns\n"
      "x2_mm and y2_mm (scales, grid encoder), or a ballbar's radius_mm (its length or its deviation; radius_um\n"
      "likewise). Without one, squareness, scales, coupling, backlash, play and straightness are listed as not\n"
      "observable. Without records, a board makes three turns each way at every feed from where its axes stand, about\n"
      "a centre on the positive side of x. Exit code 8: no whole turn at a steady feed, or a circle beyond the axes'\n"
      "limits.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
