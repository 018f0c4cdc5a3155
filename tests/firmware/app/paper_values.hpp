// The paper's x axis as a set of parameter values, and setting values by name.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "firmware/app/parameters/parameter_values.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace firmware_test {

/// "x.kalman.k11", "control.rate". Throws for an unknown name.
inline std::size_t place_named(std::string_view name) {
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kMostAxes); ++place) {
    const std::size_t owner = firmware::key_at(place).owner();
    const std::string_view row = firmware::kParameters[firmware::row_at(place)].name;
    if ((owner == 0 ? std::string() : std::string(firmware::kAxisNames[owner - 1]) + ".") + std::string(row) == name)
      return place;
  }
  throw std::invalid_argument("no parameter " + std::string(name));
}

inline void set(firmware::ParameterValues& values, std::string_view name, double value) {
  values.set(place_named(name), static_cast<float>(value));
}

/// One of the paper's axes with every compensation on, as axis "x" or "y".
inline void fit_axis(firmware::ParameterValues& values, const std::string& axis, const PaperAxis& paper) {
  const auto put = [&](const char* name, double value) { set(values, axis + "." + name, value); };
  put("drive.fitted", 1);
  put("drive.lead", kLead_mm_per_rad);
  put("drive.encoder_resolution", kEncoderResolution_mm);
  put("drive.dac_resolution", kDacResolution_V);
  put("drive.effort_per_volt", paper.amplifier_gain_A_per_V * kMotorConstant_Nm_per_A);
  put("model.a12", paper.Ad12);
  put("model.a22", paper.Ad22);
  put("model.b1", paper.Bd1);
  put("model.b2", paper.Bd2);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 2; ++column)
      put(("kalman.k" + std::to_string(row + 1) + std::to_string(column + 1)).c_str(), paper.Kobs[row][column]);
  put("feedback.k1", paper.Kc[0]);
  put("feedback.k2", paper.Kc[1]);
  for (const char* name : {"feedback.cancel_disturbance", "feedforward.zero_phase", "feedforward.friction"})
    put(name, 1);
  for (int side = 0; side < 2; ++side) {
    const std::string sign = side == 0 ? "positive" : "negative";
    put(("friction.static_" + sign).c_str(), paper.static_Nm[side]);
    put(("friction.coulomb_" + sign).c_str(), paper.coulomb_Nm[side]);
    put(("friction.viscous_" + sign).c_str(), paper.viscous_Nm_s_per_rad - paper.model_viscous_Nm_s_per_rad);
    put(("friction.omega1_" + sign).c_str(), paper.omega1_rad_s[side]);
    put(("friction.omega2_" + sign).c_str(), paper.omega2_rad_s[side]);
  }
}

inline firmware::ParameterValues paper_values(std::size_t axes = hal::kAxisCount) {
  firmware::ParameterValues values(axes);
  fit_axis(values, "x", kPaperX);
  return values;
}

}  // namespace firmware_test
