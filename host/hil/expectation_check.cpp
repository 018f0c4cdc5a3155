#include "host/hil/expectation_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/report/text_format.hpp"

namespace host {

namespace {

using firmware::AxisFault;

CheckedExpectation check_fault(const Expectation& expected, const ScenarioRun& run) {
  CheckedExpectation checked;
  const auto& info = firmware::fault_info(*expected.fault);
  checked.text = fmt::format("axis {}: fault {}", kAxisNames[expected.axis], info.name);
  if (expected.by_s) checked.text += fmt::format(" by {:g} s", *expected.by_s);
  const auto own = [&](const StopEvent& stop) { return stop.axis == expected.axis; };
  const auto first = std::ranges::find_if(run.stops, own);
  if (first == run.stops.end()) {
    checked.found = "no fault";
    checked.holds = *expected.fault == AxisFault::none;
    return checked;
  }
  checked.found = fmt::format("{} at {:g} s", firmware::fault_info(first->fault).name, first->at_s);
  checked.holds = first->fault == *expected.fault && (!expected.by_s || first->at_s <= *expected.by_s);
  return checked;
}

CheckedExpectation check_state(const Expectation& expected, const ScenarioRun& run) {
  const auto last =
      static_cast<firmware::SupervisorState>(static_cast<int>(run.records[expected.axis].extra[0].values.back()));
  return {fmt::format("axis {}: {} at the end", kAxisNames[expected.axis], firmware::state_name(*expected.state)),
          firmware::state_name(last), last == *expected.state, false};
}

const std::vector<double>& signal_of(const Expectation& expected, std::size_t axis, const ScenarioRun& run) {
  const Record& record = run.records[axis];
  if (expected.signal == "tracking_um") return run.tracking_um[axis];
  if (expected.signal == "table_um") return run.table_um[axis];
  if (expected.signal == "contour_um") return run.contour_um;
  if (expected.signal == "speed_rad_s") return record.w;
  if (expected.signal == "disturbance_V") return run.disturbance_V[axis];
  if (expected.signal == "command_V") return record.u_V;
  return record.x;
}

double largest_of(const Expectation& expected, std::size_t axis, const ScenarioRun& run) {
  double largest = 0.0;
  const std::vector<double>& values = signal_of(expected, axis, run);
  const std::vector<double>& t_s = run.records[axis].t_s;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (t_s[k] >= expected.from_s && t_s[k] <= expected.to_s) largest = std::max(largest, std::abs(values[k]));
  return largest;
}

CheckedExpectation check_signal(const Expectation& expected, const ScenarioRun& run) {
  const double largest = largest_of(expected, expected.axis, run);
  CheckedExpectation checked;
  checked.text = expected.signal == "contour_um"
                     ? std::string("largest contour_um")
                     : fmt::format("axis {}: largest |{}|", kAxisNames[expected.axis], expected.signal);
  if (expected.at_most) checked.text += fmt::format(" at most {:g}", *expected.at_most);
  if (expected.at_least) checked.text += fmt::format(" at least {:g}", *expected.at_least);
  checked.text += fmt::format(", {:g} to {:g} s", expected.from_s, expected.to_s);
  checked.found = format_value(largest, 3);
  checked.holds =
      (!expected.at_most || largest <= *expected.at_most) && (!expected.at_least || largest >= *expected.at_least);
  if (expected.at_most_share) {
    const double other = largest_of(expected, *expected.of_axis, run);
    checked.text +=
        fmt::format(", at most {:g} times that of axis {}", *expected.at_most_share, kAxisNames[*expected.of_axis]);
    checked.found += fmt::format(" of {}", format_value(other, 3));
    checked.holds = checked.holds && largest <= *expected.at_most_share * other;
  }
  return checked;
}

CheckedExpectation merge(const CheckedExpectation& a, const CheckedExpectation& b) {
  if (a.text.empty()) return b;
  return {a.text + "; " + b.text, a.found + "; " + b.found, a.holds && b.holds, a.aim};
}

}  // namespace

CheckedExpectation check_expectation(const Expectation& expected, const ScenarioRun& run) {
  CheckedExpectation all;
  if (expected.fault) all = merge(all, check_fault(expected, run));
  if (expected.state) all = merge(all, check_state(expected, run));
  if (!expected.signal.empty()) all = merge(all, check_signal(expected, run));
  all.aim = expected.aim;
  return all;
}

}  // namespace host
