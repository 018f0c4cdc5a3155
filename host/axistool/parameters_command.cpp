// axistool parameters: the table of the board's parameters; needs no board.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/parameters/parameter_names.hpp"
#include "host/parameters/parameter_page.hpp"

namespace axistool {

namespace {

struct ParametersArguments {
  std::string filter, json;
  bool markdown = false;
};

void run(const ParametersArguments& arguments) {
  if (!arguments.json.empty()) write_json(host::parameter_table_json(), arguments.json);
  if (arguments.json == "-") return;
  if (arguments.markdown) {
    fmt::print("{}", host::parameter_page());
    return;
  }
  bool found = false;
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place) {
    const std::string name = host::full_name(place);
    if (name.find(arguments.filter) == std::string::npos) continue;
    found = true;
    const firmware::ParameterInfo& info = host::info_at(place);
    fmt::print("{:<30} {} to {}, initially {}{}{}\n{:<30} {}\n", name, host::value_text(info, info.minimum),
               host::value_text(info, info.maximum), host::value_text(info, info.initial), info.unit.empty() ? "" : " ",
               host::unit_text(info), "", info.doc);
  }
  if (!found)
    throw host::Failure(host::ExitCode::usage,
                        fmt::format("no parameter's name contains '{}'{}; `axistool parameters` lists all",
                                    arguments.filter, host::parameter_hint(arguments.filter)));
}

}  // namespace

void add_parameters(CLI::App& app) {
  auto arguments = std::make_shared<ParametersArguments>();
  CLI::App* command =
      app.add_subcommand("parameters", "list the board's parameters: range, unit, initial value, meaning");
  command->add_option("PART", arguments->filter, "only parameters whose name contains this");
  command->add_flag("--markdown", arguments->markdown, "print the documentation page");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool parameters\n"
      "  axistool parameters x.kalman\n"
      "  axistool parameters --json -\n"
      "`axistool get-params` reads the values of a board.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
