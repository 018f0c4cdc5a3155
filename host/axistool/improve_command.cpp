// axistool improve: diagnose and add until no further effect is significant; axistool add: adds one named effect.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/insight_arguments.hpp"
#include "host/diagnose/addition.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/improvement_report.hpp"
#include "host/identify/plausibility.hpp"
#include "host/model/effect_forms.hpp"
#include "host/report/terminal.hpp"
#include "host/statistics.hpp"

namespace axistool {

namespace {

void print_doubts(const sim::DriveDescription& model) {
  for (const std::string& warning : host::messages_of(host::doubts_of(model))) fmt::print("warning: {}\n", warning);
}

void print(const host::Improvement& improvement, const host::ImprovementFiles& files) {
  const host::Terminal terminal = host::terminal_of(stdout);
  print_log(improvement.first.log);
  fmt::print("{}\n", host::terminal_bars(host::ladder_chart(improvement), terminal));
  print_doubts(improvement.model);
  fmt::print("{}", host::terminal_verdict(host::improvement_verdict(improvement, files), terminal));
}

void run_improve(const InsightArguments& arguments) {
  for (const std::string& kind : arguments.absent) host::known_effect(kind);
  const InsightRecords records(arguments);
  host::Improvement improvement;
  {
    SearchProgress progress("improve");
    improvement = host::improve(records.model, records.measurements, progress.callback(), arguments.absent);
  }
  host::write_model(improvement.model, arguments.output);
  const host::ImprovementFiles files{arguments.model, arguments.output};
  if (!arguments.report.empty()) host::write_improvement_report(improvement, files, arguments.report);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::to_json(improvement, arguments.output);
    document["warnings"] = host::messages_of(host::doubts_of(improvement.model));
    write_json(document, arguments.json);
  }
  if (arguments.json != "-") print(improvement, files);
  if (improvement.is_refused) end_with(host::ExitCode::answer_is_no);
}

void print(const host::Addition& addition, const std::string& kind, const std::string& output,
           const std::vector<host::LogFault>& log) {
  print_log(log);
  fmt::print("{}: prediction error over noise floor on held-back records {:.3f} -> {:.3f} ({:.1f} % confidence)\n\n",
             kind, addition.given.validate.combined, addition.error.validate.combined,
             100.0 * addition.judged.confidence);
  fmt::print("  {:<32} {:>12} {:>12}\n", "parameter", "value", "+- (95 %)");
  for (const host::ParameterEstimate& estimate : addition.estimates) {
    fmt::print("  {:<32} {:>12.5g} {:>12.2g}{}{}\n", estimate.name, estimate.value,
               host::kNormal95 * estimate.deviation, estimate.determined ? "" : "  not determined by these data",
               estimate.correlated_with.empty()
                   ? ""
                   : fmt::format("  correlated with {} ({:+.2f})", estimate.correlated_with, estimate.correlation));
  }
  if (addition.kept_given) {
    fmt::print("The addition predicts the held-back records worse: {} contains the unchanged model.\n", output);
    return;
  }
  print_doubts(addition.judged.model);
  fmt::print("Model written to {}\n", output);
}

void run_add(const InsightArguments& arguments, const std::string& kind, const std::string& over) {
  for (const std::string& one : host::added_kinds(kind)) host::known_effect(one);
  const InsightRecords records(arguments);
  const host::Addition addition = host::add_kind(records.model, kind, over, records.measurements);
  const host::JudgedCandidate& judged = addition.judged;
  host::write_model(judged.model, arguments.output);
  if (!arguments.json.empty())
    write_json(host::to_json(addition, kind, records.measurements, arguments.output), arguments.json);
  if (arguments.json != "-") print(addition, kind, arguments.output, records.measurements.log());
  if (addition.kept_given) end_with(host::ExitCode::answer_is_no);
}

}  // namespace

void add_improve(CLI::App& app) {
  auto arguments = std::make_shared<InsightArguments>();
  CLI::App* command = app.add_subcommand("improve", "diagnose and add effects until no further effect is significant");
  arguments->add_to(*command);
  add_output(*command, "-o,--output", arguments->output, "the improved model")->required();
  add_output(*command, "--report", arguments->report, "write a self-contained HTML report to this file");
  command->footer("Example:\n  axistool improve x.toml --train steps.csv jog.csv --validate other.csv -o better.toml");
  command->callback(
      [arguments] { with_log_of_failure(arguments->json, "axis-improvement/1", [&] { run_improve(*arguments); }); });
}

void add_add(CLI::App& app) {
  auto arguments = std::make_shared<InsightArguments>();
  auto kind = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("add", "add effects to a model and fit all parameters again");
  add_input(*command, "model", arguments->model, "model file (axis-model/1)")->required();
  command->add_option("kind", *kind, "effect to add, or several joined by +; axistool effects lists them")->required();
  add_input(*command, "--train", arguments->train, "training records")->required();
  add_input(*command, "--validate", arguments->validate, "validation records");
  add_output(*command, "-o,--output", arguments->output, "the new model")->required();
  add_accept_option(*command, arguments->accepted);
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool add x.toml cogging --train jog.csv --validate other.csv -o x-cogging.toml\n"
      "  axistool add x.toml backlash+cogging --train jog.csv --validate other.csv -o both.toml");
  auto over = std::make_shared<std::string>();
  command->add_option("--over", *over,
                      "coordinate of a free_curve; default: the one with the smallest validation error");
  command->callback([arguments, kind, over] {
    with_log_of_failure(arguments->json, "axis-addition/1", [&] { run_add(*arguments, *kind, *over); });
  });
}

}  // namespace axistool
