#include "host/device/fault_log.hpp"

#include <fmt/format.h>

#include "firmware/core/supervision/fault_latch.hpp"
#include "host/device/board_report.hpp"

namespace host {

namespace {

const char* activity_name(std::uint8_t activity) {
  return activity < firmware::kActivityNames.size() ? firmware::kActivityNames[activity] : "unknown";
}

double hours(std::uint32_t seconds) { return static_cast<double>(seconds) / 3600.0; }

/// Exception numbers: ARMv7-M Architecture Reference Manual, table B1-4.
const char* exception_name(std::uint8_t number) {
  switch (number) {
    case 2:
      return "non-maskable interrupt";
    case 3:
      return "hard fault";
    case 4:
      return "memory protection fault";
    case 5:
      return "bus fault";
    case 6:
      return "usage fault";
    default:
      return "exception";
  }
}

std::string enabled_axes(const firmware::LoggedFault& ended) {
  std::string names;
  for (std::size_t axis = 0; axis < firmware::kAxisNames.size(); ++axis)
    if ((ended.activity >> axis & 1) != 0)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", firmware::kAxisNames[axis]);
  return names;
}

std::string reset_line(const firmware::LoggedFault& ended) {
  std::string text = fmt::format("reset by {}", reset_text(ended.reset));
  if (ended.second_fault != 0)
    text = fmt::format("{} of the processor at {:#010x} (CFSR {:#010x})", exception_name(ended.second_fault),
                       ended.counts_low, static_cast<std::uint32_t>(ended.counts_high));
  const std::string enabled = enabled_axes(ended);
  return text + (enabled.empty() ? ", no axis enabled" : ", enabled: " + enabled);
}

nlohmann::json reset_json(const firmware::LoggedFault& ended) {
  nlohmann::json entry = {{"nth", ended.number},
                          {"run_h", hours(ended.run_s)},
                          {"reset", reset_text(ended.reset)},
                          {"enabled", enabled_axes(ended)}};
  if (ended.second_fault != 0)
    entry.update({{"exception", exception_name(ended.second_fault)},
                  {"address", ended.counts_low},
                  {"cfsr", static_cast<std::uint32_t>(ended.counts_high)}});
  return entry;
}

}  // namespace

std::string fault_log_text(const FaultLog& log, const firmware::ParameterValues* values) {
  std::string text;
  for (auto at = log.faults.rbegin(); at != log.faults.rend(); ++at) {
    const firmware::LoggedFault& one = *at;
    if (one.reset != 0) {
      text += fmt::format("#{:<4} {:9.2f} h  -  {}\n", one.number, hours(one.run_s), reset_line(one));
      continue;
    }
    const auto place = place_of_counts(one.counts(), one.axis, values);
    text += fmt::format(
        "#{:<4} {:9.2f} h  {}  {}, {}, at {}{}\n", one.number, hours(one.run_s), firmware::kAxisNames[one.axis],
        fault_text(one.fault, one.second_fault), activity_name(one.activity),
        place ? fmt::format("{:.4f} {}", place->value, place->unit) : fmt::format("{} counts", one.counts()),
        one.homed != 0 ? "" : " (not homed)");
  }
  return text;
}

nlohmann::json fault_log_json(const FaultLog& log, const firmware::ParameterValues* values) {
  nlohmann::json entries = nlohmann::json::array();
  for (const firmware::LoggedFault& one : log.faults) {
    if (one.reset != 0) {
      entries.push_back(reset_json(one));
      continue;
    }
    entries.push_back({{"nth", one.number},
                       {"run_h", hours(one.run_s)},
                       {"axis", firmware::kAxisNames[one.axis]},
                       {"fault", fault_name(one.fault)},
                       {"number", one.fault},
                       {"second_fault", fault_name(one.second_fault)},
                       {"activity", activity_name(one.activity)},
                       {"counts", one.counts()},
                       {"homed", one.homed != 0},
                       {"velocity", one.velocity},
                       {"dac_code", one.dac_code}});
    if (const auto place = place_of_counts(one.counts(), one.axis, values))
      entries.back().update({{"position", place->value}, {"position_unit", place->unit}});
  }
  return entries;
}

}  // namespace host
