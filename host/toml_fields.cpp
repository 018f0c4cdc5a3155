#include "host/toml_fields.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"

namespace host {

namespace {

std::size_t line_of(const toml::source_region& source) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(source.begin.line));
}

}  // namespace

TomlFields::TomlFields(const toml::table& table, std::string file, std::string where)
    : table_(table), file_(std::move(file)), where_(std::move(where)) {}

std::size_t TomlFields::line() const { return line_of(table_.source()); }

void TomlFields::fail(std::string_view key, const std::string& what) const {
  const toml::node* node = table_.get(key);
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: line {}: {} in {}: {}", file_, node == nullptr ? line() : line_of(node->source()), key,
                            where_, what));
}

const toml::node* TomlFields::find(std::string_view key) {
  asked_.emplace_back(key);
  return table_.get(key);
}

double TomlFields::number_of(const toml::node& node, std::string_view key) const {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  const auto* real = node.as_floating_point();
  if (real == nullptr) fail(key, "expected a number, without quotes");
  if (!std::isfinite(real->get())) fail(key, "expected a finite number");
  return real->get();
}

std::optional<double> TomlFields::optional_number(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  return number_of(*node, key);
}

double TomlFields::number(std::string_view key, double otherwise) { return optional_number(key).value_or(otherwise); }

double TomlFields::number(std::string_view key) {
  const auto value = optional_number(key);
  if (!value) fail(key, fmt::format("it is missing; add {} = …", key));
  return *value;
}

double TomlFields::positive(std::string_view key, double otherwise) {
  const double value = number(key, otherwise);
  if (!(value > 0.0)) fail(key, fmt::format("{:g} is out of bounds; it must be above 0", value));
  return value;
}

double TomlFields::not_negative(std::string_view key) {
  const double value = number(key);
  if (value < 0.0) fail(key, fmt::format("{:g} is out of bounds; it must be 0 or more", value));
  return value;
}

std::optional<std::string> TomlFields::optional_text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail(key, "expected a text in quotes");
  return node->as_string()->get();
}

std::string TomlFields::text(std::string_view key) {
  auto value = optional_text(key);
  if (!value) fail(key, fmt::format("it is missing; add {} = \"…\"", key));
  return *std::move(value);
}

const toml::array* TomlFields::list_of(std::string_view key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_array()) fail(key, "expected a list in brackets");
  return node == nullptr ? nullptr : node->as_array();
}

std::vector<double> TomlFields::numbers(std::string_view key) {
  std::vector<double> values;
  if (const toml::array* list = list_of(key))
    for (const toml::node& entry : *list) values.push_back(number_of(entry, key));
  return values;
}

std::vector<std::string> TomlFields::texts(std::string_view key) {
  std::vector<std::string> values;
  const toml::array* list = list_of(key);
  for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
    if (!(*list)[k].is_string()) fail(key, "expected texts in quotes");
    values.push_back((*list)[k].as_string()->get());
  }
  return values;
}

bool TomlFields::toggle(std::string_view key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean()) fail(key, "expected true or false");
  return node->as_boolean()->get();
}

std::optional<std::size_t> TomlFields::optional_choice(std::string_view key,
                                                       const std::vector<std::string_view>& known) {
  const auto name = optional_text(key);
  if (!name) return std::nullopt;
  const auto found = std::ranges::find(known, *name);
  if (found == known.end())
    fail(key, fmt::format("'{}' is unknown{} (known: {})", *name, did_you_mean(*name, known), fmt::join(known, ", ")));
  return static_cast<std::size_t>(found - known.begin());
}

std::size_t TomlFields::choice(std::string_view key, const std::vector<std::string_view>& known) {
  const auto place = optional_choice(key, known);
  if (!place) fail(key, fmt::format("it is missing; write one of {}", fmt::join(known, ", ")));
  return *place;
}

std::vector<const toml::table*> TomlFields::tables(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<const toml::table*> found;
  if (node == nullptr) return found;
  const toml::array* array = node->as_array();
  if (array == nullptr) fail(key, fmt::format("write each one under a heading [[{}]]", key));
  for (const toml::node& entry : *array) {
    if (!entry.is_table()) fail(key, fmt::format("write each one under a heading [[{}]]", key));
    found.push_back(entry.as_table());
  }
  return found;
}

const toml::table* TomlFields::sub_table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) fail(key, fmt::format("expected a table, headed by [{}]", key));
  return node->as_table();
}

void TomlFields::refuse_rest() const {
  for (const auto& [key, node] : table_) {
    if (std::ranges::find(asked_, key.str()) != asked_.end()) continue;
    const std::vector<std::string_view> known(asked_.begin(), asked_.end());
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: line {}: unknown field {} in {}{} (known: {})", file_, line_of(key.source()),
                              key.str(), where_, did_you_mean(key.str(), known), fmt::join(known, ", ")));
  }
}

}  // namespace host
