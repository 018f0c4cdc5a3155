#include "host/axistool/man_page.hpp"

#include <fmt/format.h>

#include <build_version.hpp>

#include "host/axistool/commands.hpp"

namespace axistool {

namespace {

/// Escapes backslashes, hyphens and leading dots for troff.
std::string roff(const std::string& text) {
  std::string safe;
  bool at_line_start = true;
  for (const char letter : text) {
    if (at_line_start && (letter == '.' || letter == '\'')) safe += "\\&";
    if (letter == '\\')
      safe += "\\e";
    else if (letter == '-')
      safe += "\\-";
    else
      safe += letter;
    at_line_start = letter == '\n';
  }
  return safe;
}

std::string sentence(std::string text) {
  if (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

/// "--drive TEXT", "-o, --output TEXT", "RECORD ...", "AXIS, --axis".
std::string names_of(const CLI::Option& option) {
  std::string names;
  if (option.get_positional()) {
    names = option.get_name(true, false) + (option.get_items_expected_max() > 1 ? " ..." : "");
    for (const std::string& name : option.get_lnames()) names += ", --" + name;
    return names;
  }
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
  for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
  if (option.get_type_size() == 0) return names;
  const std::string type = option.get_type_name();
  const std::size_t open = type.find(":{");
  return names + " " + (open == std::string::npos ? type.substr(0, type.find(':')) : type.substr(open + 1));
}

std::string described(const CLI::Option& option) {
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += fmt::format(" (default {})", option.get_default_str());
  if (!option.get_envname().empty()) text += fmt::format(" (or the environment variable {})", option.get_envname());
  return fmt::format(".TP\n.B {}\n{}\n", roff(names_of(option)), roff(text));
}

std::string options_of(const CLI::App& command) {
  std::string positionals, options;
  for (const CLI::Option* option : command.get_options())
    (option->get_positional() ? positionals : options) += described(*option);
  return (positionals.empty() ? "" : ".SH ARGUMENTS\n" + positionals) + ".SH OPTIONS\n" + options;
}

std::string synopsis_of(const CLI::App& command) {
  std::string text = ".B axistool " + command.get_name() + "\n[\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name =
        "\\fI" + roff(option->get_name(true, false)) + "\\fR" + (option->get_items_expected_max() > 1 ? " ..." : "");
    text += " " + (option->get_required() ? name : "[" + name + "]");
  }
  return text + "\n";
}

/// A footer begins with "Example:" or "Examples:" and its indented lines; remarks follow.
std::string examples_of(const CLI::App& command) {
  std::string examples, notes;
  for (const std::string& line : CLI::detail::split(command.get_footer(), '\n')) {
    if (line == "Example:" || line == "Examples:" || line.empty()) continue;
    (line.starts_with("  ") ? examples : notes) += roff(line) + "\n";
  }
  std::string text;
  if (!notes.empty()) text += ".SH NOTES\n" + notes;
  if (!examples.empty()) text += ".SH EXAMPLES\n.nf\n" + examples + ".fi\n";
  return text;
}

std::string head(const std::string& name, const std::string& what) {
  std::string capital = name;
  for (char& letter : capital) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return fmt::format(".TH {} 1 \"\" \"axistool {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", capital, AXIS_VERSION,
                     roff(name), roff(sentence(what)));
}

std::string program_page(const CLI::App& app) {
  std::string text = head("axistool", "identify feed drives, compare models with measurements, find what is missing");
  text += ".SH SYNOPSIS\n.B axistool\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n" +
          roff(app.get_description()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app))
    text += fmt::format(".TP\n.BR {} (1)\n{}\n", roff("axistool-" + command->get_name()),
                        roff(sentence(command->get_description())));
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) text += described(*option);
  return text + ".SH EXIT STATUS\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
}

}  // namespace

std::string man_page(const CLI::App& app, const CLI::App& command) {
  if (&command == &app) return program_page(app);
  const std::string name = "axistool-" + command.get_name();
  return head(name, command.get_description()) + ".SH SYNOPSIS\n" + synopsis_of(command) + options_of(command) +
         examples_of(command) + ".SH SEE ALSO\n.BR axistool (1)\n";
}

}  // namespace axistool
