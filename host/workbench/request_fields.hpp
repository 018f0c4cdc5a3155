// Fields of a request as values. A field that is wrong is a Failure(usage) with its name.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace host::workbench {

inline constexpr std::size_t kLongestRequest = 65'536, kMostNames = 500;

[[noreturn]] void refuse(const std::string& field, const std::string& what);

/// The request; one longer than kLongestRequest is refused.
nlohmann::json object_of(std::string_view text);
void require_known(const nlohmann::json& object, std::initializer_list<std::string_view> known);

/// "" if there is no such field.
std::string text_of(const nlohmann::json& object, const std::string& field);
/// False if there is no such field.
bool flag_of(const nlohmann::json& object, const std::string& field);
/// A plain name (is_plain_name).
std::string file_of(const std::string& name, const std::string& field);
/// Finite.
double number_of(const nlohmann::json& value, const std::string& field);

/// The texts of a list, each through `check(text, field)`; empty if there is no such field.
template <typename Check>
std::vector<std::string> list_of(const nlohmann::json& object, const std::string& field, Check check) {
  std::vector<std::string> texts;
  const auto found = object.find(field);
  if (found == object.end()) return texts;
  if (!found->is_array() || found->size() > kMostNames) refuse(field, "expected a list of names");
  for (const nlohmann::json& item : *found) {
    if (!item.is_string()) refuse(field, "expected a list of names");
    texts.push_back(check(item.get<std::string>(), field));
  }
  return texts;
}

}  // namespace host::workbench
