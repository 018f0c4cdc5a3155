// axistool effects: the catalogue of physical effects.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/model/effect_forms.hpp"
#include "host/report/effect_pages.hpp"

namespace axistool {

namespace {

void run(const std::string& kind, const std::string& json) {
  const sim::EffectInfo* info = kind.empty() ? nullptr : &host::known_effect(kind);
  if (!json.empty()) write_json(info ? host::effects_json(*info) : host::effects_json(), json);
  if (json == "-") return;
  const host::Terminal terminal = host::terminal_of(stdout);
  if (info)
    fmt::print("{}", host::effect_page(*info, terminal));
  else
    fmt::print("{}\n`axistool effects KIND` shows the equation, the parameters and what to measure.\n",
               host::effect_list(terminal));
}

}  // namespace

void add_effects(CLI::App& app) {
  struct Arguments {
    std::string kind, json;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "effects", "The catalogue of effects: equation, how it shows, what it is confused with, what to measure");
  command->add_option("KIND", arguments->kind, "one effect in full; without it, the list");
  add_json_option(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  axistool effects\n"
      "  axistool effects backlash\n"
      "  axistool effects --json catalogue.json");
  command->callback([arguments] { run(arguments->kind, arguments->json); });
}

}  // namespace axistool
