// The time base of a log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/import/log_file.hpp"
#include "host/opening/channel_name.hpp"

namespace host {

/// A sampling period that is stated in the text before the table.
struct StatedPeriod {
  double value = 0.0;          ///< in s if `unit_is_known`, otherwise in the unit of the time column
  bool unit_is_known = false;  ///< true if the text states a unit of time
  std::string line;            ///< the line that states it
};

/// "Abtastung: 1 ms", "Sampling time interval(ms),0.667", "# Sampling period is 1000000 ns", "Rate: 2 kHz". Empty if
/// the text states no period, or several different ones.
std::optional<StatedPeriod> stated_period(const Log& log);

struct TimeBase {
  std::string source;                   ///< column of the stamps, or "row"; empty if not found
  double factor = 1.0;                  ///< factor to seconds
  double period_s = 0.0;                ///< period of the rows; 0 if not found
  std::optional<double> resample_s;     ///< set if the rows are uneven: period for resampling
  std::vector<std::size_t> run_starts;  ///< rows at which stamps begin again: start of a further run
  std::string why;
  double sure = 0.0;
};

/// The time base from `stamps`, one of the log's columns; null for a log without stamps.
TimeBase time_base_of(const Log& log, const LogColumn* stamps, const ChannelName* name,
                      std::optional<double> given_period_s);

/// Whether all values increase by the same positive step (within a thousandth), like an unnamed counter or clock.
bool is_ramp(const std::vector<double>& values);

}  // namespace host
