// axistool help, axistool --version.
#include <fmt/format.h>

#include <build_version.hpp>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/nearest_name.hpp"

namespace axistool {

namespace {

const CLI::App& command_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : commands_of(app))
    if (command->get_name() == name) return *command;
  throw host::Failure(host::ExitCode::usage, no_command(app, name));
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::string no_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::App* command : commands_of(app)) known.push_back(command->get_name());
  const std::vector<std::string_view> names(known.begin(), known.end());
  return fmt::format("there is no command '{}'{}; axistool --help lists them", name, host::did_you_mean(name, names));
}

void add_help(CLI::App& app) {
  app.set_version_flag("--version", std::string("axistool " AXIS_VERSION ", commit " AXIS_GIT_HASH));
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("help", "show what a command does, its options and examples");
  command->add_option("COMMAND", *name, "the command; without it, the list of all");
  command->footer("Example:\n  axistool help identify");
  command->callback(
      [name, &app] { fmt::print("{}", name->empty() ? app.help() : command_named(app, *name).help(app.get_name())); });
}

}  // namespace axistool
