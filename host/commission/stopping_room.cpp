#include "host/commission/stopping_room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

StoppingRoom stopping_room(const StoppingFigures& axis, double speed) {
  return {speed, ramp_way(axis, speed).travel, drop_way(axis, speed).travel};
}

double fastest_within(const StoppingFigures& axis, double room) {
  const auto needs = [&axis](double speed) {
    const StoppingRoom way = stopping_room(axis, speed);
    return std::max(way.ramp, way.dropped);
  };
  double most = 1.0;
  constexpr int kRounds = 60;
  for (int k = 0; k < kRounds && needs(most) <= room; ++k) most *= 2.0;
  double least = 0.0;
  for (int k = 0; k < kRounds; ++k) {
    const double speed = (least + most) / 2.0;
    (needs(speed) <= room ? least : most) = speed;
  }
  return needs(least) <= room && least > 1e-6 ? least : 0.0;
}

std::string check_stopping_room(const StoppingFigures& axis, double speed, std::optional<double> overtravel,
                                const char* unit) {
  const StoppingRoom room = stopping_room(axis, speed);
  const std::string coasts = std::isfinite(room.dropped)
                                 ? fmt::format("moves on for {:.3g} {}", room.dropped, unit)
                                 : std::string("does not stop by itself: its weight exceeds its friction");
  const std::string said =
      fmt::format("From {:.4g} {}/s it stops within {:.3g} {} along its ramp; without current it {}.", speed, unit,
                  room.ramp, unit, coasts);
  if (!overtravel) return said + " Make sure that this distance is free beyond the box (--overtravel checks it).";
  if (std::max(room.ramp, room.dropped) <= *overtravel)
    return said + fmt::format(" Beyond the box {:g} {} are free.", *overtravel, unit);
  const double fastest = fastest_within(axis, *overtravel);
  throw Failure(ExitCode::refused,
                fmt::format("{} Only {:g} {} are free beyond the box (--overtravel): {}a smaller box, or a brake or "
                            "dynamic brake that stops the axis",
                            said, *overtravel, unit,
                            fastest > 0.0 ? fmt::format("at most speed={:.3g} in --box, ", fastest) : std::string()));
}

void check_feedback_at_rest(const StoppingFigures& axis, bool notices_dead_encoder) {
  if (notices_dead_encoder || axis.weight <= axis.friction) return;
  throw Failure(
      ExitCode::refused,
      "The axis falls without current: its weight exceeds its friction. If its encoder dies at rest, only a "
      "tachometer or the fault output of the encoder's receivers shows it before the axis falls: fit one, and "
      "set tachometer.fitted or encoder.fault_input");
}

}  // namespace host
