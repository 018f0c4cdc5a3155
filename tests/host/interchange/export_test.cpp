// Exported models compute the same values in other programs as here.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "host/interchange/export_model.hpp"
#include "host/model/model_file.hpp"
#include "sim/friction.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/run_program.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;

/// All effects that formulas can express, and two effects that they cannot.
constexpr const char* kModel = R"(format = "axis-model/1"
name = "x 1"
[drive]
kind = "rotary"
amplifier_gain_A_per_V = 1.2
torque_constant_Nm_per_A = 0.6
lead_mm_per_rad = 1.5915494
sample_period_s = 0.001
[[effect]]
kind = "inertia"
J_kg_m2 = 0.0033
[[effect]]
kind = "viscous"
B_Nm_s_per_rad = 0.007
[[effect]]
kind = "coulomb"
positive_Nm = 0.45
negative_Nm = -0.40
[[effect]]
kind = "stribeck"
static_positive_Nm = 0.7
static_negative_Nm = -0.6
omega1_positive_rad_s = 2.0
omega1_negative_rad_s = -3.0
omega2_positive_rad_s = 2.5
omega2_negative_rad_s = -1.5
[[effect]]
kind = "nonlinear_viscous"
coefficient_Nm = 0.05
exponent = 1.5
[[effect]]
kind = "constant_torque"
torque_Nm = -0.2
[[effect]]
kind = "cogging"
period_mm = 5.0
cosine_Nm = 0.03
sine_Nm = -0.02
[[effect]]
kind = "current_loop_lag"
bandwidth_Hz = 300.0
)";

constexpr double kSpeeds[] = {-60.0, -7.0, -1.0, -0.05, 0.0, 0.003, 0.4, 2.0, 11.0, 80.0};
constexpr double kTravels[] = {-13.7, 0.0, 1.1, 250.3};

class ExportModel : public testing::Test {
 protected:
  host::Export to(host::ExportTarget target, const std::string& name) const {
    host::Export exported = host::export_model(model_, target, folder_.path(name), nullptr);
    for (const host::ExportedFile& file : exported.files)
      folder_.write(std::filesystem::path(file.path).filename().string(), file.text);
    return exported;
  }

  void expect_values(const std::string& printed) const {
    std::istringstream text(printed);
    double value = 0.0;
    for (const double speed : kSpeeds) {
      ASSERT_TRUE(text >> value) << printed;
      EXPECT_NEAR(value, formulas_.friction_at(speed), 1e-9) << "friction at " << speed;
    }
    for (const double speed : kSpeeds) {
      ASSERT_TRUE(text >> value) << printed;
      EXPECT_NEAR(value, formulas_.slope_at(speed), 1e-9) << "slope at " << speed;
    }
    for (const double x : kTravels) {
      ASSERT_TRUE(text >> value) << printed;
      EXPECT_NEAR(value, formulas_.load_at(x), 1e-9) << "load at " << x;
    }
  }

  sim::DriveDescription model_ = host::parse_model(kModel, "x.toml");
  host::PortableModel formulas_ = host::portable(model_);
  TemporaryFolder folder_;
};

TEST_F(ExportModel, FormulasAreThoseOfTheDrive) {
  const sim::Drive drive(model_);
  for (const double speed : kSpeeds) {
    if (speed == 0.0) continue;
    const std::size_t side = speed > 0.0 ? 0 : 1;
    const double v = std::abs(speed);
    const sim::FrictionPoint dry = drive.curves()[side].dry(v);
    const sim::FrictionPoint bend = drive.sliding_friction.front()(static_cast<int>(side), v);
    EXPECT_NEAR(std::abs(formulas_.friction_at(speed)), dry.effort + drive.curves()[side].viscous * v + bend.effort,
                1e-9);
    const double step = 1e-5 * v;
    EXPECT_NEAR(formulas_.slope_at(speed),
                (formulas_.friction_at(speed + step) - formulas_.friction_at(speed - step)) / (2.0 * step), 1e-6);
  }
  for (const double x : kTravels) {
    double load = 0.0;
    for (const auto& part : drive.load_effort) load += part(0.0, x);
    EXPECT_NEAR(formulas_.load_at(x), load, 1e-9);
  }
}

TEST_F(ExportModel, CHeaderCompilesFreestandingAndAgrees) {
  to(host::ExportTarget::c, "x.h");
  std::string source = "#include \"x.h\"\ndouble axis_values[24];\nvoid fill(void) {\n  int k = 0;\n";
  for (const double speed : kSpeeds) source += fmt::format("  axis_values[k++] = x_1_friction({:.17g});\n", speed);
  for (const double speed : kSpeeds)
    source += fmt::format("  axis_values[k++] = x_1_friction_slope({:.17g});\n", speed);
  for (const double x : kTravels) source += fmt::format("  axis_values[k++] = x_1_load({:.17g});\n", x);
  folder_.write("use.c", source + "  (void)x_1_inertia;\n}\n");
  folder_.write(
      "print.c",
      "#include <stdio.h>\nextern double axis_values[24];\nvoid fill(void);\n"
      "int main(void) { fill(); for (int k = 0; k < 24; ++k) printf(\"%.17g\\n\", axis_values[k]); return 0; }\n");
  const std::string in = fmt::format("cd {} && ", folder_.path(""));
  const ProgramRun compiled = run_program(
      in +
      "(gcc -ffreestanding -std=c99 -Wall -Wextra -Werror -c use.c -o use.o && gcc -std=c99 print.c use.o -o values)");
  ASSERT_EQ(compiled.exit_code, 0) << compiled.output;
  expect_values(run_program(in + "./values").output);
}

TEST_F(ExportModel, PythonModuleAgrees) {
  to(host::ExportTarget::python, "x_model.py");
  std::string script = "import x_model as m\n";
  for (const char* name : {"friction", "friction_slope"})
    script += fmt::format(
        "for s in [-60.0, -7.0, -1.0, -0.05, 0.0, 0.003, 0.4, 2.0, 11.0, 80.0]: print(repr(float(m.{}(s))))\n", name);
  script += "for x in [-13.7, 0.0, 1.1, 250.3]: print(repr(float(m.load(x))))\n";
  folder_.write("use.py", script);
  expect_values(
      run_program(fmt::format("cd {} && /usr/bin/python3 use.py", folder_.path(""))).output);  // Debian's has NumPy
}

TEST_F(ExportModel, XmlReadsBack) {
  to(host::ExportTarget::mjcf, "x.xml");
  to(host::ExportTarget::urdf, "x.urdf");
  folder_.write("use.py",
                "import xml.etree.ElementTree as E\n"
                "j = E.parse('x.xml').getroot().find('.//joint')\nprint(j.get('armature'), j.get('damping'), "
                "j.get('frictionloss'))\n"
                "d = E.parse('x.urdf').getroot().find('.//dynamics')\nprint(d.get('damping'), d.get('friction'))\n");
  std::istringstream text(run_program(fmt::format("cd {} && python3 use.py", folder_.path(""))).output);
  for (const double expected : {0.0033, 0.007, 0.425, 0.007, 0.425}) {
    double value = 0.0;
    ASSERT_TRUE(text >> value) << text.str();
    EXPECT_NEAR(value, expected, 1e-12);
  }
}

/// tests/linuxcnc checks in LinuxCNC the output of the component, and that its name is the one in its .hal file.
TEST_F(ExportModel, HalLinesNameThePinsAsHalcompileDoes) {
  const host::Export exported = to(host::ExportTarget::linuxcnc, "hal_x_friction_.comp");
  EXPECT_THAT(exported.files[0].text, HasSubstr("component hal_x_friction_ "));
  const std::string& hal = exported.files[1].text;
  EXPECT_THAT(hal, HasSubstr("\nloadrt hal_x_friction_\naddf x-friction.0 servo-thread\n"));
  EXPECT_THAT(hal, HasSubstr("\nsetp x-friction.0.scale 1.38888889 "));  // V for 1 Nm: 1 / (1.2 A/V 0.6 Nm/A)
  EXPECT_THAT(hal, HasSubstr("\nnet x-pos-cmd joint.0.motor-pos-cmd => x-friction.0.position\n"));
  model_.name = "z";
  EXPECT_THAT(to(host::ExportTarget::linuxcnc, "z.comp").files[1].text,
              HasSubstr("\nnet z-vel-cmd joint.2.vel-cmd => z.0.velocity\n"));
}

TEST_F(ExportModel, SaysUnderWhatNameHalcompileTakesAComponent) {
  for (const char* name : {"x-friction.comp", "x_friction.txt"})
    EXPECT_THAT(to(host::ExportTarget::linuxcnc, name).files[0].text, HasSubstr("rename this file to x_friction.comp"))
        << name;
  EXPECT_THAT(to(host::ExportTarget::linuxcnc, "x_friction.comp").files[0].text, Not(HasSubstr("rename this file")));
}

TEST_F(ExportModel, WhatIsLeftOutIsNamed) {
  const auto kinds = [&](host::ExportTarget target, const char* name) {
    std::set<std::string> result;
    for (const host::NotExpressed& one : to(target, name).not_expressed) result.insert(one.kind);
    return result;
  };
  EXPECT_EQ(kinds(host::ExportTarget::c, "x.h"), (std::set<std::string>{"current_loop_lag"}));
  EXPECT_EQ(kinds(host::ExportTarget::mjcf, "x.xml"),
            (std::set<std::string>{"current_loop_lag", "cogging", "constant_torque", "coulomb_asymmetry",
                                   "nonlinear_viscous", "stribeck"}));
  EXPECT_TRUE(kinds(host::ExportTarget::urdf, "x.urdf").contains("inertia"));
}

/// A motion whose torque is known. The share of the cogging in it must be that in the export.
TEST_F(ExportModel, SharesAreThoseOfTheRecord) {
  sim::DriveDescription model = model_;
  std::erase_if(model.effects, [](const sim::EffectEntry& e) { return e.kind == "current_loop_lag"; });
  host::Record record;
  record.kind = sim::DriveKind::rotary;
  record.sample_period_s = 1e-3;
  double cogging = 0.0, all = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const double t = 1e-3 * k, w = 2.0 * std::numbers::pi * 0.7, radius = 12.0;
    const double angle = radius * std::sin(w * t), speed = radius * w * std::cos(w * t), acceleration = -w * w * angle;
    const double x = 1.5915494 * angle;
    const double effort = 0.0033 * acceleration + formulas_.friction_at(speed) - formulas_.load_at(x);
    const double turn = 2.0 * std::numbers::pi * x / 5.0, part = 0.03 * std::cos(turn) - 0.02 * std::sin(turn);
    cogging += part * part;
    all += effort * effort;
    record.t_s.push_back(t);
    record.x.push_back(x);
    record.i_A.push_back(effort / 0.6);
  }
  const host::Export exported = host::export_model(model, host::ExportTarget::mjcf, folder_.path("x.xml"), &record);
  for (const host::NotExpressed& one : exported.not_expressed)
    if (one.kind == "cogging") {
      ASSERT_TRUE(one.share.has_value());
      EXPECT_NEAR(*one.share / (cogging / all), 1.0, 0.1);
    }
}

}  // namespace
