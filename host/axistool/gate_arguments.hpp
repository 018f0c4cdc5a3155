// For all commands that read records: the gate checks them, and its findings are printed first.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "host/axistool/json_output.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/evidence/measurement_gate.hpp"

namespace axistool {

/// The option --accept.
inline void add_accept_option(CLI::App& command, std::vector<std::string>& accepted) {
  command
      .add_option("--accept", accepted,
                  "continue despite this log fault (sign, unit, swapped, clipped, jump, …); repeatable")
      ->expected(1)
      ->take_all();
}

/// Runs `work`; if a fault of the log ends it, the JSON document states the fault.
template <typename Work>
void with_log_of_failure(const std::string& json, const std::string& format, Work work) {
  try {
    work();
  } catch (const host::FaultyLog& refused) {
    if (!json.empty()) write_json({{"format", format}, {"log", host::log_faults_json(refused.faults)}}, json);
    throw;
  }
}

/// Printed first: doubts about the records, and accepted faults.
inline void print_log(const std::vector<host::LogFault>& log) {
  for (const host::LogFault& fault : log)
    fmt::print("{} of the log ({}): {}\n", fault.accepted ? "Accepted fault" : "Doubt",
               host::log_fault_family(fault.kind), fault.message);
  if (!log.empty()) fmt::print("\n");
}

}  // namespace axistool
