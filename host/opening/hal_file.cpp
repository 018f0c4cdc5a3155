#include "host/opening/hal_file.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "host/exit_codes.hpp"
#include "host/number.hpp"
#include "host/read_file.hpp"
#include "host/record/table_layout.hpp"

namespace host {

namespace {

struct Sampler {
  std::map<std::size_t, LogColumn> pins;
};

/// "sampler.0.pin.2" -> 0, 2.
std::optional<std::pair<std::size_t, std::size_t>> sampler_pin(std::string_view word) {
  constexpr std::string_view kFront = "sampler.", kMiddle = ".pin.";
  const std::size_t middle = word.find(kMiddle);
  if (!word.starts_with(kFront) || middle == std::string_view::npos) return std::nullopt;
  const auto sampler = parse_number(word.substr(kFront.size(), middle - kFront.size()));
  const auto pin = parse_number(word.substr(middle + kMiddle.size()));
  constexpr double kMostPins = 64.0;
  if (!sampler || !pin || !(*sampler >= 0.0 && *sampler < kMostPins && *pin >= 0.0 && *pin < kMostPins))
    return std::nullopt;
  return std::pair{static_cast<std::size_t>(*sampler), static_cast<std::size_t>(*pin)};
}

class HalReader {
 public:
  explicit HalReader(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::string_view line; take_line(text, line);) {
      line = line.substr(0, line.find('#'));
      TableLayout{}.split(line, words);
      if (words.size() > 2 && words[0] == "net") take_net(words);
      for (const std::string_view word : words) take_setting(word);
      if (words.size() > 2 && words[0] == "addf" && words[1].starts_with("sampler.")) thread_ = words[2];
    }
  }

  std::map<std::size_t, Sampler> samplers;

  /// Period of the thread that runs the sampler, s.
  std::optional<double> period_s() const {
    for (const auto& [key, value] : settings_)
      if (key.starts_with("name") && value == thread_)
        if (const auto found = period_of("period" + key.substr(4))) return found;
    if (const auto servo = period_of("servo_period_nsec")) return servo;
    return period_of("period1");
  }

 private:
  std::optional<double> period_of(const std::string& key) const {
    const auto found = settings_.find(key);
    const auto ns = found == settings_.end() ? std::nullopt : parse_number(found->second);
    return ns && *ns > 0.0 ? std::optional(*ns * 1e-9) : std::nullopt;
  }

  /// Reads the name of the signal and the other pins on it, which identify it.
  void take_net(const std::vector<std::string_view>& words) {
    for (std::size_t k = 2; k < words.size(); ++k) {
      const auto pin = sampler_pin(words[k]);
      if (!pin) continue;
      LogColumn column;
      column.name = words[1];
      for (std::size_t j = 2; j < words.size(); ++j)
        if (j != k && words[j] != "=>" && words[j] != "<=")
          column.kind += fmt::format("{}{}", column.kind.empty() ? "" : " ", words[j]);
      samplers[pin->first].pins[pin->second] = std::move(column);
    }
  }

  void take_setting(std::string_view word) {
    const std::size_t equal = word.find('=');
    if (equal != std::string_view::npos && equal > 0) settings_.emplace(word.substr(0, equal), word.substr(equal + 1));
  }

  std::map<std::string, std::string> settings_;
  std::string thread_;
};

}  // namespace

void name_by_hal(Log& log, const std::string& hal_path) {
  const HalReader hal(read_file(hal_path));
  for (const auto& [number, sampler] : hal.samplers) {
    const std::size_t pins = sampler.pins.size(), counted = log.columns.size();
    if (pins != counted && pins + 1 != counted) continue;  // halsampler -t writes the number of the sample first
    std::size_t column = counted - pins;
    if (column == 1) log.columns[0].name = "sample number";
    for (const auto& [pin, named] : sampler.pins) {
      log.columns[column].name = named.name;
      log.columns[column].kind = named.kind;
      ++column;
    }
    log.layout = "halsampler";
    if (const auto period = hal.period_s())
      log.preamble.push_back(fmt::format("sampling period {} s, of the thread in {}", *period, hal_path));
    return;
  }
  throw Failure(
      ExitCode::bad_input,
      fmt::format(
          "{}: no sampler with pins in {} 'net' lines, one for each column of the log; name the file that loads it",
          hal_path, log.columns.size()));
}

}  // namespace host
