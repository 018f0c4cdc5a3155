#include "host/workbench/envelope_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace host::workbench {

namespace {

void append_numbers(std::string& text, const char* name, const std::vector<std::vector<double>>& channels) {
  text += fmt::format(",\"{}\":[", name);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    text += k == 0 ? "[" : ",[";
    for (std::size_t i = 0; i < channels[k].size(); ++i) {
      if (i > 0) text += ',';
      std::isfinite(channels[k][i]) ? fmt::format_to(std::back_inserter(text), "{:.8g}", channels[k][i])
                                    : fmt::format_to(std::back_inserter(text), "null");
    }
    text += ']';
  }
  text += ']';
}

}  // namespace

std::string envelope_text(const Envelope& envelope, std::uint64_t epoch) {
  std::string text = fmt::format("{{\"epoch\":{},\"first\":{},\"rows\":{},\"taken\":[{}]", epoch, envelope.first,
                                 envelope.rows, fmt::join(envelope.taken, ","));
  append_numbers(text, "low", envelope.low);
  if (envelope.rows > 1) append_numbers(text, "high", envelope.high);
  return text + "}";
}

}  // namespace host::workbench
