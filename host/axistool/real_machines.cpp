#include "host/axistool/real_machines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/axistool/insight_arguments.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/scoreboard/real_machine.hpp"

namespace axistool {

namespace {

std::string percent(double relative) { return fmt::format("{:.1f}", 100.0 * relative); }

void print(const std::string& name, const host::RealAnswer& answer, std::size_t width) {
  const host::DiagnosisVerdict& verdict = answer.diagnosis.verdict;
  const host::EffortScreen* screen = answer.diagnosis.screen.get();
  const std::vector<double> orders = host::orders_of(answer.diagnosis);
  fmt::print("{:<{}}  {:<5} {:>8} {:>8} {:6.1f}  {} {}{}{}\n", name, width, answer.is_right() ? "right" : "wrong",
             screen == nullptr ? "-" : percent(screen->base.validate),
             screen == nullptr ? "-" : percent(screen->best().validate), answer.seconds,
             host::status_name(verdict.status), fmt::join(verdict.effects, ", "),
             orders.empty() ? "" : fmt::format(" orders {:g}", fmt::join(orders, " ")),
             answer.not_there.empty() ? "" : fmt::format("; not there: {}", fmt::join(answer.not_there, ", ")));
  std::fflush(stdout);
}

nlohmann::json to_json(const std::string& name, const host::RealAnswer& answer) {
  const host::Diagnosis& diagnosis = answer.diagnosis;
  nlohmann::json document = {{"machine", name},
                             {"right", answer.is_right()},
                             {"not_there", answer.not_there},
                             {"status", std::string(host::status_name(diagnosis.verdict.status))},
                             {"effects", diagnosis.verdict.effects},
                             {"alternatives", diagnosis.verdict.alternatives},
                             {"seconds", answer.seconds}};
  if (diagnosis.screen)
    document["relative_error"] = {{"before", diagnosis.screen->base.validate},
                                  {"after", diagnosis.screen->best().validate}};
  return document;
}

}  // namespace

void score_real_machines(const std::string& folder, const std::string& json) {
  const std::vector<host::RealMachine> machines = host::read_real_machines(folder);
  std::size_t width = 7;
  for (const host::RealMachine& machine : machines) width = std::max(width, machine.name.size());
  const bool talks = json != "-";
  if (talks)
    fmt::print("{:<{}}  {:<5} {:>8} {:>8} {:>6}  {}\n", "machine", width, "", "before %", "after %", "s", "verdict");
  nlohmann::json rows = nlohmann::json::array();
  std::size_t right = 0;
  for (const host::RealMachine& machine : machines) {
    SearchProgress progress(machine.name);
    const host::RealAnswer answer = host::ask(machine, progress.callback());
    if (talks) print(machine.name, answer, width);
    rows.push_back(to_json(machine.name, answer));
    right += answer.is_right() ? 1 : 0;
  }
  if (talks)
    fmt::print(
        "\n"
        "{} of {} right. Errors are shares of torque or force unexplained on validation data by least squares; before: "
        "inertia and friction, after: with the verdict's effects.\n",
        right, machines.size());
  if (!json.empty()) write_json({{"format", "axis-real-machines/1"}, {"machines", rows}}, json);
}

}  // namespace axistool
