// axistool completion: prints the script for a shell's tab key. axistool complete: called by that script.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/completion.hpp"

namespace axistool {

namespace {

// Each script calls `axistool complete` with the words up to the cursor. A line of the answer is a word, or a word, a
// tab and its help; ":files" and file endings request files.

constexpr const char* kBash = R"sh(# bash completion of axistool
_axistool() {
  local current=${COMP_WORDS[COMP_CWORD]} line ending file
  COMPREPLY=()
  while IFS= read -r line; do
    if [[ $line != :files* ]]; then
      COMPREPLY+=("${line%%$'\t'*}")
      continue
    fi
    compopt -o filenames
    while IFS= read -r file; do COMPREPLY+=("$file"); done < <(compgen -d -- "$current")
    set -f
    for ending in ${line#:files}; do
      while IFS= read -r file; do [[ -d $file ]] || COMPREPLY+=("$file"); done < <(
        if [[ $ending == '*' ]]; then compgen -f -- "$current"; else compgen -f -X "!*.$ending" -- "$current"; fi)
    done
    set +f
  done < <("${COMP_WORDS[0]}" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace
}
# NAME=VALUE and usb:SERIAL are one word.
COMP_WORDBREAKS=${COMP_WORDBREAKS//[=:]/}
complete -F _axistool axistool
)sh";

constexpr const char* kZsh = R"sh(#compdef axistool
_axistool() {
  local line word ending
  local -a described assigned
  for line in ${(f)"$("${words[1]}" complete -- "${(@)words[2,CURRENT]}" 2>/dev/null)"}; do
    if [[ $line == :files* ]]; then
      for ending in ${=line#:files}; do
        if [[ $ending == '*' ]]; then _files; else _files -g "*.$ending"; fi
      done
      continue
    fi
    word=${line%%$'\t'*}
    if [[ $word == *= ]]; then assigned+=($word); else described+=("${word//:/\\:}:${line#*$'\t'}"); fi
  done
  (( $#assigned )) && compadd -S '' -- $assigned
  (( $#described )) && _describe -t values value described
}
if [ "$funcstack[1]" = "_axistool" ]; then _axistool "$@"; else compdef _axistool axistool; fi
)sh";

constexpr const char* kFish = R"sh(# fish completion of axistool
function __axistool_complete
  set -l before (commandline -opc)
  set -l current (commandline -ct)
  axistool complete -- $before[2..-1] "$current" 2>/dev/null | while read -l line
    if not string match -q ':files*' -- $line
      echo $line
      continue
    end
    for ending in (string split -n ' ' -- (string replace ':files' '' -- $line))
      if test $ending = '*'
        __fish_complete_path "$current"
      else
        __fish_complete_suffix "$current" .$ending | string match -r '.*(?:/|\.'$ending')(?:\t.*)?$'
      end
    end
  end
end
complete -c axistool -f -a '(__axistool_complete)'
)sh";

void print_completions(const CLI::App& app, const std::vector<std::string>& words) {
  const Completions all = complete(app, words);
  for (const Completion& one : all.words) fmt::print("{}{}{}\n", one.word, one.help.empty() ? "" : "\t", one.help);
  if (!all.files.empty()) fmt::print(":files {}\n", fmt::join(all.files, " "));
}

}  // namespace

std::string completion_script(const std::string& shell) {
  return shell == "fish" ? kFish : shell == "zsh" ? kZsh : kBash;
}

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "completion", "Print a shell completion script for commands, options, effects, parameters and boards");
  command->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "Examples:\n"
      "  axistool completion bash > ~/.local/share/bash-completion/completions/axistool\n"
      "  axistool completion zsh > ~/.zfunc/_axistool      # where fpath has ~/.zfunc\n"
      "  axistool completion fish > ~/.config/fish/completions/axistool.fish\n"
      "An installed axistool needs none of these.");
  command->callback([shell] { fmt::print("{}", completion_script(*shell)); });

  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* asked = app.add_subcommand("complete", "candidates for the end of a command line, for the scripts");
  asked->group("");  // for scripts: not in the list
  asked->add_option("WORD", *words, "words after the program's name; the last one is incomplete");
  asked->callback([words, &app] { print_completions(app, *words); });
}

}  // namespace axistool
