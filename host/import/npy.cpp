#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "host/exit_codes.hpp"
#include "host/import/log_file.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

[[noreturn]] void fail(std::string_view path, const std::string& what) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path, what));
}

/// One field of a row: "<f8" at its offset.
struct Member {
  std::string name;
  char kind = 'f';  ///< f, i, u, b
  bool big_end_first = false;
  std::size_t size = 8, offset = 0;
};

template <typename Number>
double number_at(const std::array<char, 8>& bytes) {
  Number value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

double value_of(const Member& field, const char* place) {
  std::array<char, 8> bytes{};
  std::copy_n(place, field.size, bytes.begin());
  if (field.big_end_first) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(field.size));
  switch (field.size) {
    case 8:
      return field.kind == 'f'   ? number_at<double>(bytes)
             : field.kind == 'i' ? number_at<std::int64_t>(bytes)
                                 : number_at<std::uint64_t>(bytes);
    case 4:
      return field.kind == 'f'   ? number_at<float>(bytes)
             : field.kind == 'i' ? number_at<std::int32_t>(bytes)
                                 : number_at<std::uint32_t>(bytes);
    case 2:
      return field.kind == 'i' ? number_at<std::int16_t>(bytes) : number_at<std::uint16_t>(bytes);
    default:
      return field.kind == 'i' ? number_at<std::int8_t>(bytes) : number_at<std::uint8_t>(bytes);
  }
}

/// The header of a .npy file: a Python dictionary of `descr`, `fortran_order` and `shape` (NEP 1).
class NpyReader {
 public:
  NpyReader(std::string_view bytes, std::string_view path) : bytes_(bytes), path_(path) {}

  Log read() {
    take_header();
    take_type();
    take_shape();
    if (fields_.size() > 1 && columns_ > 1) fail(path_, "an array of rows with named fields has one dimension");
    const std::size_t row = row_size() * columns_;
    if (rows_ > kMostLogNumbers / std::max<std::size_t>(1, columns_ * fields_.size()))
      fail(path_, fmt::format("more than {} numbers, the most that a log may have; save fewer rows or columns",
                              kMostLogNumbers));
    if (rows_ == 0 || row == 0) fail(path_, "the array is empty; save one that contains a log");
    if (bytes_.size() / row < rows_)
      fail(path_, fmt::format("the file ends within its array of {} x {} numbers: it was cut off; save it again", rows_,
                              columns_));
    Log log;
    log.path = path_;
    log.layout = "npy";
    for (std::size_t k = 0; k < columns_ * fields_.size(); ++k) log.columns.push_back(column(k));
    return log;
  }

 private:
  void take_header() {
    constexpr std::size_t kFixed = 10;
    if (bytes_.size() < kFixed + 2) fail(path_, "the file ends within its header");
    const auto byte = [&](std::size_t k) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes_[k])); };
    const bool is_long = byte(6) >= 2;
    const std::size_t begin = is_long ? 12 : kFixed;
    const std::size_t length = byte(8) + (byte(9) << 8U) + (is_long ? (byte(10) << 16U) + (byte(11) << 24U) : 0);
    if (length > bytes_.size() - begin) fail(path_, "the file ends within its header");
    header_ = bytes_.substr(begin, length);
    bytes_.remove_prefix(begin + length);
    by_columns_ = after("'fortran_order':").starts_with("True");
  }

  /// The text after a key in the header, without leading blanks.
  std::string_view after(std::string_view key) const {
    const std::size_t at = header_.find(key);
    if (at == std::string_view::npos)
      fail(path_, fmt::format("no {} in the header; save the array with numpy.save", key));
    std::string_view rest = header_.substr(at + key.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    return rest;
  }

  /// Removes the text in single quotes at the start of `rest` and returns it.
  std::string_view take_quoted(std::string_view& rest) const {
    const std::size_t begin = rest.find('\''), end = rest.find('\'', begin + 1);
    if (begin == std::string_view::npos || end == std::string_view::npos) fail(path_, "a damaged header");
    const std::string_view text = rest.substr(begin + 1, end - begin - 1);
    rest.remove_prefix(end + 1);
    return text;
  }

  void take_type() {
    std::string_view rest = after("'descr':");
    if (!rest.starts_with('[')) {
      add_field("", take_quoted(rest));
      return;
    }
    rest = rest.substr(0, rest.find(']'));
    while (rest.find('(') != std::string_view::npos) {
      rest.remove_prefix(rest.find('(') + 1);
      const std::string name(take_quoted(rest));
      add_field(name, take_quoted(rest));
    }
    if (fields_.empty()) fail(path_, "rows without fields");
  }

  void add_field(std::string name, std::string_view type) {
    Member field{std::move(name), 'f', false, 0, row_size()};
    const std::string_view order = type.substr(0, 1);
    if (type.size() == 3 && (order == "<" || order == ">" || order == "|")) {
      field.big_end_first = order == ">";
      field.kind = type[1] == 'b' ? 'u' : type[1];
      field.size = static_cast<std::size_t>(type[2] - '0');
    }
    const bool whole = (field.kind == 'i' || field.kind == 'u') && std::has_single_bit(field.size) && field.size <= 8;
    if (!whole && !(field.kind == 'f' && (field.size == 4 || field.size == 8)))
      fail(path_, fmt::format("numbers of type '{}' are not read; save real numbers, array.astype(float)", type));
    fields_.push_back(std::move(field));
  }

  void take_shape() {
    std::string_view rest = after("'shape':");
    rest = rest.substr(0, rest.find(')'));
    std::vector<std::size_t> sizes;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      if (rest[k] < '0' || rest[k] > '9') continue;
      std::size_t size = 0;
      constexpr std::size_t kMost = std::size_t{1} << 40U;
      for (; k < rest.size() && rest[k] >= '0' && rest[k] <= '9'; ++k)
        size = std::min(kMost, 10 * size + static_cast<std::size_t>(rest[k] - '0'));
      sizes.push_back(size);
    }
    if (sizes.empty() || sizes.size() > 2)
      fail(path_, fmt::format("an array of {} dimensions; save one of rows and columns", sizes.size()));
    rows_ = sizes[0];
    columns_ = sizes.size() == 2 ? sizes[1] : 1;
    constexpr std::size_t kMostColumns = 10'000;
    if (columns_ > kMostColumns)
      fail(path_, fmt::format("{} columns; rows and columns seem exchanged: save the array's .T", columns_));
  }

  std::size_t row_size() const { return fields_.empty() ? 0 : fields_.back().offset + fields_.back().size; }

  LogColumn column(std::size_t number) const {
    const Member& field = fields_[columns_ == 1 ? number : 0];
    const std::size_t across = columns_ == 1 ? 0 : number, size = row_size();
    LogColumn result{field.name, fmt::format("{}{}, {} numbers", field.kind, 8 * field.size, rows_), {}, {}, 0.0};
    result.values.reserve(rows_);
    for (std::size_t k = 0; k < rows_; ++k) {
      const std::size_t place = by_columns_ ? across * rows_ + k : k * columns_ + across;
      result.values.push_back(value_of(field, bytes_.data() + place * size + field.offset));
    }
    return result;
  }

  std::string_view bytes_, path_, header_;
  std::vector<Member> fields_;
  std::size_t rows_ = 0, columns_ = 1;
  bool by_columns_ = false;
};

}  // namespace

Log parse_npy(std::string_view bytes, std::string_view path) { return NpyReader(bytes, path).read(); }

}  // namespace host
