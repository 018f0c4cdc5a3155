// Fields of a TOML table, read by name: each value is checked, and unknown fields are refused.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace host {

/// All errors are Failure(bad_input) with file, line, field and remedy.
class TomlFields {
 public:
  /// `where`: name of the table in messages, for example "[[move]]". The table must outlive this.
  TomlFields(const toml::table& table, std::string file, std::string where);

  double number(std::string_view key);
  double number(std::string_view key, double otherwise);
  std::optional<double> optional_number(std::string_view key);
  double positive(std::string_view key, double otherwise);
  double not_negative(std::string_view key);
  std::string text(std::string_view key);
  std::optional<std::string> optional_text(std::string_view key);
  /// Lists; empty if the key is absent.
  std::vector<double> numbers(std::string_view key);
  std::vector<std::string> texts(std::string_view key);
  bool toggle(std::string_view key, bool otherwise);
  /// Index in `known` of the text of `key`.
  std::size_t choice(std::string_view key, const std::vector<std::string_view>& known);
  std::optional<std::size_t> optional_choice(std::string_view key, const std::vector<std::string_view>& known);
  /// The tables of an array of tables; empty if the key is absent.
  std::vector<const toml::table*> tables(std::string_view key);
  const toml::table* sub_table(std::string_view key);
  bool has(std::string_view key) const { return table_.contains(key); }

  /// Throws if the table has a field that was never requested.
  void refuse_rest() const;
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;
  std::size_t line() const;

 private:
  const toml::node* find(std::string_view key);
  const toml::array* list_of(std::string_view key);
  double number_of(const toml::node& node, std::string_view key) const;

  const toml::table& table_;
  std::string file_;
  std::string where_;
  std::vector<std::string> asked_;
};

}  // namespace host
