// axistool completion: words for the shell's tab key, from the commands themselves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/parameters/parameter_names.hpp"

namespace axistool {

namespace {

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  return words;
}

/// What may stand behind a command besides its options and files.
std::vector<std::string> arguments_of(const CLI::App& command) {
  const std::string& name = command.get_name();
  if (name == "get-params") return host::all_parameter_names();
  if (name == "set-params") {
    std::vector<std::string> words = host::all_parameter_names();
    for (std::string& word : words) word += "=";
    return words;
  }
  if (name == "enable" || name == "disable" || name == "jog" || name == "move") return {"x", "y"};
  if (name == "completion") return {"bash", "zsh", "fish"};
  return {};
}

std::string bash_script(const CLI::App& app) {
  std::vector<std::string> names;
  std::string cases;
  for (const CLI::App* command : commands_of(app)) {
    names.push_back(command->get_name());
    cases += fmt::format("    {}) words=\"{} {}\" ;;\n", command->get_name(), fmt::join(options_of(*command), " "),
                         fmt::join(arguments_of(*command), " "));
  }
  return fmt::format(
      "_axistool() {{\n"
      "  local words current=${{COMP_WORDS[COMP_CWORD]}}\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then COMPREPLY=($(compgen -W \"{}\" -- \"$current\")); return; fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\") $(compgen -f -- \"$current\"))\n"
      "  case ${{COMPREPLY[0]}} in *=) compopt -o nospace ;; esac\n"
      "}}\n"
      "COMP_WORDBREAKS=${{COMP_WORDBREAKS//=/}}\n"
      "complete -o filenames -F _axistool axistool\n",
      fmt::join(names, " "), cases);
}

std::string fish_script(const CLI::App& app) {
  std::string script = "complete -c axistool -n __fish_use_subcommand -f\n";
  for (const CLI::App* command : commands_of(app)) {
    const std::string& name = command->get_name();
    std::string description = command->get_description();
    std::erase(description, '\'');
    script += fmt::format("complete -c axistool -n __fish_use_subcommand -a {} -d '{}'\n", name, description);
    for (const std::string& option : options_of(*command))
      script += fmt::format("complete -c axistool -n '__fish_seen_subcommand_from {}' -l {}\n", name, option.substr(2));
    if (const auto words = arguments_of(*command); !words.empty())
      script += fmt::format("complete -c axistool -n '__fish_seen_subcommand_from {}' -a '{}'\n", name,
                            fmt::join(words, " "));
  }
  return script;
}

}  // namespace

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "Script that teaches a shell the commands, options and parameters");
  command->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "Examples:\n"
      "  axistool completion bash > ~/.local/share/bash-completion/completions/axistool\n"
      "  axistool completion zsh >> ~/.zshrc\n"
      "  axistool completion fish > ~/.config/fish/completions/axistool.fish");
  command->callback([shell, &app] {
    if (*shell == "fish")
      fmt::print("{}", fish_script(app));
    else
      fmt::print("{}{}", *shell == "zsh" ? "autoload -Uz bashcompinit && bashcompinit\n" : "", bash_script(app));
  });
}

}  // namespace axistool
