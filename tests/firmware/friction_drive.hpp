// The paper's drives with their friction (Table 1), as simulated plants.
#pragma once

#include "sim/drive_description.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace firmware_test {

inline sim::DriveDescription friction_drive(const PaperAxis& axis) {
  sim::DriveDescription drive;
  drive.data.amplifier_gain_A_per_V = axis.amplifier_gain_A_per_V;
  drive.data.torque_constant_Nm_per_A = kMotorConstant_Nm_per_A;
  drive.data.lead = kLead_mm_per_rad;
  drive.data.sample_period_s = kSamplePeriod_s;
  drive.data.dac_resolution_V = kDacResolution_V;
  drive.data.dac_limit_V = 10.0;
  drive.data.encoder_resolution = kEncoderResolution_mm;
  drive.data.tach_noise_variance = 0.05;  // Table 1
  const auto entry = [&](const char* kind, std::map<std::string, double> parameters) {
    drive.effects.push_back({kind, std::move(parameters), {}, {}});
  };
  entry("inertia", {{"J", axis.inertia_kg_m2}});
  entry("viscous", {{"B", axis.viscous_Nm_s_per_rad}});
  entry("coulomb", {{"positive", axis.coulomb_Nm[0]}, {"negative", -axis.coulomb_Nm[1]}});
  entry("stribeck", {{"static_positive", axis.static_Nm[0]},
                     {"static_negative", -axis.static_Nm[1]},
                     {"omega1_positive", axis.omega1_rad_s[0]},
                     {"omega1_negative", -axis.omega1_rad_s[1]},
                     {"omega2_positive", axis.omega2_rad_s[0]},
                     {"omega2_negative", -axis.omega2_rad_s[1]}});
  return drive;
}

}  // namespace firmware_test
