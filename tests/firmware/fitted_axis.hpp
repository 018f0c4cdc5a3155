// The paper's axes as parameter values, found by name; also for images, which have no exceptions.
#pragma once

#include <optional>
#include <string_view>

#include "firmware/app/parameters/parameter_values.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace firmware_test {

/// A row of the table, of the board ("") or of an axis ("x").
inline std::optional<std::size_t> find_place(std::string_view owner_name, std::string_view row_name) {
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kMostAxes); ++place) {
    const std::size_t owner = firmware::key_at(place).owner();
    if (firmware::kParameters[firmware::row_at(place)].name != row_name) continue;
    if (owner_name == (owner == 0 ? std::string_view() : firmware::kAxisNames[owner - 1])) return place;
  }
  return std::nullopt;
}

/// One of the paper's axes with every compensation on, as axis "x" or "y".
inline void fit_axis(firmware::ParameterValues& values, std::string_view axis, const PaperAxis& paper) {
  const auto put = [&](std::string_view name, double value) {
    const auto place = find_place(axis, name);
    if (!place) __builtin_trap();
    values.set(*place, static_cast<float>(value));
  };
  put("drive.fitted", 1);
  put("drive.lead", kLead_mm_per_rad);
  put("drive.encoder_resolution", kEncoderResolution_mm);
  put("drive.dac_resolution", kDacResolution_V);
  put("drive.effort_per_volt", paper.amplifier_gain_A_per_V * kMotorConstant_Nm_per_A);
  put("model.a12", paper.Ad12);
  put("model.a22", paper.Ad22);
  put("model.b1", paper.Bd1);
  put("model.b2", paper.Bd2);
  constexpr std::string_view kGains[3][2] = {
      {"kalman.k11", "kalman.k12"}, {"kalman.k21", "kalman.k22"}, {"kalman.k31", "kalman.k32"}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 2; ++column) put(kGains[row][column], paper.Kobs[row][column]);
  put("feedback.k1", paper.Kc[0]);
  put("feedback.k2", paper.Kc[1]);
  for (const char* name : {"feedback.cancel_disturbance", "feedforward.zero_phase", "feedforward.friction"})
    put(name, 1);
  struct Side {
    std::string_view stiction, coulomb, viscous, omega1, omega2;
  };
  constexpr Side kSides[2] = {{"friction.static_positive", "friction.coulomb_positive", "friction.viscous_positive",
                               "friction.omega1_positive", "friction.omega2_positive"},
                              {"friction.static_negative", "friction.coulomb_negative", "friction.viscous_negative",
                               "friction.omega1_negative", "friction.omega2_negative"}};
  for (int side = 0; side < 2; ++side) {
    put(kSides[side].stiction, paper.static_Nm[side]);
    put(kSides[side].coulomb, paper.coulomb_Nm[side]);
    put(kSides[side].viscous, paper.viscous_Nm_s_per_rad - paper.model_viscous_Nm_s_per_rad);
    put(kSides[side].omega1, paper.omega1_rad_s[side]);
    put(kSides[side].omega2, paper.omega2_rad_s[side]);
  }
}

}  // namespace firmware_test
