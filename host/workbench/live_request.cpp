#include "host/workbench/live_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "host/workbench/request_fields.hpp"

namespace host::workbench {

namespace {

using Action = MotionRequest::Action;
constexpr std::array kActions{std::pair{"enable", Action::enable},
                              std::pair{"disable", Action::disable},
                              std::pair{"jog", Action::jog},
                              std::pair{"move", Action::move},
                              std::pair{"halt", Action::halt},
                              std::pair{"home", Action::home},
                              std::pair{"home_here", Action::home_here},
                              std::pair{"clear_faults", Action::clear_faults}};

/// Printable characters of a line, for names of channels and parameters, values and events.
std::string line_of(const std::string& text, const std::string& field) {
  constexpr std::size_t kLongestLine = 120;
  if (text.empty() || text.size() > kLongestLine ||
      !std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; }))
    refuse(field, fmt::format("expected 1 to {} printable characters", kLongestLine));
  return text;
}

std::uint64_t row_of(const nlohmann::json& object, const std::string& field) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_number_unsigned()) refuse(field, "expected a whole number");
  return found->get<std::uint64_t>();
}

double seconds_of(const nlohmann::json& object, const std::string& field) {
  constexpr double kLongest_s = 3600.0;
  const auto found = object.find(field);
  const double seconds = found == object.end() ? -1.0 : number_of(*found, field);
  if (!(seconds >= 0.0) || seconds > kLongest_s) refuse(field, "expected seconds, 0 to 3600");
  return seconds;
}

}  // namespace

std::string parse_owner(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"owner"});
  return text_of(document, "owner");
}

MotionRequest parse_motion(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"owner", "do", "axis", "velocity", "position"});
  const std::string name = text_of(document, "do");
  const auto* const action = std::ranges::find(kActions, name, &std::pair<const char*, Action>::first);
  if (action == kActions.end())
    refuse("do", "expected enable, disable, jog, move, halt, home, home_here or clear_faults");
  MotionRequest request{text_of(document, "owner"), text_of(document, "axis"), action->second, 0.0, 0.0};
  const bool is_of_all = request.action == Action::halt || request.action == Action::clear_faults;
  if (is_of_all == !request.axis.empty()) refuse("axis", "expected an axis, except for halt and clear_faults");
  if ((request.action == Action::jog) != document.contains("velocity"))
    refuse("velocity", "jog needs it, and it alone");
  if ((request.action == Action::move) != document.contains("position"))
    refuse("position", "move needs it, and it alone");
  if (request.action == Action::move) request.position = number_of(document["position"], "position");
  if (request.action == Action::jog) request.velocity = number_of(document["velocity"], "velocity");
  return request;
}

std::vector<std::string> parse_channels(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"channels"});
  return list_of(document, "channels", line_of);
}

TriggerWish parse_trigger_wish(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"axis", "trigger", "before_s", "after_s"});
  return {line_of(text_of(document, "axis"), "axis"), line_of(text_of(document, "trigger"), "trigger"),
          seconds_of(document, "before_s"), seconds_of(document, "after_s")};
}

RowsRequest parse_rows(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"epoch", "from", "to"});
  return {row_of(document, "epoch"), row_of(document, "from"), row_of(document, "to")};
}

ParametersRequest parse_parameters(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"owner", "values"});
  ParametersRequest request{text_of(document, "owner"), {}};
  const auto values = document.find("values");
  if (values == document.end() || !values->is_object() || values->empty() || values->size() > kMostNames)
    refuse("values", "expected an object of names and values");
  for (const auto& item : values->items()) {
    if (!item.value().is_string()) refuse("values", "expected the values as texts");
    request.assignments.push_back(line_of(item.key() + "=" + item.value().get<std::string>(), "values"));
  }
  return request;
}

ParameterText parse_parameter_file(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"text", "name", "axis"});
  return {text_of(document, "text"), text_of(document, "name"), text_of(document, "axis")};
}

}  // namespace host::workbench
