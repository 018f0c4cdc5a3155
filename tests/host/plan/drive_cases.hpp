// The plants of the public cases, made with IndependentDrive from their truth files.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"
#include "tests/host/plan/independent_drive.hpp"

/// The drive of a truth file, without its data sheet.
inline IndependentDrive drive_of_truth(const nlohmann::json& truth) {
  IndependentDrive drive;
  const auto& base = truth["base"];
  drive.J = base["J"];
  drive.B = base["B"];
  drive.coulomb_positive = base["Tcoul"][0];
  drive.coulomb_negative = -base["Tcoul"][1].get<double>();
  if (!base["stribeck"].is_null()) {
    drive.stribeck_ratio = base["stribeck"][0];
    drive.stribeck_speed = base["stribeck"][1];
  }
  const std::vector<std::pair<const char*, double IndependentDrive::*>> names = {
      {"Tgrav", &IndependentDrive::load},
      {"u_off", &IndependentDrive::dac_offset},
      {"u_dead", &IndependentDrive::dead_zone},
      {"delay", &IndependentDrive::delay_s},
      {"cur_bw", &IndependentDrive::current_bandwidth_Hz},
      {"sigma0", &IndependentDrive::sigma0},
      {"sigma1", &IndependentDrive::sigma1},
      {"f_res", &IndependentDrive::resonance_Hz},
      {"zeta_res", &IndependentDrive::damping},
      {"load_frac", &IndependentDrive::load_share},
      {"backlash_mm", &IndependentDrive::gap_mm}};
  for (const auto& [kind, parameters] : truth["parameters"].items())
    for (const auto& [name, member] : names)
      if (parameters.contains(name)) drive.*member = parameters[name];
  return drive;
}

inline void put_data_sheet(IndependentDrive& drive, const sim::DataSheet& data) {
  drive.torque_per_volt = data.effort_per_volt();
  drive.lead = data.lead;
  drive.dac_step = data.dac_resolution_V;
  drive.dac_limit = data.dac_limit_V;
  drive.encoder_step = data.encoder_resolution;
  drive.tach_variance = data.tach_noise_variance.value_or(0.0);
}

/// Applies the commands of a record to the drive in open loop.
inline host::Record replayed(IndependentDrive drive, const host::Record& record) {
  host::Record own = record;
  own.path = "replayed " + record.path;
  for (std::size_t k = 0; k < own.size(); ++k) {
    own.x[k] = static_cast<double>(drive.counts()) * drive.encoder_step;
    if (own.has_speed()) own.w[k] = drive.tachometer();
    drive.hold(own.u_V[k]);
    drive.advance(own.sample_period_s);
  }
  return own;
}
