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
  std::vector<Mapping> mappings{};  ///< of the user: they hold, whatever the names say
  std::string drive{};              ///< its name, for the records
};

struct OpenedChannel {
  std::string name, axis;
  std::string taken_as;  ///< column of a record; empty: kept under its own name, or left out
  double factor = 1.0, offset = 0.0;
  std::string why;
  double sure = 0.0;  ///< 0 to 1
};

/// One axis of a log: what becomes one record.
struct OpenedAxis {
  std::string name;               ///< empty where the log holds one
  std::vector<Mapping> mappings;  ///< without t_s
  std::vector<Unwrapping> unwrap;
  std::string stamps;                ///< column of the stamps of its channels; empty: the log's
  std::optional<TimeBase> own_time;  ///< where they are not the log's
  std::vector<std::string> missing;  ///< why it makes no record, or a poorer one
  DriveConstants constants;
  bool makes_record = false;
};

struct Understanding {
  std::string layout;  ///< as the reader found it, or the tool that wrote it
  double rate_Hz = 0.0;
  TimeBase time;
  std::vector<OpenedChannel> channels;  ///< of every column of the log
  std::vector<OpenedAxis> axes;
  std::vector<std::string> asks;          ///< uncertain points, and how to correct them
  std::vector<std::string> missing;       ///< of the whole log and of its axes
  std::optional<double> lead_mm_per_rad;  ///< that position and speed show together
};

inline const TimeBase& time_of(const OpenedAxis& axis, const Understanding& understood) {
  return axis.own_time ? *axis.own_time : understood.time;
}

/// Converts numbers of sign and magnitude to their values, and notes it in the log's header.
void decode_signs(Log& log);

/// Understands `log`. Others of the same controller (same channels in the same order) help: a scale that shows in one
/// of them holds for all. `log` is among them.
Understanding understand(const Log& log, const std::vector<const Log*>& group, const OpeningHints& hints);

/// The mapping in the language of --map: `x_mm="Pos [Ink]"*1.25e-4`.
std::string mapping_text(const Mapping& mapping);

/// A column's name as --map takes it: in quotes where it holds blanks or signs.
std::string source_text(const std::string& name);

}  // namespace host
