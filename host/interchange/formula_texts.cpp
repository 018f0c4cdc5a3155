// The same formulas in four languages: friction over speed with its derivative, and torques over the travel.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>

#include "host/interchange/export_model.hpp"

namespace host {

namespace {

/// Syntax of the parts in a language.
struct Language {
  std::string_view exp, pow, sin, cos;
};

constexpr Language kC{"axis_exp", "axis_pow", "axis_sin", "axis_cos"},
    kPython{"np.exp", "np.power", "np.sin", "np.cos"}, kPlain{"exp", "pow", "sin", "cos"};

/// Friction of one direction at v > 0.
std::string side_text(const PortableModel& model, int side, const Language& in) {
  const sim::SlidingCurve& curve = model.friction[static_cast<std::size_t>(side)];
  std::string text = fmt::format("{:.17g}", curve.coulomb);
  if (curve.rate1 > 0.0) text += fmt::format(" + {:.17g} * {}(-v * {:.17g})", curve.breakaway, in.exp, curve.rate1);
  if (curve.rate2 > 0.0) text += fmt::format(" - {:.17g} * {}(-v * {:.17g})", curve.coulomb, in.exp, curve.rate2);
  text += fmt::format(" + {:.17g} * v", curve.viscous);
  if (!model.bend) return text;
  const FrictionBend& bend = *model.bend;
  if (bend.saturation)
    return text + fmt::format(" - ({:.17g}) * {}(-v / {:.17g})", bend.coefficient, in.exp, *bend.saturation);
  return text + fmt::format(" + ({:.17g}) * {}(v / {:.17g}, {:.17g})", bend.coefficient, in.pow, bend.reference,
                            bend.exponent);
}

std::string slope_text(const PortableModel& model, int side, const Language& in) {
  const sim::SlidingCurve& curve = model.friction[static_cast<std::size_t>(side)];
  std::string text = fmt::format("{:.17g}", curve.viscous);
  if (curve.rate1 > 0.0)
    text += fmt::format(" - {:.17g} * {}(-v * {:.17g})", curve.breakaway * curve.rate1, in.exp, curve.rate1);
  if (curve.rate2 > 0.0)
    text += fmt::format(" + {:.17g} * {}(-v * {:.17g})", curve.coulomb * curve.rate2, in.exp, curve.rate2);
  if (!model.bend) return text;
  const FrictionBend& bend = *model.bend;
  if (bend.saturation)
    return text + fmt::format(" + ({:.17g}) * {}(-v / {:.17g})", bend.coefficient / *bend.saturation, in.exp,
                              *bend.saturation);
  return text + fmt::format(" + ({:.17g}) * {}(v / {:.17g}, {:.17g})",
                            bend.coefficient * bend.exponent / bend.reference, in.pow, bend.reference,
                            bend.exponent - 1.0);
}

std::string load_text(const PortableModel& model, const Language& in) {
  std::string text = fmt::format("{:.17g}", model.constant);
  if (model.stiffness != 0.0) text += fmt::format(" - ({:.17g}) * (x - ({:.17g}))", model.stiffness, model.centre);
  for (const PeriodicTorque& torque : model.cogging)
    for (const sim::HarmonicTerm& term : torque.orders) {
      const double rate = 2.0 * std::numbers::pi * term.order / torque.period;
      text += fmt::format(" + ({:.17g}) * {}({:.17g} * x) + ({:.17g}) * {}({:.17g} * x)", term.cosine, in.cos, rate,
                          term.sine, in.sin, rate);
    }
  return text;
}

std::string commented(const std::vector<std::string>& notes, std::string_view sign) {
  std::string text;
  for (const std::string& note : notes) text += fmt::format("{} {}\n", sign, note);
  return text;
}

struct Units {
  std::string_view effort, speed, travel, inertia;
};

Units units(const PortableModel& model) {
  return model.rotary() ? Units{"Nm", "rad/s", "mm", "kg m^2"} : Units{"N", "m/s", "m", "kg"};
}

/// exp, pow and sines without the C library: exp and log by halving and series, sines reduced to a quarter turn.
constexpr std::string_view kFreestandingMath = R"(
static inline double axis_exp(double a) {
  double sum = 1.0, term = 1.0, whole = 1.0;
  int k, n = 0;
  if (a < -700.0) return 0.0;
  while (a > 0.5 || a < -0.5) { a *= 0.5; ++n; }
  for (k = 1; k < 14; ++k) { term *= a / k; sum += term; }
  for (whole = sum; n > 0; --n) whole *= whole;
  return whole;
}

static inline double axis_log(double a) {
  double q, square, term, sum = 0.0;
  int k, octaves = 0;
  while (a > 1.4142135623730951) { a *= 0.5; ++octaves; }
  while (a < 0.70710678118654757) { a *= 2.0; --octaves; }
  q = (a - 1.0) / (a + 1.0);
  square = q * q;
  for (term = q, k = 1; k < 30; k += 2) { sum += term / k; term *= square; }
  return 2.0 * sum + octaves * 0.69314718055994531;
}

static inline double axis_pow(double base, double exponent) {
  return base > 0.0 ? axis_exp(exponent * axis_log(base)) : exponent > 0.0 ? 0.0 : 1.0;
}

static inline double axis_sin(double angle) {
  const double turns = angle / 6.2831853071795865;
  double a = angle - 6.2831853071795865 * (double)(long long)(turns + (turns < 0.0 ? -0.5 : 0.5)), term, sum, square;
  int k;
  if (a > 1.5707963267948966) a = 3.1415926535897932 - a;
  if (a < -1.5707963267948966) a = -3.1415926535897932 - a;
  square = a * a;
  for (term = sum = a, k = 2; k < 22; k += 2) { term *= -square / (k * (k + 1)); sum += term; }
  return sum;
}

static inline double axis_cos(double angle) { return axis_sin(angle + 1.5707963267948966); }
)";

}  // namespace

std::string identifier(std::string_view name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) != 0) text.insert(text.begin(), 'a');
  return text;
}

std::string c_header(const PortableModel& model, const std::vector<std::string>& notes) {
  const std::string name = identifier(model.name);
  const Units in = units(model);
  std::string text =
      fmt::format("/*\n{}*/\n#ifndef AXIS_{}_H\n#define AXIS_{}_H\n", commented(notes, " *"), name, name);
  text += kFreestandingMath;
  text += fmt::format("\n/* {}, seen by the motor */\nstatic const double {}_inertia = {:.17g};\n", in.inertia, name,
                      model.inertia);
  for (const auto& [what, of] : {std::pair{"friction", &side_text}, std::pair{"friction_slope", &slope_text}}) {
    const bool is_slope = std::string_view(what) != "friction";
    text += fmt::format(
        "\n/* {} of a speed in {}{} */\nstatic inline double {}_{}(double speed) {{\n  const double v = speed < 0.0 ? "
        "-speed : speed;\n",
        is_slope ? "its derivative" : in.effort, in.speed, is_slope ? "" : ", signed like the speed; 0 at rest", name,
        what);
    if (!is_slope) text += "  if (v == 0.0) return 0.0;\n";
    text += fmt::format("  if (speed >= 0.0) return {};\n  return {}({});\n}}\n", of(model, 0, kC), is_slope ? "" : "-",
                        of(model, 1, kC));
  }
  text += fmt::format(
      "\n/* {} that acts beside the motor's, at a travel in {} */\nstatic inline double {}_load(double x) {{\n  "
      "(void)x;\n  return {};\n}}\n",
      in.effort, in.travel, name, load_text(model, kC));
  return text + "\n#endif\n";
}

std::string python_module(const PortableModel& model, const std::vector<std::string>& notes) {
  const Units in = units(model);
  std::string text = commented(notes, "#");
  text += fmt::format(
      "import numpy as np\n\nINERTIA = {:.17g}  # {}\n\n\ndef friction(speed):\n    \"\"\"{} of a speed in {}, signed "
      "like it; 0 at rest.\"\"\"\n",
      model.inertia, in.inertia, in.effort, in.speed);
  text += "    speed = np.asarray(speed, float)\n    v = np.abs(speed)\n";
  text += fmt::format(
      "    forward = {}\n    backward = {}\n    return np.sign(speed) * np.where(speed >= 0, forward, backward)\n\n\n",
      side_text(model, 0, kPython), side_text(model, 1, kPython));
  text += fmt::format(
      "def friction_slope(speed):\n    \"\"\"Its derivative.\"\"\"\n    speed = np.asarray(speed, float)\n    v = "
      "np.abs(speed)\n    return np.where(speed >= 0, {}, {})\n\n\n",
      slope_text(model, 0, kPython), slope_text(model, 1, kPython));
  text += fmt::format(
      "def load(x):\n    \"\"\"{} that acts beside the motor's, at a travel in {}.\"\"\"\n    x = np.asarray(x, "
      "float)\n    return 0 * x + {}\n\n\n",
      in.effort, in.travel, load_text(model, kPython));
  return text + fmt::format(
                    "def effort(x, speed, acceleration):\n    \"\"\"{} that the motor must give for a motion.\"\"\"\n  "
                    "  return INERTIA * np.asarray(acceleration, float) + friction(speed) - load(x)\n",
                    in.effort);
}

std::string modelica_model(const PortableModel& model, const std::vector<std::string>& notes) {
  const std::string name = identifier(model.name);
  const Units in = units(model);
  return fmt::format(
      "{}model {}\n  \"Effort of a drive for a motion; units of {}, {}, {}\"\n  parameter Real inertia = {:.17g} "
      "\"{}\";\n  input Real effort \"of the motor, {}\";\n"
      "  Real x \"travel, {}\";\n  Real speed \"{}\";\n  Real v;\n  Real friction \"{}\";\n  Real load "
      "\"{}\";\nequation\n  v = abs(speed);\n"
      "  der(x) = {:.17g} * speed;\n  friction = if speed > 0 then {} else if speed < 0 then -({}) else 0;\n  load = "
      "{};\n"
      "  inertia * der(speed) = effort + load - friction;\nend {};\n",
      commented(notes, "//"), name, in.effort, in.speed, in.travel, model.inertia, in.inertia, in.effort, in.travel,
      in.speed, in.effort, in.effort, model.rotary() ? model.data.lead : 1.0, side_text(model, 0, kPlain),
      side_text(model, 1, kPlain), load_text(model, kPlain), name);
}

std::string hal_component(const PortableModel& model, const std::string& component,
                          const std::vector<std::string>& notes) {
  const double per_speed = model.rotary() ? 1.0 / model.data.lead : 1e-3, per_travel = model.rotary() ? 1.0 : 1e-3;
  return fmt::format(
      "{}component {} \"friction, inertia and position-dependent torque as a feed-forward\";\n"
      "pin in float position \"wanted position, machine units of mm\";\npin in float velocity \"wanted speed, mm/s\";\n"
      "pin in float acceleration \"wanted acceleration, mm/s^2\";\npin out float effort \"{}\";\npin out float output "
      "\"effort times scale, for the PID's bias\";\n"
      "param rw float scale = {:.17g} \"units of output for one {}\";\nparam rw float deadband = {:.6g} \"speed below "
      "which friction is faded in, mm/s\";\n"
      "function _ fp;\nlicense \"GPL\";\n;;\n#include <rtapi_math.h>\n\nFUNCTION(_) {{\n  const double speed = "
      "velocity * {:.17g}, x = position * {:.17g};\n"
      "  const double v = fabs(speed), fade = deadband > 0 && fabs(velocity) < deadband ? fabs(velocity) / deadband : "
      "1.0;\n"
      "  const double dry = speed >= 0 ? {} : -({});\n  effort = {:.17g} * acceleration * {:.17g} + fade * dry - "
      "({});\n  output = effort * scale;\n}}\n",
      commented(notes, "//"), component, units(model).effort, 1.0, units(model).effort, 0.1, per_speed, per_travel,
      side_text(model, 0, kPlain), side_text(model, 1, kPlain), model.inertia, per_speed, load_text(model, kPlain));
}

namespace {

/// halcompile writes '-' for '_' in names of pins, without a leading "hal_" and without signs at the end.
std::string hal_name(std::string_view component) {
  constexpr std::string_view kFront = "hal_";
  std::string name(component.substr(component.starts_with(kFront) ? kFront.size() : 0));
  std::ranges::replace(name, '_', '-');
  name.erase(name.find_last_not_of('-') + 1);
  return name;
}

}  // namespace

std::string hal_lines(const PortableModel& model, const std::string& component) {
  constexpr std::string_view kLetters = "xyzabcuvw";  // in the order of joints in trivkins
  const std::size_t known = model.name.size() == 1 ? kLetters.find(model.name.front()) : std::string_view::npos;
  const std::size_t joint = known == std::string_view::npos ? 0 : known;
  const double per_volt = model.data.effort_per_volt();
  return fmt::format(
      "# For joint {1}, whose loop is pid.{2}: change these names where yours differ. halcompile --install {0}.comp;\n"
      "# then, in the machine's .hal file, behind the addf of the PID (vel-cmd and acc-cmd are of the coming period):\n"
      "#   source {0}.hal\n"
      "# The PID adds its bias to its output. Friction and inertia come from here: set its FF1 to 0, and its FF2 to\n"
      "# -Dgain times the servo period in s (its D takes the command one period ahead of the error's).\n"
      "loadrt {0}\naddf {3}.0 servo-thread\n"
      "setp {3}.0.scale {4:.9g}  # units of the amplifier's command for 1 {5}\n"
      "net {2}-pos-cmd joint.{1}.motor-pos-cmd => {3}.0.position\n"
      "net {2}-vel-cmd joint.{1}.vel-cmd => {3}.0.velocity\n"
      "net {2}-acc-cmd joint.{1}.acc-cmd => {3}.0.acceleration\n"
      "net {2}-feed-forward {3}.0.output => pid.{2}.bias\n",
      component, joint, kLetters[joint], hal_name(component), per_volt > 0.0 ? 1.0 / per_volt : 1.0,
      units(model).effort);
}

}  // namespace host
