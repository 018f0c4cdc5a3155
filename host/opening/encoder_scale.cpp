#include "host/opening/encoder_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

namespace host {

namespace {

using std::numbers::pi;

/// Counts per turn: lines times four, powers of two, and round decimal numbers.
constexpr double kCounts[] = {400,     800,     1000,    1024,    2000,    2048,    2400,   3600,   4000,
                              4096,    5000,    8000,    8192,    10000,   16384,   20000,  25000,  32768,
                              36000,   40000,   65536,   80000,   100000,  131072,  262144, 360000, 524288,
                              1000000, 1048576, 2097152, 4194304, 8388608, 16777216};

/// Travel per turn, mm.
constexpr double kScrews[] = {1,  1.25, 1.5, 2,  2.5,  3,  4,  5,  6,  6.35, 8,  10, 12, 12.7,
                              15, 16,   20,  25, 25.4, 30, 32, 36, 40, 50,   60, 80, 100};

struct NamedScale {
  double value;
  std::string_view name;
};

constexpr NamedScale kAngularSpeeds[] = {
    {1.0, "rad/s"}, {pi / 30.0, "1/min"}, {2.0 * pi, "turns/s"}, {pi / 180.0, "deg/s"}, {1e-3, "mrad/s"}};
constexpr NamedScale kLinearSpeeds[] = {{1.0, "mm/s"},         {1e3, "m/s"},     {1.0 / 60.0, "mm/min"},
                                        {1e3 / 60.0, "m/min"}, {25.4, "inch/s"}, {25.4 / 60.0, "inch/min"},
                                        {1e-3, "um/s"}};
constexpr NamedScale kAngles[] = {{1.0, "rad"}, {2.0 * pi, "turns"}, {pi / 180.0, "deg"}, {1e-3, "mrad"}};
constexpr NamedScale kLengths[] = {{1.0, "mm"}, {1e3, "m"}, {25.4, "inch"}, {1e-3, "um"}};

/// Units differ by much more than this. It allows for errors of a speed filter or a poor fit.
constexpr double kUnitTolerance = 0.02;

std::optional<NeatScale> nearest(std::span<const NamedScale> scales, double measured) {
  for (const NamedScale& scale : scales)
    if (std::abs(std::abs(measured) / scale.value - 1.0) <= kUnitTolerance)
      return NeatScale{std::copysign(scale.value, measured), std::string(scale.name)};
  return std::nullopt;
}

}  // namespace

std::optional<NeatScale> neat_counts_per_mm(double measured, double tolerance) {
  struct Ratio {
    double value = 0.0, counts = 0.0, screw = 0.0;
    int ways = 0;  ///< number of combinations of usual encoders and screws with this value
  };
  constexpr double kUsualScrew = 10.0;
  std::vector<Ratio> ratios;
  for (const double screw : kScrews)
    for (const double counts : kCounts) {
      const double value = counts / screw;
      if (std::abs(std::abs(measured) / value - 1.0) > tolerance) continue;
      auto same = std::ranges::find_if(ratios, [&](const Ratio& r) { return std::abs(r.value / value - 1.0) < 1e-9; });
      if (same == ratios.end()) same = ratios.insert(same, Ratio{value, counts, screw, 0});
      ++same->ways;
      if (std::abs(std::log(screw / kUsualScrew)) < std::abs(std::log(same->screw / kUsualScrew)))
        *same = {value, counts, screw, same->ways};
    }
  const auto best = std::ranges::max_element(ratios, {}, &Ratio::ways);
  if (best == ratios.end()) return std::nullopt;
  return NeatScale{std::copysign(best->value, measured),
                   fmt::format("{:.10g} counts in {:g} mm", best->counts, best->screw)};
}

std::optional<NeatScale> neat_counts_per_rad(double measured, double tolerance) {
  std::optional<NeatScale> best;
  double least = tolerance;
  for (const double counts : kCounts) {
    const double off = std::abs(std::abs(measured) * 2.0 * pi / counts - 1.0);
    if (off > least) continue;
    least = off;
    best = NeatScale{std::copysign(counts / (2.0 * pi), measured), fmt::format("{:g} counts a turn", counts)};
  }
  return best;
}

std::optional<NeatScale> neat_angular_speed(double measured) { return nearest(kAngularSpeeds, measured); }
std::optional<NeatScale> neat_linear_speed(double measured) { return nearest(kLinearSpeeds, measured); }
std::optional<NeatScale> neat_angle(double measured) { return nearest(kAngles, measured); }
std::optional<NeatScale> neat_length(double measured) { return nearest(kLengths, measured); }

}  // namespace host
