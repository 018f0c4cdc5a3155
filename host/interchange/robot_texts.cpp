// MJCF and URDF: a joint with one level and one viscous coefficient.
#include <fmt/format.h>

#include "host/interchange/export_model.hpp"

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

}  // namespace

SymmetricFriction symmetric(const PortableModel& model) {
  return {0.5 * (model.friction[0].viscous + model.friction[1].viscous),
          0.5 * (model.friction[0].coulomb + model.friction[1].coulomb)};
}

std::string mjcf_joint(const PortableModel& model, const std::vector<std::string>& notes) {
  const SymmetricFriction friction = symmetric(model);
  const std::string name = identifier(model.name);
  // A coordinate of rad or m; what the model says per mm is per rad times the lead.
  const double lead = model.rotary() ? model.data.lead : 1.0;
  std::string spring;
  if (model.stiffness != 0.0)
    spring = fmt::format(" stiffness=\"{:.17g}\" springref=\"{:.17g}\"", model.stiffness * lead, model.centre / lead);
  return fmt::format(
      "{}<mujoco model=\"{}\">\n  <worldbody>\n    <body name=\"{}\">\n      <joint name=\"{}\" type=\"{}\" axis=\"0 0 "
      "1\" armature=\"{:.17g}\" damping=\"{:.17g}\" frictionloss=\"{:.17g}\"{}/>\n"
      "      <inertial pos=\"0 0 0\" mass=\"1e-6\" diaginertia=\"1e-9 1e-9 1e-9\"/>\n    </body>\n  </worldbody>\n  "
      "<actuator>\n    <motor name=\"{}_motor\" joint=\"{}\" gear=\"{:.17g}\"/>\n  </actuator>\n</mujoco>\n",
      xml_comment(notes), name, name, name, model.rotary() ? "hinge" : "slide", model.inertia, friction.viscous,
      friction.level, spring, name, name,
      model.data.torque_constant_Nm_per_A > 0.0 ? model.data.torque_constant_Nm_per_A : 1.0);
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
