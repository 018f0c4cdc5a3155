#include "host/identify/paper_drives.hpp"

#include <fmt/format.h>

#include <numbers>

#include "host/exit_codes.hpp"

namespace host {

namespace {

struct Table1 {
  double amplifier_gain_A_per_V, inertia_kg_m2, viscous_Nm_s;
  double static_Nm[2], coulomb_Nm[2], omega1_rad_s[2], omega2_rad_s[2];
};
constexpr Table1 kX = {6.4898, 7.65e-3, 0.0321, {3.647, -2.702}, {2.205, -1.656}, {2.0, -2.0}, {2.0, -2.0}};
constexpr Table1 kY = {7.5768, 9.79e-3, 0.0287, {3.652, -3.218}, {3.058, -2.739}, {4.1, -3.6}, {5.4, -4.2}};

constexpr const char* kDriveExample = R"(  format = "axis-model/1"
  name = "stage"
  [drive]
  kind = "linear"
  force_constant_N_per_V = 35.1507
  sample_period_s = 0.001
A rotary drive has amplifier_gain_A_per_V, torque_constant_Nm_per_A and lead_mm_per_rad in place of the force constant.)";

}  // namespace

std::optional<sim::DriveDescription> paper_drive(std::string_view name) {
  if (name != "x" && name != "y") return std::nullopt;
  const Table1& table = name == "x" ? kX : kY;
  sim::DriveDescription drive;
  drive.name = std::string(name);
  drive.data.amplifier_gain_A_per_V = table.amplifier_gain_A_per_V;
  drive.data.torque_constant_Nm_per_A = 0.4769;
  drive.data.lead = 10.0 / (2.0 * std::numbers::pi);  // pitch 10 mm; printed as 1.5915
  drive.data.sample_period_s = 0.001;
  drive.data.dac_resolution_V = 20.0 / 65536.0;
  drive.data.dac_limit_V = 10.0;
  drive.data.encoder_resolution = 10.0 / 4096.0;
  drive.data.tach_noise_variance = 0.05;
  const auto add = [&drive](const char* kind, std::map<std::string, double> parameters) {
    drive.effects.push_back({.kind = kind, .parameters = std::move(parameters), .ci95 = {}, .from = {}});
  };
  add("inertia", {{"J", table.inertia_kg_m2}});
  add("viscous", {{"B", table.viscous_Nm_s}});
  add("coulomb", {{"positive", table.coulomb_Nm[0]}, {"negative", table.coulomb_Nm[1]}});
  add("stribeck", {{"static_positive", table.static_Nm[0]},
                   {"static_negative", table.static_Nm[1]},
                   {"omega1_positive", table.omega1_rad_s[0]},
                   {"omega1_negative", table.omega1_rad_s[1]},
                   {"omega2_positive", table.omega2_rad_s[0]},
                   {"omega2_negative", table.omega2_rad_s[1]}});
  return drive;
}

sim::DriveDescription drive_named_by(const Record& record, std::vector<std::string>& warnings) {
  const auto known = record.kind == sim::DriveKind::rotary ? paper_drive(record.drive) : std::nullopt;
  if (!known)
    throw Failure(
        ExitCode::usage,
        fmt::format("{}: the drive is unknown. Converting volts to {} needs its data sheet. Write one and give it with "
                    "--drive DRIVE.toml, for example:\n"
                    "{}",
                    record.path, record.kind == sim::DriveKind::linear ? "newtons" : "torque", kDriveExample));
  warnings.push_back(
      fmt::format("no --drive was given: using the data sheet of the paper's drive {} (Ka = {:g} A/V, Kt = {:g} Nm/A), "
                  "which the record names",
                  record.drive, known->data.amplifier_gain_A_per_V, known->data.torque_constant_Nm_per_A));
  return *known;
}

}  // namespace host
