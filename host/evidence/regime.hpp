// What the axis does at each sample of a record: stands, has just reversed, creeps, cruises, speeds up, brakes.
#pragma once

#include <string_view>
#include <vector>

#include "host/evidence/prepared_record.hpp"

namespace host {

enum class Regime { standstill, reversal, low_speed, constant_speed, acceleration, braking, saturated_command };

inline constexpr Regime kRegimes[] = {Regime::standstill,       Regime::reversal,     Regime::low_speed,
                                      Regime::constant_speed,   Regime::acceleration, Regime::braking,
                                      Regime::saturated_command};

/// "constant_speed", as in JSON.
std::string_view regime_name(Regime regime);

/// Travel after a reversal that still belongs to it, mm or m: 50 um, while elastic contacts wind up.
double reversal_travel(const sim::DataSheet& data);

/// One element a sample. A saturated command comes before all others, standstill before a reversal.
std::vector<Regime> regimes_of(const PreparedRecord& prepared, const sim::DataSheet& data);

}  // namespace host
