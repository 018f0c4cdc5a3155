#include "host/parameters/backup_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

#include "firmware/app/crc32.hpp"
#include "host/exit_codes.hpp"
#include "host/number.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

constexpr std::string_view kCountKey = "count = ", kCrcKey = "crc32 = \"0x";
constexpr std::string_view kPitchHead =
    "# Tables of pitch errors: axis, counts from home, forward, backward (2^-16 counts)";
constexpr std::string_view kPitchKey = "#pitch ";

/// Parses exactly four whole numbers, separated by blanks.
std::optional<std::array<std::int32_t, 4>> four_whole(std::string_view text) {
  std::array<std::int32_t, 4> all{};
  for (std::int32_t& one : all) {
    text = trim_blanks(text);
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::optional<double> number = parse_number(text.substr(0, end));
    if (!number || *number != std::trunc(*number) || !(*number >= -2147483648.0 && *number <= 2147483647.0))
      return std::nullopt;
    one = static_cast<std::int32_t>(*number);
    text.remove_prefix(end);
  }
  return trim_blanks(text).empty() ? std::optional(all) : std::nullopt;
}

/// Programs whose backups had no CRC supported only boards with two axes.
constexpr std::size_t kOldBoard = firmware::parameter_rows::kBoardRows + 2 * firmware::parameter_rows::kAxisRows;

/// CRC of the text with LF line ends, because CR LF from an editor or a mail changes no value.
std::uint32_t crc_of(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '\r');
  return firmware::crc32(std::as_bytes(std::span(plain)));
}

std::string comment_of(const firmware::ParameterInfo& info) {
  const bool has_unit = !info.unit.empty() && info.unit != "1";
  return fmt::format("{}{}{}", has_unit ? unit_text(info) : "", has_unit ? ": " : "", info.doc);
}

std::string parameter_lines(const firmware::ParameterValues& values) {
  std::string text, table;
  for (std::size_t place = 0; place < values.size(); ++place) {
    const std::string name = full_name(place);
    const std::size_t dot = name.rfind('.');
    if (name.substr(0, dot) != table) {
      table = name.substr(0, dot);
      text += fmt::format("\n[{}]\n", table);
    }
    const firmware::ParameterInfo& info = info_at(place);
    text += fmt::format("{} = {}  # {}\n", name.substr(dot + 1), value_text(info, values.at(place)), comment_of(info));
  }
  return text;
}

/// Count and CRC of the text below, from the header of the file.
struct Seal {
  unsigned long count = 0;
  std::uint32_t crc = 0;
  std::string_view sealed;
};

std::optional<Seal> seal_of(std::string_view text) {
  Seal seal;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    if (line.starts_with('[')) return std::nullopt;  // parameters begin: no seal
    if (line.starts_with(kCountKey))
      seal.count = std::strtoul(std::string(line.substr(kCountKey.size())).c_str(), nullptr, 10);
    if (line.starts_with(kCrcKey)) {
      const std::string digits(line.substr(kCrcKey.size(), 8));
      seal.crc = static_cast<std::uint32_t>(std::strtoul(digits.c_str(), nullptr, 16));
      seal.sealed = text.substr(std::min(end + 1, text.size()));
      return seal;
    }
    begin = end + 1;
  }
  return std::nullopt;
}

}  // namespace

std::string format_backup(const firmware::ParameterValues& values, const std::vector<firmware::StoredEntry>& foreign,
                          const PitchTables& pitch) {
  std::string sealed = parameter_lines(values);
  if (!foreign.empty()) sealed += "\n# In the board's flash, but unknown to this table (key, bits):\n";
  for (const firmware::StoredEntry& entry : foreign)
    sealed += fmt::format("# {:#06x} {:#010x}\n", entry.key, entry.value_bits);
  if (!pitch.empty()) sealed += fmt::format("\n{}\n", kPitchHead);
  for (std::size_t axis = 0; axis < pitch.size(); ++axis)
    for (const firmware::PitchPoint& one : pitch[axis])
      sealed += fmt::format("{}{} {} {} {}\n", kPitchKey, axis, one.counts, one.forward, one.backward);
  return fmt::format(
      "# Parameters of an axis board, table {:#010x}. To change values, `axistool set-params` takes a file that was "
      "edited;\n# `axistool restore` takes this one as it is.\nformat = \"axis-params/1\"\n{}{}\n{}{:08x}\"\n{}",
      firmware::kSchemaHash, kCountKey, values.size(), kCrcKey, crc_of(sealed), sealed);
}

std::vector<Assignment> parse_backup(std::string_view text, std::string_view name) {
  const auto fail = [&](const std::string& what) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: {}. Nothing was restored: use another copy, or set the values with axistool set-params", name,
                    what));
  };
  const std::optional<Seal> seal = seal_of(text);
  if (seal && crc_of(seal->sealed) != seal->crc) fail("the backup was cut or changed: its CRC does not match");
  const std::vector<Assignment> list = parse_parameter_text(text, name);
  if (seal && list.size() != seal->count)
    fail(fmt::format("the backup names {} parameters, but says {}", list.size(), seal->count));
  if (!seal && list.size() < kOldBoard)
    fail(fmt::format("incomplete backup: it has no CRC, and only {} of the {} parameters of a board with two axes",
                     list.size(), kOldBoard));
  if (!seal && !text.ends_with('\n')) fail("the backup was cut: its last line is incomplete");
  return list;
}

std::optional<PitchTables> pitch_of_backup(std::string_view text, std::string_view name, std::size_t axes) {
  std::optional<PitchTables> tables;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.starts_with(kPitchHead)) tables.emplace(axes);
    if (!line.starts_with(kPitchKey)) continue;
    const auto words = four_whole(line.substr(kPitchKey.size()));
    const auto [axis, counts, forward, backward] = words.value_or(std::array{-1, 0, 0, 0});
    const firmware::PitchPoint one{counts, forward, backward};
    const bool is_there = tables && axis >= 0 && static_cast<std::size_t>(axis) < axes;
    auto* table = is_there ? &(*tables)[static_cast<std::size_t>(axis)] : nullptr;
    if (table == nullptr || !is_valid(one) || table->size() == firmware::kMostPitchPoints ||
        (!table->empty() && !may_follow(table->back(), one)))
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}:{}: not a valid point of this board's table of pitch errors. Nothing was "
                                "restored: use another copy, or axistool pitch",
                                name, number + 1));
    table->push_back(one);
  }
  return tables;
}

}  // namespace host
