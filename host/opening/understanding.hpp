// Recognises a log's channels by their names, units and physical relations.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/import/import_record.hpp"
#include "host/opening/channel_name.hpp"
#include "host/opening/drive_constants.hpp"
#include "host/opening/time_base.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Above the first limit a channel is accepted without a question; below the second it is rejected.
inline constexpr double kSureEnough = 0.9, kTooUnsure = 0.5;

/// Information from outside the log.
struct OpeningHints {
  std::optional<sim::DataSheet> sheet{};
  std::optional<double> torque_constant{};  ///< Nm/A or N/A
  std::optional<double> period_s{};
  std::vector<Mapping> mappings{};  ///< of the user: they override the names
  std::string drive{};              ///< its name, for the records
};

struct OpenedChannel {
  std::string name, axis;
  std::string taken_as;  ///< column of a record; empty: kept with its own name, or left out
  double factor = 1.0, offset = 0.0;
  std::string why;
  double sure = 0.0;  ///< 0 to 1
};

/// One axis of a log, which gives one record.
struct OpenedAxis {
  std::string name;               ///< empty if the log has only one axis
  std::vector<Mapping> mappings;  ///< without t_s
  std::vector<Unwrapping> unwrap;
  std::string stamps;                ///< column of the stamps of its channels; empty: the log's
  std::optional<TimeBase> own_time;  ///< if it differs from the log's
  std::vector<std::string> missing;  ///< why it gives no record, or an incomplete one
  DriveConstants constants;
  bool makes_record = false;
};

struct Understanding {
  std::string layout;  ///< found by the reader, or the tool that wrote it
  double rate_Hz = 0.0;
  TimeBase time;
  std::vector<OpenedChannel> channels;  ///< of every column of the log
  std::vector<OpenedAxis> axes;
  std::vector<std::string> asks;          ///< uncertain points, and how to correct them
  std::vector<std::string> missing;       ///< of the whole log and of its axes
  std::optional<double> lead_mm_per_rad;  ///< from position and speed together
};

inline const TimeBase& time_of(const OpenedAxis& axis, const Understanding& understood) {
  return axis.own_time ? *axis.own_time : understood.time;
}

/// Converts sign-magnitude numbers to their values, and notes this in the log's header.
void decode_signs(Log& log);

/// Recognises the channels of `log`. `group`, including `log`: logs of the same controller (same channels in the same
/// order). A scale found in one of them is valid for all.
Understanding understand(const Log& log, const std::vector<const Log*>& group, const OpeningHints& hints);

/// The mapping in the language of --map: `x_mm="Pos [Ink]"*1.25e-4`.
std::string mapping_text(const Mapping& mapping);

/// A column's name as --map takes it: in quotes if it contains blanks or signs.
std::string source_text(const std::string& name);

}  // namespace host
