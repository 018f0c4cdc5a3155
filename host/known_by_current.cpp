#include "host/known_by_current.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"

namespace host {

namespace {

/// Command limit that marks a drive without a known converter: the highest current (A) that a record may hold.
constexpr double kNoConverter_V = 1e4;

bool is_rotary(const sim::DataSheet& sheet) { return sheet.kind == sim::DriveKind::rotary; }

}  // namespace

void know_by_current(sim::DataSheet& sheet) {
  if (is_rotary(sheet))
    sheet.amplifier_gain_A_per_V = 1.0;
  else
    sheet.force_constant_N_per_V = sheet.torque_constant_Nm_per_A;
  sheet.dac_limit_V = kNoConverter_V;
}

bool is_known_by_current(const sim::DataSheet& sheet) { return sheet.dac_limit_V == kNoConverter_V; }

void require_volts(const sim::DataSheet& sheet, std::string_view name, std::string_view what) {
  if (!is_known_by_current(sheet)) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("drive '{}': {} needs the {} per volt, but its data sheet gives only that per ampere; "
                            "add {} to [drive]",
                            name, what, is_rotary(sheet) ? "torque" : "force",
                            is_rotary(sheet) ? "amplifier_gain_A_per_V" : "force_constant_N_per_V"));
}

}  // namespace host
