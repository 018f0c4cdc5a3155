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

}  // namespace

std::string fault_log_text(const FaultLog& log, const firmware::ParameterValues* values) {
  std::string text;
  for (auto at = log.faults.rbegin(); at != log.faults.rend(); ++at) {
    const firmware::LoggedFault& one = *at;
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
