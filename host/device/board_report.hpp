// What a board says about itself, in words.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/device/board_client.hpp"

namespace host {

std::string state_text(const firmware::AxisStatus& axis);
std::string store_text(std::uint8_t store_state);
std::string reset_text(std::uint8_t reset_cause);

/// Why the store keeps the drives disabled, with the remedy; empty while it does not.
std::optional<std::string> store_problem(const BoardState& status);

/// Name, version, table, store, axes: format "axis-board/1". `values`: where the board has this axistool's table; then
/// fitted axes tell their positions in mm, or m (a linear drive: its lead is 1).
nlohmann::json board_json(const std::string& device, const firmware::IdentityPayload& identity,
                          const BoardState& status, const firmware::TimingPayload& timing,
                          const firmware::ParameterValues* values = nullptr);
/// The same for people.
std::string board_text(const std::string& device, const firmware::IdentityPayload& identity, const BoardState& status,
                       const firmware::TimingPayload& timing, const firmware::ParameterValues* values = nullptr);
/// The axis's fault and what went wrong besides, or empty.
std::string fault_text(const firmware::AxisStatus& axis);

}  // namespace host
