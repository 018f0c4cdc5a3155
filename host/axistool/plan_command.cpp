// axistool plan: plans the run that best separates the remaining explanations.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <tuple>

#include "host/axistool/commands.hpp"
#include "host/axistool/insight_arguments.hpp"
#include "host/plan/plan_json.hpp"
#include "host/plan/plan_report.hpp"

namespace axistool {

namespace {

struct PlanArguments : InsightArguments {
  std::string box;
  std::vector<std::string> rivals;
  double most_steps = host::PlanOptions{}.most_steps;
};

/// "cogging,torque_ripple" or several words; "cogging+backlash" is one rival of two effects.
std::vector<std::vector<std::string>> kinds_of(const std::vector<std::string>& words) {
  std::vector<std::vector<std::string>> rivals;
  for (const std::string& word : words) {
    rivals.emplace_back();
    for (std::size_t begin = 0; begin <= word.size();) {
      const std::size_t end = std::min(word.find('+', begin), word.size());
      rivals.back().push_back(word.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return rivals;
}

void print(const host::Plan& plan, const std::string& file) {
  fmt::print("Probabilities of the rivals before the run:\n");
  for (const host::Rival& rival : plan.rivals)
    fmt::print("  {:<40} {:5.1f}%\n", host::rival_name(rival.kinds), 100.0 * rival.probability);
  if (plan.separable) {
    fmt::print("\nA run of {:.3g} s ({}), within the box:\n", plan.run.duration_s(), file);
    for (const host::RunPiece& piece : plan.run.pieces) fmt::print("  {}\n", host::piece_text(piece));
    fmt::print("\nExpected odds:\n");
    for (const host::PairOutlook& pair : plan.pairs) {
      if (!pair.separable) continue;
      for (const auto& [truth, other, odds] :
           {std::tuple{pair.a, pair.b, pair.odds_if_a}, {pair.b, pair.a, pair.odds_if_b}})
        fmt::print("  if it is {}: {} against {}\n", host::rival_name(plan.rivals[truth].kinds), host::odds_text(odds),
                   host::rival_name(plan.rivals[other].kinds));
    }
    fmt::print(
        "Make it: axistool excite AXIS {} -o run.csv; then diagnose with --train … run.csv --believed PLAN.json\n",
        file);
  }
  if (!plan.by_hand.empty()) fmt::print("\nNo motion in this box separates:\n  {}\n", plan.by_hand);
  fmt::print("\n{} pieces were simulated{}.\n", plan.considered.size(),
             plan.cut_short ? "; the budget ended before all were tried (--most-samples)" : "");
}

void run(const PlanArguments& arguments) {
  const InsightRecords records(arguments);
  const host::ExcitationLimits box = host::parse_box(arguments.box, records.model.data.kind);
  const std::vector<const host::Record*> all = records.measurements.all_records();
  std::vector<host::Rival> rivals;
  {
    SearchProgress progress("rivals");
    rivals =
        host::rivals_for(records.model, records.measurements, all, kinds_of(arguments.rivals), progress.callback());
  }
  host::Plan plan;
  {
    SearchProgress progress("plan");
    host::PlanOptions options;
    options.most_steps = arguments.most_steps;
    plan = host::plan_run(records.model, all, rivals, box, options, progress.callback());
  }
  if (plan.separable) host::write_run_plan(plan.run, arguments.output);
  if (!arguments.report.empty()) host::write_plan_report(plan, arguments.model, arguments.output, arguments.report);
  if (!arguments.json.empty()) write_json(host::to_json(plan, arguments.output), arguments.json);
  if (arguments.json != "-") print(plan, arguments.output);
}

}  // namespace

void add_plan(CLI::App& app) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = app.add_subcommand("plan", "plan the run that separates the remaining explanations");
  arguments->add_to(*command);
  command
      ->add_option("--rivals", arguments->rivals,
                   "explanations to separate; default: those that diagnose cannot separate")
      ->delimiter(',')
      ->expected(1, -1);
  command->add_option("--box", arguments->box, "travel=…,speed=…,volts=…,time=…: mm (linear: m), mm/s, V, s")
      ->required();
  add_output(*command, "-o,--output", arguments->output, "file of the run, for excite")->required();
  add_output(*command, "--report", arguments->report, "write a self-contained HTML report to this file");
  command->add_option("--most-samples", arguments->most_steps, "limit of simulated samples")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->footer(
      "Example:\n"
      "  axistool plan x.toml --train steps.csv --rivals backlash,compliance \\\n"
      "    --box travel=40,speed=100,volts=3,time=10 -o run.toml --json plan.json\n"
      "  axistool excite x run.toml -o run.csv\n"
      "  axistool diagnose x.toml --train steps.csv run.csv --believed plan.json\n"
      "Simulates candidate motions with each explanation as the truth, under the controller of `axistool design "
      "MODEL`,\n"
      "and keeps those that the other explanations fit worst after refitting. States the expected odds.\n"
      "If no motion in the box separates them, it says which test would. Exit code 0 in both cases; 1 if diagnose "
      "leaves\n"
      "only one explanation.");
  command->callback([arguments] { with_log_of_failure(arguments->json, "axis-plan/1", [&] { run(*arguments); }); });
}

}  // namespace axistool
