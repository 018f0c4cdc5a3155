// Time base of a log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/import/log_file.hpp"
#include "host/opening/channel_name.hpp"

namespace host {

/// A sampling period that the text in front of the table states.
struct StatedPeriod {
  double value = 0.0;          ///< s where `unit_is_known`
  bool unit_is_known = false;  ///< else in the unit of the time column
  std::string line;            ///< where it stands
};

/// "Abtastung: 1 ms", "Sampling time interval(ms),0.667", "# Sampling period is 1000000 ns", "Rate: 2 kHz"; empty if
/// the text states none, or different ones.
std::optional<StatedPeriod> stated_period(const Log& log);

struct TimeBase {
  std::string source;                   ///< column of the stamps, or "row"; empty: not found
  double factor = 1.0;                  ///< to seconds
  double period_s = 0.0;                ///< of the rows; 0: not found
  std::optional<double> resample_s;     ///< the rows are uneven and must be resampled with this period
  std::vector<std::size_t> run_starts;  ///< rows at which stamps begin again: several runs one after the other
  std::string why;
  double sure = 0.0;
};

/// The time base from `stamps`, one of the log's columns; nullptr for a log without stamps.
TimeBase time_base_of(const Log& log, const LogColumn* stamps, const ChannelName* name,
                      std::optional<double> given_period_s);

/// Whether all values increase by the same positive step within a thousandth: an unnamed counter or clock.
bool is_ramp(const std::vector<double>& values);

}  // namespace host
