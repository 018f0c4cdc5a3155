// MJCF and URDF: a joint with one friction level and one viscous coefficient.
#include <fmt/format.h>

#include "host/interchange/export_model.hpp"
#include "host/known_by_current.hpp"

namespace host {

namespace {

std::string xml_comment(const std::vector<std::string>& notes) {
  std::string text = "<!--\n";
  for (std::string note : notes) {
    for (std::size_t at = note.find("--"); at != std::string::npos; at = note.find("--")) note.replace(at, 2, "- ");
    text += fmt::format("  {}\n", note);
  }
  return text + "-->\n";
}

/// The control value at which the converter saturates: A, or Nm or N if no motor constant is known.
std::string control_range(const sim::DataSheet& data, double gear) {
  if (is_known_by_current(data) || !(data.dac_limit_V > 0.0)) return {};
  const double most = data.dac_limit_V * data.effort_per_volt() / gear;
  return fmt::format(" ctrllimited=\"true\" ctrlrange=\"{:.17g} {:.17g}\"", -most, most);
}

/// MuJoCo reverses its dry friction within a speed of acceleration times a time constant. The default is 20 ms, the
/// minimum two steps (its manual, "Solver parameters").
std::string sharp_friction(double step_s) {
  return fmt::format(" solreffriction=\"{:.17g} 1\" solimpfriction=\"0.99 0.99 0.001\"", 2.0 * step_s);
}

}  // namespace

SymmetricFriction symmetric(const PortableModel& model) {
  return {0.5 * (model.friction[0].viscous + model.friction[1].viscous),
          0.5 * (model.friction[0].coulomb + model.friction[1].coulomb)};
}

std::string mjcf_joint(const PortableModel& model, const std::vector<std::string>& notes) {
  const SymmetricFriction friction = symmetric(model);
  const std::string name = identifier(model.name);
  // Coordinates are in rad or m. The model's values per mm are multiplied by the lead to become values per rad.
  const double lead = model.rotary() ? model.data.lead : 1.0;
  std::string spring;
  if (model.stiffness != 0.0)
    spring = fmt::format(" stiffness=\"{:.17g}\" springref=\"{:.17g}\"", model.stiffness * lead, model.centre / lead);
  const double gear = model.data.torque_constant_Nm_per_A > 0.0 ? model.data.torque_constant_Nm_per_A : 1.0;
  const double step_s = model.data.sample_period_s;
  return fmt::format(
      "{}<mujoco model=\"{}\">\n  <compiler angle=\"radian\"/>\n  <option timestep=\"{:.17g}\"/>\n  <worldbody>\n    "
      "<body name=\"{}\">\n"
      "      <joint name=\"{}\" type=\"{}\" axis=\"0 0 1\" armature=\"{:.17g}\" damping=\"{:.17g}\" "
      "frictionloss=\"{:.17g}\"{}{}/>\n"
      "      <inertial pos=\"0 0 0\" mass=\"1e-6\" diaginertia=\"1e-9 1e-9 1e-9\"/>\n    </body>\n  </worldbody>\n  "
      "<actuator>\n    <motor name=\"{}_motor\" joint=\"{}\" gear=\"{:.17g}\"{}/>\n  </actuator>\n</mujoco>\n",
      xml_comment(notes), name, step_s, name, name, model.rotary() ? "hinge" : "slide", model.inertia, friction.viscous,
      friction.level, sharp_friction(step_s), spring, name, name, gear, control_range(model.data, gear));
}

std::string urdf_joint(const PortableModel& model, const std::vector<std::string>& notes) {
  const SymmetricFriction friction = symmetric(model);
  const std::string name = identifier(model.name);
  return fmt::format(
      "{}<robot name=\"{}\">\n  <link name=\"base\"/>\n  <link name=\"{}_link\"/>\n  <joint name=\"{}\" type=\"{}\">\n "
      "   <parent link=\"base\"/>\n    <child link=\"{}_link\"/>\n    <axis xyz=\"0 0 1\"/>\n"
      "    <dynamics damping=\"{:.17g}\" friction=\"{:.17g}\"/>\n  </joint>\n</robot>\n",
      xml_comment(notes), name, name, name, model.rotary() ? "continuous" : "prismatic", name, friction.viscous,
      friction.level);
}

}  // namespace host
