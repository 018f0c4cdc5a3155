// One complete set of parameter values, for the board and each of its axes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "firmware/app/parameters/parameter_table.hpp"
#include "hal/axis_count.hpp"

namespace firmware {

inline constexpr std::array<std::string_view, hal::kMostAxes> kAxisNames{"x", "y", "z", "a"};

/// A parameter of the board, or of one axis, as store and protocol write it: id in the low 12 bits, above them 0 for
/// the board, 1 for the first axis, and so on.
struct ParameterKey {
  std::uint16_t code = 0;

  static constexpr ParameterKey of_board(std::uint16_t id) { return {id}; }
  static constexpr ParameterKey of_axis(std::size_t axis, std::uint16_t id) {
    return {static_cast<std::uint16_t>(((axis + 1) << 12) | id)};
  }
  constexpr std::uint16_t id() const { return code & 0xFFF; }
  constexpr std::size_t owner() const { return code >> 12; }  ///< 0 the board, else the axis' number plus 1
  constexpr bool operator==(const ParameterKey&) const = default;
};

namespace parameter_rows {

inline constexpr std::size_t kBoardRows =
    static_cast<std::size_t>(std::ranges::count(kRows, ParameterScope::board, &ParameterInfo::scope));
inline constexpr std::size_t kAxisRows = kRows.size() - kBoardRows;

constexpr std::array<ParameterRule, kRows.size()> rules_of_rows() {
  std::array<ParameterRule, kRows.size()> rules{};
  std::ranges::transform(kRows, rules.begin(), [](const ParameterInfo& row) {
    return ParameterRule{row.id, row.type, row.change, row.minimum, row.maximum, row.initial};
  });
  return rules;
}

/// The rows without their texts, so that these are not part of the image.
inline constexpr std::array<ParameterRule, kRows.size()> kRules = rules_of_rows();

/// A name as template argument.
template <std::size_t size>
struct Name {
  char text[size]{};
  // NOLINTNEXTLINE(google-explicit-constructor): a literal becomes a name by being written
  constexpr Name(const char (&literal)[size]) { std::copy_n(literal, size, text); }
  constexpr std::string_view view() const { return {text, size - 1}; }
};

template <Name name>
constexpr std::size_t row_named() {
  constexpr auto kRow =
      static_cast<std::size_t>(std::ranges::find(kRows, name.view(), &ParameterInfo::name) - kRows.begin());
  static_assert(kRow < kRows.size(), "no parameter has this name");
  return kRow;
}

template <Name name>
constexpr auto typed(float value) {
  constexpr ParameterType kType = kRows[row_named<name>()].type;
  if constexpr (kType == ParameterType::toggle) {
    return value != 0.0F;
  } else if constexpr (kType == ParameterType::whole) {
    return static_cast<std::int32_t>(value);
  } else {
    return value;
  }
}

}  // namespace parameter_rows

/// Places of all values, in the order of the table: the board's, then each axis'.
constexpr std::size_t parameter_count(std::size_t axes) {
  return parameter_rows::kBoardRows + axes * parameter_rows::kAxisRows;
}

/// The row of the value at this place, as index into kParameters.
constexpr std::size_t row_at(std::size_t place) {
  using parameter_rows::kAxisRows, parameter_rows::kBoardRows;
  return place < kBoardRows ? place : kBoardRows + (place - kBoardRows) % kAxisRows;
}

constexpr const ParameterRule& rule_at(std::size_t place) { return parameter_rows::kRules[row_at(place)]; }

constexpr ParameterKey key_at(std::size_t place) {
  using parameter_rows::kAxisRows, parameter_rows::kBoardRows;
  const std::uint16_t id = rule_at(place).id;
  return place < kBoardRows ? ParameterKey::of_board(id) : ParameterKey::of_axis((place - kBoardRows) / kAxisRows, id);
}

/// Empty for a key that this table does not have. On a board with fewer axes a place may be beyond its values.
constexpr std::optional<std::size_t> place_of(ParameterKey key) {
  using parameter_rows::kAxisRows, parameter_rows::kBoardRows, parameter_rows::kRules;
  const auto* const rule = std::ranges::lower_bound(kRules, key.id(), {}, &ParameterRule::id);
  if (rule == kRules.end() || rule->id != key.id() || key.owner() > hal::kMostAxes) return std::nullopt;
  const auto row = static_cast<std::size_t>(rule - kRules.begin());
  if ((row < kBoardRows) != (key.owner() == 0)) return std::nullopt;
  return row < kBoardRows ? row : row + (key.owner() - 1) * kAxisRows;
}

/// The values of one axis, read by name: "group.name" without the axis.
class AxisValues {
 public:
  explicit constexpr AxisValues(const float* first) : first_(first) {}

  /// float, std::int32_t or bool, as the row's type says.
  template <parameter_rows::Name name>
  constexpr auto get() const {
    constexpr std::size_t kRow = parameter_rows::row_named<name>();
    static_assert(kRow >= parameter_rows::kBoardRows, "this parameter belongs to the board");
    return parameter_rows::typed<name>(first_[kRow - parameter_rows::kBoardRows]);
  }

  /// The value as stored, for lists of parameters.
  template <std::uint16_t id>
  constexpr float with_id() const {
    constexpr auto kRow = static_cast<std::size_t>(std::ranges::find(parameter_rows::kRules, id, &ParameterRule::id) -
                                                   parameter_rows::kRules.begin());
    static_assert(kRow >= parameter_rows::kBoardRows && kRow < parameter_rows::kRules.size());
    return first_[kRow - parameter_rows::kBoardRows];
  }

 private:
  const float* first_;
};

class ParameterValues {
 public:
  /// Initial values of a board with 1 to hal::kMostAxes axes.
  constexpr explicit ParameterValues(std::size_t axes = hal::kAxisCount) : size_(parameter_count(axes)) {
    for (std::size_t place = 0; place < size_; ++place) values_[place] = rule_at(place).initial;
  }

  constexpr std::size_t size() const { return size_; }
  constexpr std::size_t axes() const { return (size_ - parameter_rows::kBoardRows) / parameter_rows::kAxisRows; }
  /// Empty also for an axis that the board does not have.
  constexpr std::optional<std::size_t> place_of(ParameterKey key) const {
    const auto place = firmware::place_of(key);
    return place && *place < size_ ? place : std::nullopt;
  }

  constexpr float at(std::size_t place) const { return values_[place]; }
  constexpr void set(std::size_t place, float value) { values_[place] = value; }

  template <parameter_rows::Name name>
  constexpr auto get() const {
    constexpr std::size_t kRow = parameter_rows::row_named<name>();
    static_assert(kRow < parameter_rows::kBoardRows, "this parameter belongs to an axis");
    return parameter_rows::typed<name>(values_[kRow]);
  }

  constexpr AxisValues axis(std::size_t index) const {
    return AxisValues(values_.data() + parameter_rows::kBoardRows + index * parameter_rows::kAxisRows);
  }

  /// By the bits: 0 and -0 differ.
  friend constexpr bool operator==(const ParameterValues& a, const ParameterValues& b) {
    return a.size_ == b.size_ && std::ranges::equal(a.values_, b.values_, {}, as_bits, as_bits);
  }

 private:
  static constexpr std::uint32_t as_bits(float value) { return std::bit_cast<std::uint32_t>(value); }

  std::size_t size_;
  std::array<float, parameter_count(hal::kMostAxes)> values_{};
};

}  // namespace firmware
