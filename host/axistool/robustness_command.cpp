// axistool robustness: contour error of a machine that differs from its models.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/hil/robustness.hpp"
#include "host/model/model_file.hpp"

namespace axistool {

namespace {

struct RobustnessArguments {
  std::vector<std::string> models, params;
  std::string json, report, axis = "both";
  host::RobustnessOptions options;
};

void run(const RobustnessArguments& arguments) {
  if (arguments.models.size() != hal::kAxisCount)
    throw host::Failure(host::ExitCode::usage,
                        fmt::format("give the models of both axes, X.toml Y.toml: {} given", arguments.models.size()));
  if (!arguments.params.empty() && arguments.params.size() != arguments.models.size())
    throw host::Failure(host::ExitCode::usage,
                        fmt::format("--params: {} files for {} axes; give one of each axis, in the order of the models",
                                    arguments.params.size(), arguments.models.size()));
  host::RobustnessMachine machine;
  for (std::size_t i = 0; i < machine.size(); ++i)
    machine[i] = host::robustness_axis(host::read_model(arguments.models[i]),
                                       arguments.params.empty() ? "" : arguments.params[i]);
  const host::Robustness found = host::find_robustness(machine, arguments.options);
  if (!arguments.report.empty())
    host::robustness_report(found, fmt::format("{}", fmt::join(arguments.models, ", "))).write(arguments.report);
  if (!arguments.json.empty()) write_json(host::robustness_json(found), arguments.json);
  if (arguments.json != "-") fmt::print("{}", host::robustness_text(found, host::terminal_of(stdout)));
}

}  // namespace

void add_robustness(CLI::App& app) {
  auto arguments = std::make_shared<RobustnessArguments>();
  CLI::App* command =
      app.add_subcommand("robustness", "contour error if the machine differs from its models, for several controllers");
  add_input(*command, "MODEL", arguments->models, "models of both axes (axis-model/1)")->required();
  add_input(*command, "--params", arguments->params,
            "board parameters of both axes (axis-params/1, from design), in the order of the models; default: a design "
            "with default settings");
  command->add_option("--radius", arguments->options.radius_mm, "radius of the circle, mm")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command->add_option("--feed", arguments->options.feed_mm_s, "feed along it, mm/s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--axis", arguments->axis, "axes that differ from their models")
      ->check(CLI::IsMember({"both", "x", "y"}))
      ->capture_default_str();
  add_output(*command, "--report", arguments->report,
             "HTML page: curves of the error over each change, one for each controller");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool robustness x.toml y.toml\n"
      "  axistool robustness x.toml y.toml --params machine/x-params.toml machine/y-params.toml --report robust.html\n"
      "Simulates a circle with the firmware's axes, on drives whose inertia is up to 20 % and whose friction is up to "
      "30 %\n"
      "above or below the model's, or whose delay is up to one control period longer. Controllers: feedback (with the\n"
      "reference velocity), with zero-phase feed-forward (ZPETC) too, with friction feed-forward too, with "
      "cancellation "
      "of\n"
      "the estimated disturbance too. Strong feed-forward depends on its model: measure again the parameters that\n"
      "make the largest difference.");
  command->callback([arguments] {
    arguments->options.differs = {arguments->axis != "y", arguments->axis != "x"};
    run(*arguments);
  });
}

}  // namespace axistool
