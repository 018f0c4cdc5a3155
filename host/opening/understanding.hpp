// Recognises the channels of a log by their names, units and physical relations.
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

/// Confidence above the first value: accepted without a question; below the second: rejected.
inline constexpr double kSureEnough = 0.9, kTooUnsure = 0.5;

/// Information from outside the log.
struct OpeningHints {
  std::optional<sim::DataSheet> sheet{};
  std::optional<double> torque_constant{};  ///< Nm/A or N/A
  std::optional<double> period_s{};
  std::vector<Mapping> mappings{};  ///< mappings of the user, which override the names
  std::string drive{};              ///< name of the drive, for the records
};

struct OpenedChannel {
  std::string name, axis;
  std::string taken_as;  ///< column of a record; empty if it keeps its name or is left out
  double factor = 1.0, offset = 0.0;
  std::string why;
  double sure = 0.0;  ///< confidence, 0 to 1
};

/// One axis of a log, which becomes one record.
struct OpenedAxis {
  std::string name;               ///< empty if the log has only one axis
  std::vector<Mapping> mappings;  ///< without t_s
  std::vector<Unwrapping> unwrap;
  std::string stamps;                ///< column with the stamps of its channels; empty if they are the log's
  std::optional<TimeBase> own_time;  ///< set if it differs from the log's time base
  std::vector<std::string> missing;  ///< why there is no record or an incomplete one
  DriveConstants constants;
  bool makes_record = false;
};

struct Understanding {
  std::string layout;  ///< layout of the file, or the tool that wrote it
  double rate_Hz = 0.0;
  TimeBase time;
  std::vector<OpenedChannel> channels;  ///< one for every column of the log
  std::vector<OpenedAxis> axes;
  std::vector<std::string> asks;          ///< uncertain points, and how to correct them
  std::vector<std::string> missing;       ///< missing information, of the whole log and of its axes
  std::optional<double> lead_mm_per_rad;  ///< from the ratio of position and speed
};

inline const TimeBase& time_of(const OpenedAxis& axis, const Understanding& understood) {
  return axis.own_time ? *axis.own_time : understood.time;
}

/// Converts numbers in sign-magnitude form to their values, and notes this in the header of the log.
void decode_signs(Log& log);

/// Recognises the channels of `log`. `group`: logs of the same controller (same channels in the same order), including
/// `log`. A scale found in one of them is valid for all.
Understanding understand(const Log& log, const std::vector<const Log*>& group, const OpeningHints& hints);

/// A mapping in the language of --map: `x_mm="Pos [Ink]"*1.25e-4`.
std::string mapping_text(const Mapping& mapping);

/// A column's name in the language of --map: in quotes if it contains blanks or signs.
std::string source_text(const std::string& name);

}  // namespace host
