#include "host/workbench/request_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/workbench/folder.hpp"

namespace host::workbench {

void refuse(const std::string& field, const std::string& what) {
  throw Failure(ExitCode::usage, fmt::format("request, \"{}\": {}", field, what));
}

nlohmann::json object_of(std::string_view text) {
  if (text.size() > kLongestRequest)
    throw Failure(ExitCode::usage, fmt::format("request: longer than {} bytes", kLongestRequest));
  nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
  if (!document.is_object()) throw Failure(ExitCode::usage, "request: expected a JSON object");
  return document;
}

void require_known(const nlohmann::json& object, std::initializer_list<std::string_view> known) {
  for (const auto& item : object.items())
    if (std::ranges::find(known, item.key()) == known.end()) refuse(item.key(), "no such field");
}

std::string text_of(const nlohmann::json& object, const std::string& field) {
  const auto found = object.find(field);
  if (found == object.end()) return "";
  if (!found->is_string()) refuse(field, "expected a text");
  return found->get<std::string>();
}

bool flag_of(const nlohmann::json& object, const std::string& field) {
  const auto found = object.find(field);
  if (found == object.end()) return false;
  if (!found->is_boolean()) refuse(field, "expected true or false");
  return found->get<bool>();
}

std::string file_of(const std::string& name, const std::string& field) {
  if (!is_plain_name(name)) refuse(field, "expected the name of a file below the folder");
  return name;
}

double number_of(const nlohmann::json& value, const std::string& field) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(field, "expected a number");
  return value.get<double>();
}

}  // namespace host::workbench
