// Assigns each sample to a regime: standstill, reversal, low speed, constant speed, acceleration, braking.
#pragma once

#include <string_view>
#include <vector>

#include "host/evidence/prepared_record.hpp"

namespace host {

enum class Regime { standstill, reversal, low_speed, constant_speed, acceleration, braking, saturated_command };

inline constexpr Regime kRegimes[] = {Regime::standstill,       Regime::reversal,     Regime::low_speed,
                                      Regime::constant_speed,   Regime::acceleration, Regime::braking,
                                      Regime::saturated_command};

/// "constant_speed" etc., as in JSON.
std::string_view regime_name(Regime regime);

/// Travel after a reversal that still belongs to the reversal, mm or m: 50 um, in which elastic contacts wind up.
double reversal_travel(const sim::DataSheet& data);

/// One element per sample. Saturation of the command takes precedence over all others, standstill over reversal.
std::vector<Regime> regimes_of(const PreparedRecord& prepared, const sim::DataSheet& data);

}  // namespace host
