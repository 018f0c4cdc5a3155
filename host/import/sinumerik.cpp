// Traces of SINUMERIK controls: XML in which a dataFrame lists its dataSignals. It is followed by one element `rec` per
// sample, with an attribute `time` (s) and one attribute per signal (as in the reader
// github.com/eliasrhoden/Trace-Tools).
#include <fmt/format.h>

#include <algorithm>

#include "host/exit_codes.hpp"
#include "host/import/log_file.hpp"
#include "host/number.hpp"

namespace host {

namespace {

/// Larger numbers are a NaN whose bits are written as a whole number: there is no value.
constexpr double kNoValue = 9.2188684372274e18;

std::string unescaped(std::string_view text) {
  static constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string plain;
  while (!text.empty()) {
    const auto* const entity =
        std::ranges::find_if(kEntities, [&](const auto& pair) { return text.starts_with(pair.first); });
    const bool found = entity != std::end(kEntities);
    plain += found ? entity->second : text.front();
    text.remove_prefix(found ? entity->first.size() : 1);
  }
  return plain;
}

/// Reads the next `name="value"` of a tag; false at its end.
bool take_attribute(std::string_view& inside, std::string_view& name, std::string_view& value) {
  const std::size_t equal = inside.find('=');
  if (equal == std::string_view::npos) return false;
  name = trim_blanks(inside.substr(0, equal));
  while (name.find_first_of(" \n") != std::string_view::npos) name.remove_prefix(name.find_first_of(" \n") + 1);
  const std::size_t open = inside.find_first_of("\"'", equal);
  if (open == std::string_view::npos) return false;
  const std::size_t close = inside.find(inside[open], open + 1);
  if (close == std::string_view::npos) return false;
  value = inside.substr(open + 1, close - open - 1);
  inside.remove_prefix(close + 1);
  return true;
}

std::string_view attribute(std::string_view inside, std::string_view wanted) {
  for (std::string_view name, value; take_attribute(inside, name, value);)
    if (name == wanted) return value;
  return {};
}

class TraceReader {
 public:
  TraceReader(std::string_view text, std::string_view name) : rest_(text), name_(name) {}

  Log read() {
    log_.path = name_;
    log_.layout = "sinumerik";
    log_.columns.push_back({"time", {}, {}, {}, 0.0, "s", {}});
    for (std::string_view tag, inside; take_tag(tag, inside);) {
      if (tag == "dataSignal") add_signal(inside);
      if (tag == "rec") add_sample(inside);
      if (tag == "/dataFrame") break;
    }
    if (ids_.empty() || log_.columns.front().values.empty())
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: a SINUMERIK trace without samples; save it with its measured values", name_));
    for (LogColumn& column : log_.columns) column.kind = fmt::format("{} numbers", column.values.size());
    return std::move(log_);
  }

 private:
  bool take_tag(std::string_view& tag, std::string_view& inside) {
    const std::size_t open = rest_.find('<');
    if (open == std::string_view::npos) return false;
    const std::size_t close = rest_.find('>', open);
    if (close == std::string_view::npos) return false;
    inside = rest_.substr(open + 1, close - open - 1);
    rest_.remove_prefix(close + 1);
    const std::size_t end = inside.find_first_of(" \t\r\n/", 1);
    tag = inside.substr(0, end);
    inside.remove_prefix(std::min(tag.size(), inside.size()));
    return true;
  }

  void add_signal(std::string_view inside) {
    constexpr std::size_t kMostSignals = 256;
    if (ids_.size() >= kMostSignals)
      throw Failure(ExitCode::bad_input, fmt::format("{}: more than {} signals", name_, kMostSignals));
    const std::string_view id = attribute(inside, "id");
    ids_.push_back(id.empty() ? fmt::format("f{}", ids_.size() + 1) : std::string(id));
    std::string_view called = attribute(inside, "description");
    if (called.empty()) called = attribute(inside, "name");
    LogColumn column;
    column.name = unescaped(called.empty() ? attribute(inside, "key") : called);
    column.unit = unescaped(attribute(inside, "units"));
    log_.columns.push_back(std::move(column));
  }

  void add_sample(std::string_view inside) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (LogColumn& column : log_.columns) column.values.push_back(kNone);
    for (std::string_view name, value; take_attribute(inside, name, value);) {
      const auto id = std::ranges::find(ids_, name);
      if (name != "time" && id == ids_.end()) continue;
      LogColumn& column = log_.columns[name == "time" ? 0 : static_cast<std::size_t>(id - ids_.begin()) + 1];
      const std::optional<double> number = parse_number(value);
      if (!number && column.fault.empty())
        column.fault = fmt::format("sample {}, {}: '{}' is not a number", column.values.size(), column.name, value);
      if (number && *number < kNoValue) column.values.back() = *number;
    }
  }

  std::string_view rest_, name_;
  std::vector<std::string> ids_;
  Log log_;
};

}  // namespace

std::optional<Log> parse_sinumerik(std::string_view text, std::string_view name) {
  constexpr std::size_t kLookedAt = 4096;
  const std::string_view start = trim_blanks(text.substr(0, kLookedAt));
  if (!start.starts_with('<') || text.find("<dataSignal") == std::string_view::npos) return std::nullopt;
  return TraceReader(text, name).read();
}

}  // namespace host
