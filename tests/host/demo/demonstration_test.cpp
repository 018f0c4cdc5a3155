// The demonstration's results against values copied here from the paper and from the independent plant's truth.
#include "host/demo/demonstration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "host/demo/emps_benchmark.hpp"
#include "host/demo/shipped_drive.hpp"
#include "host/exit_codes.hpp"

namespace {

using testing::HasSubstr;

const std::string kCase = std::string(AXIS_TEST_DATA) + "/drive-cases/none/case-00";

class DemonstrationRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shown = new host::Demonstration(host::demonstrate({.drive_case = kCase, .emps_folder = {}}));
  }
  static void TearDownTestSuite() { delete shown; }

  static double found(const std::string& what) {
    const auto figure = std::ranges::find(shown->figures, what, &host::DemoFigure::what);
    if (figure == shown->figures.end()) {
      ADD_FAILURE() << "no figure " << what;
      return 0.0;
    }
    return figure->found;
  }

  static inline host::Demonstration* shown = nullptr;
};

TEST_F(DemonstrationRun, ShippedDriveComesOutAsTheIndependentPlantWasMade) {
  // base of truth.json, typed again
  EXPECT_NEAR(found("inertia J, kg m²"), 0.0099187, 0.001 * 0.0099187);
  EXPECT_NEAR(found("viscous B, Nm s/rad"), 0.03886, 0.01 * 0.03886);
  EXPECT_NEAR(found("Coulomb forward, Nm"), 1.89588, 0.01 * 1.89588);
  EXPECT_NEAR(found("Coulomb backward, Nm"), -1.57032, 0.01 * 1.57032);
}

TEST_F(DemonstrationRun, PaperAxesComeOutAsTable1) {
  struct Axis {
    std::string name;
    double J, B, forward, backward, curve_tolerance_Nm;
  };
  for (const Axis& axis :
       {Axis{"x", 7.65e-3, 0.0321, 2.205, -1.656, 0.015}, Axis{"y", 9.79e-3, 0.0287, 3.058, -2.739, 0.03}}) {
    SCOPED_TRACE(axis.name);
    EXPECT_NEAR(found(axis.name + " inertia J, kg m²"), axis.J, 0.02 * axis.J);
    EXPECT_NEAR(found(axis.name + " viscous B from steps, Nm s/rad"), axis.B, 0.2 * axis.B);
    EXPECT_NEAR(found(axis.name + " Coulomb forward, Nm"), axis.forward, 0.12 * axis.forward);
    EXPECT_NEAR(found(axis.name + " Coulomb backward, Nm"), axis.backward, -0.12 * axis.backward);
    EXPECT_LE(found(axis.name + " friction curve, worst error, Nm"), axis.curve_tolerance_Nm);
    EXPECT_NEAR(found(axis.name + " viscous B' from jogs, Nm s/rad"), axis.B, 0.02 * axis.B);
    EXPECT_NEAR(found(axis.name + " tachometer gain, made 1 % wrong"), 1.01, 0.002);
    EXPECT_NEAR(found(axis.name + " B' with that tachometer, Nm s/rad"), axis.B, 0.03 * axis.B);
  }
}

TEST_F(DemonstrationRun, EveryFigureAgreesAndTheReportShowsThem) {
  for (const host::DemoFigure& figure : shown->figures)
    EXPECT_TRUE(figure.agrees()) << figure.what << ' ' << figure.found;
  EXPECT_TRUE(shown->agrees());
  const std::string html = shown->report.html();
  for (const char* text : {"as Fig. 8", "as Fig. 9", "as Fig. 10", "Step of 100", "figures agree"})
    EXPECT_THAT(html, HasSubstr(text));
}

TEST(DemoFigures, OneThatIsOffIsSaid) {
  host::Demonstration shown{host::Report("t"), {host::within_fraction("J", 1.03, 1.0, 0.02)}};
  EXPECT_FALSE(shown.agrees());
  EXPECT_EQ(host::figures_table(shown.figures).rows[0][3], "DIFFERS");
  EXPECT_TRUE(host::within_fraction("T", -1.01, -1.0, 0.02).agrees());
  EXPECT_FALSE(host::at_most("error", 2.1, 2.0).agrees());
  EXPECT_FALSE(host::at_most("error", std::nan(""), 2.0).agrees());
}

TEST(ShippedDrive, MissingFolderIsNamed) {
  host::Report report("t");
  try {
    host::show_shipped_drive("/nowhere/case", report);
    FAIL() << "a missing folder was accepted";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("/nowhere/case"));
  }
}

TEST(EmpsBenchmark, AgreesWithThePublishedIdentification) {
  const std::string folder = std::string(AXIS_SHARED_DIR) + "/data/emps";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  host::Report report("t");
  const auto figures = host::show_emps(folder, report).figures;
  ASSERT_EQ(figures.size(), 6u);
  const double published[] = {95.1, 203.3, 20.4, -3.17, 4.10, 5.95};
  const double tolerance[] = {0.1, 0.6, 0.06, 0.03, 0.02, 0.05};
  for (std::size_t k = 0; k < figures.size(); ++k)
    EXPECT_NEAR(figures[k].found, published[k], tolerance[k]) << figures[k].what;
}

}  // namespace
