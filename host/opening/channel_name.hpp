// Meaning of a channel's name: quantity, axis, reference or measured value, unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/import/log_file.hpp"
#include "host/opening/units.hpp"

namespace host {

enum class ChannelQuantity {
  unknown,
  time,
  position,
  speed,
  current,
  torque,
  force,
  voltage,
  temperature,
  other,  ///< recognised, but not used: acceleration, error, status, supply voltage
};

struct ChannelName {
  ChannelQuantity quantity = ChannelQuantity::unknown;
  bool is_reference = false;        ///< reference: set point, command, target
  bool is_measured = false;         ///< named as measured: actual, feedback
  bool is_second = false;           ///< on the load side: a scale on the table
  bool is_weak = false;             ///< one letter, or a word that may mean something else ("enc", "u", "q")
  bool makes_torque = false;        ///< q current, torque-producing
  std::string axis;                 ///< "X1", "2"; empty if the name has none
  std::string unit_text;            ///< as the log gives it
  std::optional<UnitMeaning> unit;  ///< empty if there is none or it is unknown
  /// For a joint that may turn or slide: the unit if it slides (`unit`: if it turns).
  std::optional<UnitMeaning> sliding_unit{};
};

/// Recognises words in English, German, French, Spanish, Italian, Russian, Chinese and Japanese, and names of some
/// controllers. The unit comes from the column itself, from brackets, or from the end of the name.
ChannelName understand_name(const LogColumn& column);

/// "position", "speed", …
std::string_view quantity_name(ChannelQuantity quantity);

}  // namespace host
