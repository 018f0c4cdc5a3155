// The state of a board, in words.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/device/board_client.hpp"

namespace host {

std::string state_text(const firmware::AxisStatus& axis);
std::string store_text(std::uint8_t store_state);
std::string reset_text(std::uint8_t reset_cause);

/// Whether the drive is linear: its lead is 1.
bool is_linear(std::size_t axis, const firmware::ParameterValues& values);
/// mm, or m of a linear drive.
const char* travel_unit(std::size_t axis, const firmware::ParameterValues& values);

struct AxisPlace {
  double value;
  const char* unit;  ///< travel_unit()
};
/// Empty if the board's table of parameters is not known, or the axis is not fitted.
std::optional<AxisPlace> place_of_counts(std::int64_t counts, std::size_t axis,
                                         const firmware::ParameterValues* values);

/// Message about a missing brown-out reset: consequence and remedy.
std::string brown_out_problem();

/// Why the store keeps the drives disabled, with the remedy; empty if it does not.
std::optional<std::string> store_problem(const BoardState& status);

/// Name, version, table, store, axes: format "axis-board/1". `values`: given if the board has this axistool's table;
/// then positions of fitted axes are in mm or m.
nlohmann::json board_json(const std::string& device, const firmware::IdentityPayload& identity,
                          const BoardState& status, const firmware::TimingPayload& timing,
                          const firmware::ParameterValues* values = nullptr);
/// The same as text.
std::string board_text(const std::string& device, const firmware::IdentityPayload& identity, const BoardState& status,
                       const firmware::TimingPayload& timing, const firmware::ParameterValues* values = nullptr);
const char* fault_name(std::uint8_t fault);
/// A fault and the second fault, if any; empty without a fault.
std::string fault_text(std::uint8_t fault, std::uint8_t second_fault);
inline std::string fault_text(const firmware::AxisStatus& axis) { return fault_text(axis.fault, axis.second_fault); }

}  // namespace host
