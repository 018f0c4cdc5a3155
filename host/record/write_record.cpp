#include <fmt/format.h>

#include <iterator>

#include "host/atomic_file.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

void append_header(const Record& record, std::string& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# format: axis-record/1\n");
  if (!record.drive.empty()) fmt::format_to(out, "# drive: {}\n", record.drive);
  fmt::format_to(out, "# sample_period_s: {}\n", record.sample_period_s);
  for (const auto& [key, value] : record.header)
    if (key != "format" && key != "drive" && key != "sample_period_s") fmt::format_to(out, "# {}: {}\n", key, value);
}

}  // namespace

std::string format_record(const Record& record) {
  std::string text;
  append_header(record, text);
  std::vector<const std::vector<double>*> channels;
  for (const auto channel : kChannelsInFileOrder) {
    if ((record.*channel).empty()) continue;
    text += channels.empty() ? "" : ",";
    text += column_name(channel, record.kind);
    channels.push_back(&(record.*channel));
  }
  for (const ExtraChannel& extra : record.extra) text += "," + extra.name;
  text += '\n';
  for (std::size_t k = 0; k < record.size(); ++k) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (c > 0) text += ',';
      fmt::format_to(std::back_inserter(text), "{}", (*channels[c])[k]);
    }
    for (const ExtraChannel& extra : record.extra) {
      text += ',';
      if (extra.text.empty())
        fmt::format_to(std::back_inserter(text), "{}", extra.values[k]);
      else
        text += extra.text[k];
    }
    text += '\n';
  }
  return text;
}

void write_record(const Record& record, const std::string& path) { write_file_atomically(path, format_record(record)); }

}  // namespace host
