#include "host/opening/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <utility>

#include "host/number.hpp"

namespace host {

namespace {

constexpr double kWholeTurn_rad = 2.0 * std::numbers::pi, kDegree = kWholeTurn_rad / 360.0, kInch = 25.4,
                 kPound_N = 4.4482216;

struct NamedUnit {
  std::string_view name;
  UnitMeaning meaning;
};

/// Case-sensitive names, because M is not m.
constexpr NamedUnit kExact[] = {
    {"s", {Dimension::time}},
    {"S", {Dimension::time}},
    {"A", {Dimension::current}},
    {"А", {Dimension::current}},  // Cyrillic
    {"V", {Dimension::voltage}},
    {"В", {Dimension::voltage}},  // Cyrillic
    {"m", {Dimension::length, 1e3}},
    {"м", {Dimension::length, 1e3}},
    {"N", {Dimension::force}},
    {"Н", {Dimension::force}},  // Cyrillic
    {"U", {Dimension::angle, kWholeTurn_rad}},
    {"C", {Dimension::temperature}},
    {"K", {Dimension::temperature, 1.0, -273.15}},
    {"Hz", {Dimension::angular_speed, kWholeTurn_rad}},
    {"MS", {Dimension::time, 1e-3}},
    {"mN", {Dimension::force, 1e-3}},
    {"nm", {Dimension::length, 1e-6}},
};

/// Names in lower case, without blanks, with "." for "·" and "*", and "2" for "²".
constexpr NamedUnit kFolded[] = {
    // time
    {"sec", {Dimension::time}},
    {"secs", {Dimension::time}},
    {"second", {Dimension::time}},
    {"seconds", {Dimension::time}},
    {"sek", {Dimension::time}},
    {"sekunden", {Dimension::time}},
    {"с", {Dimension::time}},
    {"сек", {Dimension::time}},
    {"秒", {Dimension::time}},
    {"ms", {Dimension::time, 1e-3}},
    {"msec", {Dimension::time, 1e-3}},
    {"millis", {Dimension::time, 1e-3}},
    {"millisecond", {Dimension::time, 1e-3}},
    {"milliseconds", {Dimension::time, 1e-3}},
    {"мс", {Dimension::time, 1e-3}},
    {"毫秒", {Dimension::time, 1e-3}},
    {"us", {Dimension::time, 1e-6}},
    {"usec", {Dimension::time, 1e-6}},
    {"micros", {Dimension::time, 1e-6}},
    {"microseconds", {Dimension::time, 1e-6}},
    {"мкс", {Dimension::time, 1e-6}},
    {"微秒", {Dimension::time, 1e-6}},
    {"ns", {Dimension::time, 1e-9}},
    {"nsec", {Dimension::time, 1e-9}},
    {"nanoseconds", {Dimension::time, 1e-9}},
    {"min", {Dimension::time, 60.0}},
    // angle
    {"rad", {Dimension::angle}},
    {"radian", {Dimension::angle}},
    {"radians", {Dimension::angle}},
    {"рад", {Dimension::angle}},
    {"弧度", {Dimension::angle}},
    {"mrad", {Dimension::angle, 1e-3}},
    {"urad", {Dimension::angle, 1e-6}},
    {"deg", {Dimension::angle, kDegree}},
    {"degs", {Dimension::angle, kDegree}},
    {"degree", {Dimension::angle, kDegree}},
    {"degrees", {Dimension::angle, kDegree}},
    {"grad", {Dimension::angle, kDegree}},
    {"град", {Dimension::angle, kDegree}},
    {"°", {Dimension::angle, kDegree}},
    {"度", {Dimension::angle, kDegree}},
    {"mdeg", {Dimension::angle, 1e-3 * kDegree}},
    {"arcmin", {Dimension::angle, kDegree / 60.0}},
    {"arcsec", {Dimension::angle, kDegree / 3600.0}},
    {"turn", {Dimension::angle, kWholeTurn_rad}},
    {"turns", {Dimension::angle, kWholeTurn_rad}},
    {"rev", {Dimension::angle, kWholeTurn_rad}},
    {"revs", {Dimension::angle, kWholeTurn_rad}},
    {"revolutions", {Dimension::angle, kWholeTurn_rad}},
    {"umdr", {Dimension::angle, kWholeTurn_rad}},
    {"umdrehungen", {Dimension::angle, kWholeTurn_rad}},
    {"tr", {Dimension::angle, kWholeTurn_rad}},
    {"об", {Dimension::angle, kWholeTurn_rad}},
    {"圈", {Dimension::angle, kWholeTurn_rad}},
    // length
    {"mm", {Dimension::length}},
    {"мм", {Dimension::length}},
    {"毫米", {Dimension::length}},
    {"millimeter", {Dimension::length}},
    {"cm", {Dimension::length, 10.0}},
    {"um", {Dimension::length, 1e-3}},
    {"мкм", {Dimension::length, 1e-3}},
    {"micron", {Dimension::length, 1e-3}},
    {"meter", {Dimension::length, 1e3}},
    {"metre", {Dimension::length, 1e3}},
    {"in", {Dimension::length, kInch}},
    {"inch", {Dimension::length, kInch}},
    {"inches", {Dimension::length, kInch}},
    {"zoll", {Dimension::length, kInch}},
    {"pouces", {Dimension::length, kInch}},
    // counts
    {"count", {Dimension::counts}},
    {"counts", {Dimension::counts}},
    {"cnt", {Dimension::counts}},
    {"cnts", {Dimension::counts}},
    {"cts", {Dimension::counts}},
    {"inc", {Dimension::counts}},
    {"incs", {Dimension::counts}},
    {"incr", {Dimension::counts}},
    {"increments", {Dimension::counts}},
    {"ink", {Dimension::counts}},
    {"inkr", {Dimension::counts}},
    {"inkremente", {Dimension::counts}},
    {"pulse", {Dimension::counts}},
    {"pulses", {Dimension::counts}},
    {"pls", {Dimension::counts}},
    {"puls", {Dimension::counts}},
    {"imp", {Dimension::counts}},
    {"impulse", {Dimension::counts}},
    {"impulsions", {Dimension::counts}},
    {"impulsos", {Dimension::counts}},
    {"impulsi", {Dimension::counts}},
    {"tick", {Dimension::counts}},
    {"ticks", {Dimension::counts}},
    {"qc", {Dimension::counts}},
    {"lsb", {Dimension::counts}},
    {"имп", {Dimension::counts}},
    {"инк", {Dimension::counts}},
    {"脉冲", {Dimension::counts}},
    {"パルス", {Dimension::counts}},
    // angular speed
    {"rad/s", {Dimension::angular_speed}},
    {"rad/sec", {Dimension::angular_speed}},
    {"rad.s-1", {Dimension::angular_speed}},
    {"рад/с", {Dimension::angular_speed}},
    {"mrad/s", {Dimension::angular_speed, 1e-3}},
    {"deg/s", {Dimension::angular_speed, kDegree}},
    {"deg/sec", {Dimension::angular_speed, kDegree}},
    {"dps", {Dimension::angular_speed, kDegree}},
    {"°/s", {Dimension::angular_speed, kDegree}},
    {"grad/s", {Dimension::angular_speed, kDegree}},
    {"град/с", {Dimension::angular_speed, kDegree}},
    {"rpm", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"r.p.m.", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"r/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"rev/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"1/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"min-1", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"u/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"upm", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"umdr/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"tr/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"giri/min", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"об/мин", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"转/分", {Dimension::angular_speed, kWholeTurn_rad / 60.0}},
    {"mrpm", {Dimension::angular_speed, 1e-3 * kWholeTurn_rad / 60.0}},
    {"rps", {Dimension::angular_speed, kWholeTurn_rad}},
    {"rev/s", {Dimension::angular_speed, kWholeTurn_rad}},
    {"r/s", {Dimension::angular_speed, kWholeTurn_rad}},
    {"turn/s", {Dimension::angular_speed, kWholeTurn_rad}},
    {"turns/s", {Dimension::angular_speed, kWholeTurn_rad}},
    {"u/s", {Dimension::angular_speed, kWholeTurn_rad}},
    {"tr/s", {Dimension::angular_speed, kWholeTurn_rad}},
    {"об/с", {Dimension::angular_speed, kWholeTurn_rad}},
    // linear speed
    {"m/s", {Dimension::linear_speed, 1e3}},
    {"м/с", {Dimension::linear_speed, 1e3}},
    {"mm/s", {Dimension::linear_speed}},
    {"mm/sec", {Dimension::linear_speed}},
    {"mm.s-1", {Dimension::linear_speed}},
    {"мм/с", {Dimension::linear_speed}},
    {"毫米/秒", {Dimension::linear_speed}},
    {"um/s", {Dimension::linear_speed, 1e-3}},
    {"cm/s", {Dimension::linear_speed, 10.0}},
    {"mm/min", {Dimension::linear_speed, 1.0 / 60.0}},
    {"мм/мин", {Dimension::linear_speed, 1.0 / 60.0}},
    {"m/min", {Dimension::linear_speed, 1e3 / 60.0}},
    {"м/мин", {Dimension::linear_speed, 1e3 / 60.0}},
    {"in/s", {Dimension::linear_speed, kInch}},
    {"inch/s", {Dimension::linear_speed, kInch}},
    {"ips", {Dimension::linear_speed, kInch}},
    {"in/min", {Dimension::linear_speed, kInch / 60.0}},
    {"inch/min", {Dimension::linear_speed, kInch / 60.0}},
    {"ipm", {Dimension::linear_speed, kInch / 60.0}},
    // speed in counts
    {"count/s", {Dimension::count_speed}},
    {"counts/s", {Dimension::count_speed}},
    {"cnt/s", {Dimension::count_speed}},
    {"cts/s", {Dimension::count_speed}},
    {"inc/s", {Dimension::count_speed}},
    {"ink/s", {Dimension::count_speed}},
    {"pulse/s", {Dimension::count_speed}},
    {"pulses/s", {Dimension::count_speed}},
    {"pls/s", {Dimension::count_speed}},
    {"имп/с", {Dimension::count_speed}},
    {"脉冲/秒", {Dimension::count_speed}},
    // acceleration
    {"rad/s2", {Dimension::acceleration}},
    {"rad/s/s", {Dimension::acceleration}},
    {"deg/s2", {Dimension::acceleration}},
    {"m/s2", {Dimension::acceleration}},
    {"mm/s2", {Dimension::acceleration}},
    {"rev/s2", {Dimension::acceleration}},
    // current
    {"ma", {Dimension::current, 1e-3}},
    {"мa", {Dimension::current, 1e-3}},
    {"мА", {Dimension::current, 1e-3}},
    {"ua", {Dimension::current, 1e-6}},
    {"amp", {Dimension::current}},
    {"amps", {Dimension::current}},
    {"ampere", {Dimension::current}},
    {"arms", {Dimension::current}},
    {"a_rms", {Dimension::current}},
    {"aeff", {Dimension::current}},
    {"apk", {Dimension::current}},
    {"安", {Dimension::current}},
    // torque and force
    {"nm", {Dimension::torque}},
    {"n.m", {Dimension::torque}},
    {"n-m", {Dimension::torque}},
    {"нм", {Dimension::torque}},
    {"н.м", {Dimension::torque}},
    {"牛米", {Dimension::torque}},
    {"mnm", {Dimension::torque, 1e-3}},
    {"mn.m", {Dimension::torque, 1e-3}},
    {"мнм", {Dimension::torque, 1e-3}},
    {"ncm", {Dimension::torque, 1e-2}},
    {"n.cm", {Dimension::torque, 1e-2}},
    {"knm", {Dimension::torque, 1e3}},
    {"lbf.in", {Dimension::torque, kPound_N* kInch * 1e-3}},
    {"lb.in", {Dimension::torque, kPound_N* kInch * 1e-3}},
    {"in.lb", {Dimension::torque, kPound_N* kInch * 1e-3}},
    {"oz.in", {Dimension::torque, kPound_N* kInch * 1e-3 / 16.0}},
    {"newton", {Dimension::force}},
    {"kn", {Dimension::force, 1e3}},
    {"lbf", {Dimension::force, kPound_N}},
    // voltage
    {"mv", {Dimension::voltage, 1e-3}},
    {"мв", {Dimension::voltage, 1e-3}},
    {"dv", {Dimension::voltage, 1e-1}},
    {"kv", {Dimension::voltage, 1e3}},
    {"volt", {Dimension::voltage}},
    {"volts", {Dimension::voltage}},
    {"伏", {Dimension::voltage}},
    // temperature
    {"°c", {Dimension::temperature}},
    {"degc", {Dimension::temperature}},
    {"deg_c", {Dimension::temperature}},
    {"celsius", {Dimension::temperature}},
    {"℃", {Dimension::temperature}},
    {"°с", {Dimension::temperature}},
    {"degf", {Dimension::temperature, 5.0 / 9.0, -160.0 / 9.0}},
    // shares
    {"%", {Dimension::share, 1e-2}},
    {"percent", {Dimension::share, 1e-2}},
    {"prozent", {Dimension::share, 1e-2}},
    {"‰", {Dimension::share, 1e-3}},
    {"0.1%", {Dimension::share, 1e-3}},
    {"pu", {Dimension::share}},
    {"p.u.", {Dimension::share}},
};

/// Normalises the spelling: lower case, no blanks, "." for a product, "u" for micro.
std::string folded(std::string_view text) {
  static constexpr std::pair<std::string_view, std::string_view> kSame[] = {{"·", "."},
                                                                            {"*", "."},
                                                                            {"⋅", "."},
                                                                            {"²", "2"},
                                                                            {"^2", "2"},
                                                                            {"µ", "u"},
                                                                            {"μ", "u"},
                                                                            {"⁻¹", "-1"},
                                                                            {"^-1", "-1"},
                                                                            {"º", "°"},
                                                                            {" ", ""},
                                                                            {"Н", "н"},
                                                                            {"М", "м"},
                                                                            {"С", "с"},
                                                                            {"И", "и"},
                                                                            {"О", "о"},
                                                                            {"revolutions/", "rev/"}};
  std::string plain;
  while (!text.empty()) {
    const auto* const same =
        std::ranges::find_if(kSame, [&](const auto& pair) { return text.starts_with(pair.first); });
    if (same != std::end(kSame)) {
      plain += same->second;
      text.remove_prefix(same->first.size());
      continue;
    }
    const char c = text.front();
    plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    text.remove_prefix(1);
  }
  return plain;
}

std::optional<UnitMeaning> folded_unit(std::string_view name) {
  for (const NamedUnit& unit : kFolded)
    if (unit.name == name) return unit.meaning;
  return std::nullopt;
}

}  // namespace

std::optional<UnitMeaning> unit_named(std::string_view text) {
  text = trim_blanks(text);
  constexpr std::size_t kLongest = 24;
  if (text.empty() || text.size() > kLongest) return std::nullopt;
  for (const NamedUnit& unit : kExact)
    if (unit.name == text) return unit.meaning;
  std::string name = folded(text);
  if (const auto unit = folded_unit(name)) return unit;
  // "rad_s" and "rad_per_s", as in column names.
  if (const std::size_t per = name.find("_per_"); per != std::string::npos)
    name = fmt::format("{}/{}", name.substr(0, per), name.substr(per + 5));
  if (const std::size_t per = name.find("per"); per != std::string::npos && per > 0)
    name = fmt::format("{}/{}", name.substr(0, per), name.substr(per + 3));
  if (name.find('/') == std::string::npos) std::ranges::replace(name, '_', '/');
  return folded_unit(name);
}

std::string_view unit_of(Dimension dimension) {
  static constexpr std::array<std::string_view, 14> kUnits{
      "s",   "rad", "mm", "counts", "rad/s", "mm/s",  "counts/s",
      "1/s", "A",   "Nm", "N",      "V",     "deg C", "of the rated value"};
  return kUnits[static_cast<std::size_t>(dimension)];
}

}  // namespace host
