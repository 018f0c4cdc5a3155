#include <algorithm>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/hil/scenario.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/model/effect_forms.hpp"
#include "host/model/model_file.hpp"
#include "host/output_target.hpp"
#include "host/read_file.hpp"
#include "host/toml_fields.hpp"
#include "host/toml_text.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

using Names = std::vector<std::string_view>;

constexpr double kLongestScenario_s = 600.0;
constexpr double kLargest_mm = 1e6;
const Names kAxes(kAxisNames.begin(), kAxisNames.end());
const Names kMoves{"jog", "move_to", "stop", "circle", "square", "enable", "disable", "clear"};

class ScenarioReader {
 public:
  ScenarioReader(std::string_view text, const std::string& path) : path_(path), root_(parse_toml(text, path)) {}

  Scenario read() {
    TomlFields top = fields(root_, "the top");
    if (top.text("format") != "axis-scenario/1") top.fail("format", "this program reads axis-scenario/1");
    scenario_.path = path_;
    scenario_.name = top.text("name");
    scenario_.about = top.optional_text("about").value_or("");
    const double seed = top.positive("seed", 1.0);
    if (seed > 1e9) top.fail("seed", "it must be at most 1e9");
    scenario_.seed = static_cast<std::uint64_t>(seed);
    scenario_.duration_s = top.positive("duration_s", 1.0);
    if (scenario_.duration_s > kLongestScenario_s)
      top.fail("duration_s", fmt::format("at most {:g} s are simulated; split the scenario", kLongestScenario_s));
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) read_axis(top, i);
    if (scenario_.axes[0].drive.data.sample_period_s != scenario_.axes[1].drive.data.sample_period_s)
      top.fail("y", "both axes of a board have one sample period; give their drives the same");
    read_table(top);
    for (const toml::table* table : top.tables("move")) read_move(*table);
    for (const toml::table* table : top.tables("fault")) read_fault(*table);
    for (const toml::table* table : top.tables("expect")) read_expectation(*table);
    top.refuse_rest();
    return std::move(scenario_);
  }

 private:
  TomlFields fields(const toml::table& table, std::string where) const { return {table, path_, std::move(where)}; }

  double time(TomlFields& from, std::string_view key) const {
    const double at_s = from.not_negative(key);
    if (at_s > scenario_.duration_s)
      from.fail(key, fmt::format("{:g} s is after the end of the scenario, {:g} s", at_s, scenario_.duration_s));
    return at_s;
  }

  sim::DriveDescription model_beside(TomlFields& from, std::string_view key, const std::string& name) const {
    if (name == "paper x" || name == "paper y") return *paper_drive(name.substr(6));
    const auto file = std::filesystem::path(path_).parent_path() / name;
    if (!std::filesystem::is_regular_file(file))
      from.fail(
          key,
          fmt::format("there is no model file '{}'; give one beside the scenario, or write \"paper x\" or \"paper y\"",
                      file.string()));
    protect_input(file.string());
    return read_model(file.string());
  }

  void read_axis(TomlFields& top, std::size_t index) {
    const std::string name(kAxisNames[index]);
    const toml::table* table = top.sub_table(name);
    if (table == nullptr)
      top.fail(name, fmt::format("the axis is missing; add [{}] with drive = \"paper {}\"", name, name));
    TomlFields from = fields(*table, "[" + name + "]");
    ScenarioAxis& axis = scenario_.axes[index];
    constexpr std::string_view kProgram = "program:";
    const std::string drive = from.text("drive");
    if (drive.starts_with(kProgram)) {
      axis.program = drive.substr(kProgram.size());
      axis.drive = model_beside(from, "data_sheet", from.text("data_sheet"));
    } else {
      axis.drive = model_beside(from, "drive", drive);
    }
    axis.drive.name = name;
    if (axis.drive.data.kind != sim::DriveKind::rotary) from.fail("drive", "scenarios run rotary drives only");
    for (const toml::table* effect : from.tables("effect")) read_effect(*effect, axis.drive);
    const std::string knowledge = from.optional_text("knowledge").value_or("truth");
    if (knowledge == "identified") {
      if (!axis.program.empty())
        from.fail("knowledge", "a program is identified by `axistool commission --plant`; name the model it makes");
      axis.knowledge = Knowledge::identified;
    } else if (knowledge != "truth") {
      axis.knowledge = Knowledge::model;
      axis.believed = model_beside(from, "knowledge", knowledge);
    }
    axis.zero_phase = from.toggle("zero_phase", true);
    axis.friction_feedforward = from.toggle("friction_feedforward", true);
    axis.disturbance_cancellation = from.toggle("disturbance_cancellation", false);
    axis.compensation = from.toggle("compensation", true);
    axis.limits.velocity = from.positive("velocity_limit_mm_s", axis.limits.velocity);
    axis.limits.acceleration = from.positive("acceleration_limit_mm_s2", axis.limits.acceleration);
    axis.limits.jerk = from.positive("jerk_limit_mm_s3", axis.limits.jerk);
    axis.tuning = read_tuning(from);
    axis.encoder_fault_input = from.toggle("encoder_fault_input", false);
    axis.wiring.positive_end = from.number("positive_switch_mm", axis.wiring.positive_end);
    axis.wiring.negative_end = from.number("negative_switch_mm", axis.wiring.negative_end);
    from.refuse_rest();
  }

  static double within(TomlFields& from, std::string_view key, double most) {
    const double value = from.number(key, 0.0);
    if (!(std::abs(value) <= most)) from.fail(key, fmt::format("it must be within {:g}", most));
    return value;
  }

  void read_table(TomlFields& top) {
    constexpr double kMost = 1e4;  // um, um/m, ppm
    if (const toml::table* table = top.sub_table("table")) {
      TomlFields from = fields(*table, "[table]");
      scenario_.table.squareness_um_m = within(from, "squareness_um_m", kMost);
      for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
        const std::string axis(kAxisNames[i]);
        sim::GuidewayErrors& errors = scenario_.table.axis[i];
        scenario_.table.centre_mm[i] = within(from, "centre_" + axis + "_mm", kLargest_mm);
        errors.scale_ppm = within(from, "scale_" + axis + "_ppm", kMost);
        errors.bow_um = within(from, "bow_" + axis + "_um", kMost);
        errors.play_um = within(from, "play_" + axis + "_um", kMost);
        errors.coupling_um_s2_m = within(from, "coupling_" + axis + "_um_s2_m", kMost);
      }
      from.refuse_rest();
    }
    if (const toml::table* table = top.sub_table("ballbar")) {
      TomlFields from = fields(*table, "[ballbar]");
      sim::BallbarSetting setting;
      for (std::size_t i = 0; i < hal::kAxisCount; ++i)
        setting.off_centre_um[i] = within(from, fmt::format("off_centre_{}_um", kAxisNames[i]), kMost);
      setting.length_um = within(from, "length_um", kMost);
      setting.noise_um = std::abs(within(from, "noise_um", kMost));
      from.refuse_rest();
      scenario_.ballbar = setting;
    }
  }

  static LoopTuning read_tuning(TomlFields& from) {
    LoopTuning tuning;
    tuning.bandwidth_Hz = from.positive("bandwidth_Hz", tuning.bandwidth_Hz);
    if (from.has("notch_Hz")) {
      Notch notch;
      notch.f_Hz = from.positive("notch_Hz", 0.0);
      notch.damping = from.positive("notch_damping", notch.damping);
      notch.depth = from.positive("notch_depth", notch.depth);
      tuning.filters.notch = notch;
    }
    if (from.has("low_pass_Hz")) tuning.filters.low_pass = LowPass{from.positive("low_pass_Hz", 0.0)};
    return tuning;
  }

  void read_effect(const toml::table& table, sim::DriveDescription& drive) const {
    TomlFields from = fields(table, "[[effect]]");
    const Names kinds = effect_kinds();
    const sim::EffectInfo& info = *sim::find_effect(kinds[from.choice("kind", kinds)]);
    sim::EffectEntry entry{std::string(info.kind), {}, {}, {}};
    for (const sim::ParameterInfo& parameter : info.parameters) {
      const std::string_view key = parameter.key(drive.data.kind);
      const auto value = from.optional_number(key);
      if (!value) continue;
      if (!(*value >= parameter.lower && *value <= parameter.upper))
        from.fail(key, fmt::format("{:g} is out of bounds, {:g} to {:g}", *value, parameter.lower, parameter.upper));
      entry.parameters[std::string(parameter.id)] = *value;
    }
    from.refuse_rest();
    if (sim::EffectEntry* there = drive.find(entry.kind); there != nullptr && !may_repeat(info))
      *there = std::move(entry);
    else
      drive.effects.push_back(std::move(entry));
    try {
      parse_model(format_model(drive), "the drive");  // checks parameters that are missing or exclude others
    } catch (const Failure& error) {
      from.fail("kind", fmt::format("{}; see axistool effects {}", error.what(), info.kind));
    }
  }

  void read_move(const toml::table& table) {
    TomlFields from = fields(table, "[[move]]");
    ScenarioMove move;
    move.at_s = time(from, "at_s");
    move.kind = static_cast<MoveKind>(from.choice("kind", kMoves));
    if (move.kind == MoveKind::circle || move.kind == MoveKind::square) {
      read_path(from, move);
    } else {
      move.axis = from.choice("axis", kAxes);
      if (move.kind == MoveKind::jog) move.speed_mm_s = from.number("speed_mm_s");
      if (move.kind == MoveKind::move_to) move.target_mm = from.number("target_mm");
      if (std::abs(move.target_mm) > kLargest_mm)
        from.fail("target_mm", fmt::format("it must be within {:g} mm", kLargest_mm));
    }
    from.refuse_rest();
    scenario_.moves.push_back(std::move(move));
  }

  static double length_mm(TomlFields& from, std::string_view key, double otherwise) {
    const double length = from.positive(key, otherwise);
    if (length > kLargest_mm) from.fail(key, fmt::format("it must be at most {:g} mm", kLargest_mm));
    return length;
  }

  static void read_path(TomlFields& from, ScenarioMove& move) {
    if (move.kind == MoveKind::circle) {
      const double radius = length_mm(from, "radius_mm", 35.0);
      const double turns = from.number("turns", 1.0);
      if (turns == 0.0 || std::abs(turns) > 100.0 || turns != static_cast<int>(turns))
        from.fail("turns", "expected a whole number from 1 to 100, or from -1 to -100 for clockwise");
      move.path = Path::circle(radius, static_cast<int>(turns));
    } else {
      const double side = length_mm(from, "side_mm", 40.0), corner = from.positive("corner_mm", 8.0);
      if (2.0 * corner >= side) from.fail("corner_mm", "it must be below half of side_mm");
      move.path = Path::rounded_square(side, corner);
    }
    move.path_limits.feed = from.positive("feed_mm_s", move.path_limits.feed);
    move.path_limits.acceleration = from.positive("acceleration_mm_s2", move.path_limits.acceleration);
    move.path_limits.jerk = from.positive("jerk_mm_s3", move.path_limits.jerk);
    if (move.path->length() / move.path_limits.feed > kLongestScenario_s)
      from.fail("feed_mm_s", fmt::format("the path would last longer than {:g} s", kLongestScenario_s));
  }

  void read_fault(const toml::table& table) {
    TomlFields from = fields(table, "[[fault]]");
    ScenarioFault fault;
    fault.at_s = time(from, "at_s");
    Names kinds;
    for (const InjectionInfo& info : injections()) kinds.push_back(info.kind);
    fault.injection = &injections()[from.choice("kind", kinds)];
    if (!fault.injection->of_board) fault.axis = from.choice("axis", kAxes);
    if (fault.injection->kind == "blocked" && !scenario_.axes[fault.axis].program.empty())
      from.fail("kind", "an external plant program cannot be blocked from here: let the program do it");
    if (!fault.injection->unit.empty()) fault.value = from.number("value", fault.injection->usual);
    if (std::abs(fault.value) > 1e5) from.fail("value", "it must be within 1e5");
    if (from.has("until_s")) fault.until_s = time(from, "until_s");
    from.refuse_rest();
    scenario_.faults.push_back(fault);
  }

  void read_expectation(const toml::table& table) {
    TomlFields from = fields(table, "[[expect]]");
    Expectation expected;
    expected.line = from.line();
    expected.axis = from.optional_choice("axis", kAxes).value_or(0);
    Names faults, states;
    for (const auto& info : firmware::kFaults) faults.emplace_back(info.name);
    for (const char* state : firmware::kStateNames) states.emplace_back(state);
    if (const auto place = from.optional_choice("fault", faults))
      expected.fault = static_cast<firmware::AxisFault>(*place);
    if (const auto place = from.optional_choice("state", states))
      expected.state = static_cast<firmware::SupervisorState>(*place);
    const Names signals(kSignals.begin(), kSignals.end());
    if (const auto place = from.optional_choice("signal", signals)) expected.signal = kSignals[*place];
    if (from.has("by_s")) expected.by_s = time(from, "by_s");
    expected.from_s = from.has("from_s") ? time(from, "from_s") : 0.0;
    expected.to_s = from.has("to_s") ? time(from, "to_s") : scenario_.duration_s;
    expected.at_most = from.optional_number("at_most");
    expected.at_least = from.optional_number("at_least");
    expected.aim = from.toggle("aim", false);
    expected.at_most_share = from.optional_number("at_most_share");
    if (expected.at_most_share) expected.of_axis = from.choice("of_axis", kAxes);
    from.refuse_rest();
    const bool bounded = expected.at_most || expected.at_least || expected.at_most_share;
    if (expected.signal.empty() == bounded)
      from.fail(bounded ? "at_most" : "signal", "signal needs at_most, at_least or at_most_share, and vice versa");
    if (expected.signal.empty() && !expected.fault && !expected.state)
      from.fail("signal", "nothing is expected; add fault, state, or signal with a bound");
    scenario_.expectations.push_back(std::move(expected));
  }

  std::string path_;
  toml::table root_;
  Scenario scenario_;
};

}  // namespace

std::vector<std::string> programs_of(const Scenario& scenario) {
  std::vector<std::string> commands;
  for (const ScenarioAxis& axis : scenario.axes)
    if (!axis.program.empty() && std::ranges::find(commands, axis.program) == commands.end())
      commands.push_back(axis.program);
  return commands;
}

Scenario parse_scenario(std::string_view text, const std::string& path) { return ScenarioReader(text, path).read(); }

Scenario read_scenario(const std::string& path) { return parse_scenario(read_file(path), path); }

}  // namespace host
