#include "host/opening/time_base.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/import/import_record.hpp"
#include "host/number.hpp"
#include "host/opening/name_words.hpp"
#include "host/record/time_axis.hpp"

namespace host {

namespace {

/// Range of sampling rates for feed drives: from a slow trend in a PLC to the rate of a current loop.
constexpr double kSlowest_Hz = 5.0, kFastest_Hz = 45'000.0;

bool is_plausible(double period_s) { return period_s > 0.99 / kFastest_Hz && period_s < 1.01 / kSlowest_Hz; }

bool speaks_of_sampling(std::string_view text) {
  static constexpr std::string_view kWords[] = {
      "sampl",       "abtast",      "interval", "period",  "zyklus",  "takt",   "rate", "frequen",      "cycle",
      "échantillon", "echantillon", "muestreo", "campion", "дискрет", "период", "采样", "サンプリング", "周期"};
  return std::ranges::any_of(kWords, [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

/// A number followed by hertz is a rate.
std::optional<double> hertz(std::string_view unit) {
  if (unit == "Hz" || unit == "hz" || unit == "HZ" || unit == "Гц") return 1.0;
  if (unit == "kHz" || unit == "khz" || unit == "кГц") return 1e3;
  return std::nullopt;
}

/// The unit of time in the text: after the number, or in brackets anywhere.
std::string_view unit_near(std::string_view text, std::string_view behind) {
  behind = trim_blanks(behind);
  std::string_view word = behind.substr(0, behind.find_first_of(" \t;,)]\""));
  if (unit_named(word) || hertz(word)) return word;
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const std::size_t begin = text.find(open), end = text.find(close, begin == std::string_view::npos ? 0 : begin);
    if (begin == std::string_view::npos || end == std::string_view::npos) continue;
    const std::string_view unit = text.substr(begin + 1, end - begin - 1);
    if (unit_named(unit) || hertz(unit)) return unit;
  }
  return {};
}

std::optional<StatedPeriod> period_of_line(std::string_view line) {
  if (!speaks_of_sampling(in_small_letters(line))) return std::nullopt;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] < '0' || line[at] > '9') continue;
    std::size_t end = at;
    while (end < line.size() && std::string_view("0123456789.,eE-+").find(line[end]) != std::string_view::npos) ++end;
    std::string digits(line.substr(at, end - at));
    while (!digits.empty() && (digits.back() < '0' || digits.back() > '9')) digits.pop_back();
    const std::size_t behind = at + digits.size();
    std::ranges::replace(digits, ',', '.');
    const std::optional<double> number = parse_number(digits);
    at = std::max(at, behind > 0 ? behind - 1 : behind);
    if (!number || !(*number > 0.0) || !std::isfinite(*number)) continue;
    const std::string_view unit = unit_near(line, line.substr(behind));
    const std::string where(trim_blanks(line));
    if (const auto rate = hertz(unit)) return StatedPeriod{1.0 / (*number * *rate), true, where};
    const auto meaning = unit.empty() ? std::nullopt : unit_named(unit);
    if (meaning && meaning->dimension == Dimension::time) return StatedPeriod{*number * meaning->factor, true, where};
    if (unit.empty()) return StatedPeriod{*number, false, where};
  }
  return std::nullopt;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The nominal value of a measured period: the nearest number with three digits, or with steps of 1/3 and 2/3 us, if
/// the difference is within the error of quartz clocks.
double as_set(double period_s) {
  constexpr double kClocks = 2e-4;
  const double unit = std::pow(10.0, std::floor(std::log10(period_s)) - 2.0);
  const double round = std::round(period_s / unit) * unit;
  return std::abs(round - period_s) <= kClocks * period_s ? std::strtod(fmt::format("{:.6g}", round).c_str(), nullptr)
                                                          : period_s;
}

/// Steps between stamps, in the unit of the stamps.
struct Steps {
  std::vector<double> all;
  std::vector<std::size_t> backwards;  ///< rows whose stamp is not later than the one before
  double typical = 0.0;
};

Steps steps_of(const std::vector<double>& stamps) {
  Steps steps;
  std::vector<double> forward;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    const double step = stamps[k] - stamps[k - 1];
    steps.all.push_back(step);
    if (step > 0.0) forward.push_back(step);
    if (step <= 0.0) steps.backwards.push_back(k);
  }
  if (!forward.empty()) steps.typical = median(std::move(forward));
  return steps;
}

/// The stamps that have a value.
std::vector<double> known(const std::vector<double>& values) {
  std::vector<double> result;
  for (const double value : values)
    if (std::isfinite(value)) result.push_back(value);
  return result;
}

/// The unit of the stamps, in s, if the log does not state it: the only unit that gives a plausible rate for the log of
/// a drive.
struct Guess {
  double factor = 0.0, sure = 0.0;
  std::string why;
  std::string_view unit{};
};

Guess unit_of_stamps(double step, const std::optional<StatedPeriod>& stated) {
  constexpr double kUnits[] = {1.0, 1e-3, 1e-6, 1e-9};
  constexpr std::string_view kNames[] = {"s", "ms", "us", "ns"};
  Guess guess;
  int fitting = 0;
  for (std::size_t k = 0; k < std::size(kUnits); ++k) {
    const double period_s = step * kUnits[k];
    if (stated && stated->unit_is_known && std::abs(period_s / stated->value - 1.0) < 0.02)
      return {kUnits[k], 0.97, fmt::format("its steps are the {} that the file states in {}", stated->line, kNames[k])};
    if (!is_plausible(period_s)) continue;
    if (++fitting == 1)
      guess = {kUnits[k], 0.92, fmt::format("steps of {:.4g}: only {} give a plausible sampling rate", step, kNames[k]),
               kNames[k]};
  }
  if (fitting > 1) {
    guess.sure = 0.6;
    guess.why = fmt::format("steps of {:.4g} without a unit, taken as {}", step, guess.unit);
  }
  return guess;
}

TimeBase by_rows(double period_s, std::string why, double sure) {
  TimeBase base;
  base.source = kRowSource;
  base.factor = base.period_s = period_s;
  base.why = std::move(why);
  base.sure = sure;
  return base;
}

/// Whether all stamps are within a third of a period of a straight line, so that no sample was lost.
bool follows_even_line(const std::vector<double>& stamps, double period) {
  constexpr double kShare = 0.33;
  for (std::size_t k = 0; k < stamps.size(); ++k)
    if (std::abs(stamps[k] - stamps.front() - static_cast<double>(k) * period) > kShare * period) return false;
  return true;
}

}  // namespace

std::optional<StatedPeriod> stated_period(const Log& log) {
  std::optional<StatedPeriod> found;
  for (const std::string& line : log.preamble) {
    const std::optional<StatedPeriod> here = period_of_line(line);
    if (!here) continue;
    if (found && found->unit_is_known == here->unit_is_known && found->value != here->value) return std::nullopt;
    if (!found || here->unit_is_known) found = here;
  }
  return found;
}

bool is_ramp(const std::vector<double>& values) {
  if (values.size() < 3) return false;
  const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
  if (!(step > 0.0) || !std::isfinite(step)) return false;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (!(std::abs(values[k] - values[k - 1] - step) < 1e-3 * step + 1e-9 * std::abs(values[k]))) return false;
  return true;
}

TimeBase time_base_of(const Log& log, const LogColumn* stamps, const ChannelName* name,
                      std::optional<double> given_period_s) {
  if (given_period_s) return by_rows(*given_period_s, "as given", 1.0);
  const std::optional<StatedPeriod> stated = stated_period(log);
  if (stamps == nullptr) {
    if (stated && stated->unit_is_known)
      return by_rows(stated->value, fmt::format("the file states: {}", stated->line), 0.95);
    return {};
  }
  const std::vector<double> values = known(stamps->values);
  const Steps steps = steps_of(values);
  if (values.size() < 3 || !(steps.typical > 0.0)) return {};
  TimeBase base;
  base.source = stamps->name.empty() ? "#1" : stamps->name;
  if (name->unit && name->unit->dimension == Dimension::time) {
    base.factor = name->unit->factor;
    base.why = fmt::format("stamps in {}", name->unit_text);
    base.sure = 0.97;
  } else if (stamps->kind.find("times, s") != std::string::npos) {
    base.why = "dates or times of day";
    base.sure = 0.97;
  } else {
    const Guess guess = unit_of_stamps(steps.typical, stated);
    if (guess.sure == 0.0) return {};
    base.factor = guess.factor;
    base.why = guess.why;
    base.sure = guess.sure;
  }
  const double typical_s = steps.typical * base.factor;
  base.period_s = as_set(typical_s);
  if (stated && stated->unit_is_known && std::abs(stated->value / typical_s - 1.0) < 0.02)
    base.period_s = stated->value;
  // A few repeated stamps mean that several runs were joined.
  if (!steps.backwards.empty()) {
    if (20 * steps.backwards.size() > values.size()) {
      const double mean_s = base.factor * (values.back() - values.front()) / static_cast<double>(values.size() - 1);
      if (!(mean_s > 0.0)) return {};
      const double period_s = as_set(mean_s);
      base = by_rows(period_s, fmt::format("{}, with repeated values: mean period {:.6g} s", base.why, period_s), 0.7);
      return base;
    }
    base.run_starts = steps.backwards;
  }
  double worst = 0.0;
  for (const double step : steps.all)
    if (step > 0.0) worst = std::max(worst, std::abs(step / steps.typical - 1.0));
  if (worst <= kJitterTolerance && base.run_starts.empty()) return base;
  const double period = base.period_s / base.factor;
  constexpr double kLoggersJitter = 0.05;
  if (base.run_starts.empty() && worst <= kLoggersJitter && follows_even_line(values, period))
    return by_rows(base.period_s,
                   fmt::format("{}, with {:.2g} % jitter and no lost rows: period {:.6g} s", base.why, 100.0 * worst,
                               base.period_s),
                   base.sure);
  if (worst > kJitterTolerance) {
    base.resample_s = base.period_s;
    base.why += fmt::format(", uneven by up to {:.2g} periods: resampled at {:.6g} s", worst, base.period_s);
  }
  return base;
}

}  // namespace host
