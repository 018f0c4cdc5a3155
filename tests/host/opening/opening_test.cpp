// Whole logs: channels must be recognised, or missing information must be named.
#include "host/opening/opening.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "host/diagnose/log_to_verdict.hpp"
#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kShared = fs::path(AXIS_SHARED_DIR) / "data";

class Opening : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }

  static host::Opening open(const std::vector<std::string>& paths, host::OpeningOptions options = {}) {
    return host::open_logs(paths, options);
  }

  static std::map<std::string, host::OpenedChannel> channels(const host::OpenedFile& file) {
    std::map<std::string, host::OpenedChannel> result;
    for (const host::OpenedChannel& channel : file.understood.channels) result[channel.name] = channel;
    return result;
  }

  TemporaryFolder folder_;
};

/// A motion with consistent position and speed: x in mm, v in mm/s, at 1 kHz.
double x_at(int k) { return 20.0 * std::sin(0.002 * k) + 3.0 * std::sin(0.013 * k); }
double v_at(int k) { return 1e3 * (0.04 * std::cos(0.002 * k) + 0.039 * std::cos(0.013 * k)); }
double i_at(int k) { return 0.02 * v_at(k) + (v_at(k) > 0.0 ? 0.5 : -0.5); }

constexpr int kRows = 3000;

TEST_F(Opening, NamesAndUnitsAreEnough) {
  std::string text = "Zeit [ms];Istposition [mm];Drehzahl [1/min];Strom [A]\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{};{:.5f};{:.5f};{:.4f}\n", k, x_at(k), v_at(k) / 1.6 * 30.0 / std::numbers::pi, i_at(k));
  const host::Opening opening = open({write("a.csv", text)});
  EXPECT_TRUE(opening.asks().empty());
  ASSERT_EQ(opening.records().size(), 1u);
  auto found = channels(opening.files[0]);
  EXPECT_EQ(found["Istposition [mm]"].taken_as, "x_mm");
  EXPECT_EQ(found["Drehzahl [1/min]"].taken_as, "w_rad_s");
  EXPECT_EQ(found["Strom [A]"].taken_as, "i_A");
  EXPECT_NEAR(opening.files[0].understood.lead_mm_per_rad.value_or(0.0), 1.6, 0.01);
  EXPECT_DOUBLE_EQ(opening.records()[0]->record.sample_period_s, 1e-3);
}

TEST_F(Opening, ASpeedWithoutAUnitIsFoundByThePosition) {
  std::string text = "t_s,pos_mm,speed,cur_A\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f},{:.5f},{:.6f},{:.4f}\n", 1e-3 * k, x_at(k), v_at(k) * 0.06, i_at(k));
  auto found = channels(open({write("a.csv", text)}).files[0]);
  EXPECT_EQ(found["speed"].taken_as, "v_mm_s");
  EXPECT_DOUBLE_EQ(found["speed"].factor, 1e3 / 60.0);  // m/min
}

TEST_F(Opening, AUnitThatTheMotionContradictsIsAsked) {
  std::string text = "t [s],pos [mm],speed [mm/s],cur [A]\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f},{:.5f},{:.6f},{:.4f}\n", 1e-3 * k, x_at(k), v_at(k) * 0.06, i_at(k));
  const host::Opening opening = open({write("a.csv", text)});
  EXPECT_FALSE(opening.asks().empty());
  EXPECT_LT(channels(opening.files[0])["speed [mm/s]"].sure, host::kSureEnough);
}

TEST_F(Opening, WhatHasNoUnitIsAsked) {
  std::string text = "time,position,velocity,current\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f},{:.6f},{:.6f},{:.4f}\n", 1e-3 * k, x_at(k) + 0.5, v_at(k), i_at(k));
  const host::Opening opening = open({write("a.csv", text)});
  EXPECT_EQ(opening.asks().size(), 3u);
}

TEST_F(Opening, CountsByTheSetPoint) {
  std::string text = "Time(ms)\tIq(A)\tActPos(inc)\tSetPos(mm)\n";
  for (int k = 0; k < 2 * kRows; ++k)
    text += fmt::format("{}\t{:.3f}\t{:.0f}\t{:.4f}\n", k, i_at(k), x_at(k - 2) * 6553.6, x_at(k));
  auto found = channels(open({write("a.csv", text)}).files[0]);
  EXPECT_EQ(found["ActPos(inc)"].taken_as, "x_mm");
  EXPECT_NEAR(found["ActPos(inc)"].factor * 6553.6, 1.0, 1e-12);
}

TEST_F(Opening, CountsOfAnUnknownEncoderAndPercentAreMissing) {
  std::string text = "t_s,pos [inc],Torque [%]\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f},{:.0f},{:.3f}\n", 1e-3 * k, 1e3 * x_at(k), 10.0 * i_at(k));
  const host::Opening opening = open({write("a.csv", text)});
  EXPECT_TRUE(opening.records().empty());
  ASSERT_EQ(opening.files[0].understood.missing.size(), 2u);
  EXPECT_THAT(opening.files[0].understood.missing[0], HasSubstr("pos [inc]"));
  EXPECT_THAT(opening.files[0].understood.missing[1], HasSubstr("100 %"));
}

TEST_F(Opening, AnAngleThatBeginsAgainIsUnwrapped) {
  std::string text = "t [s];angle [deg];torque [Nm]\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f};{:.4f};{:.4f}\n", 1e-3 * k, std::fmod(0.7 * k, 360.0), 0.2 + 0.001 * (k % 7));
  const host::Opening opening = open({write("a.csv", text)});
  ASSERT_EQ(opening.records().size(), 1u) << opening.files[0].understood.missing.front();
  EXPECT_NEAR(opening.records()[0]->record.x.back(), 0.7 * (kRows - 1) * std::numbers::pi / 180.0, 0.05);
}

TEST_F(Opening, TwinCatChannelsWithTimesOfTheirOwn) {
  std::string text =
      "Name\tscope\nFile\tx.csv\n\n\nName\tActPos\tName\tActVelo\tName\tActCurrent\n"
      "Data-Type\tLREAL\tData-Type\tLREAL\tData-Type\tREAL\nSampleTime[ms]\t2\tSampleTime[ms]\t2\tSampleTime[ms]\t2\n"
      "Unit\tmm (Length)\tUnit\tmm/s (Velocity)\tUnit\tA (Current)\n\n";
  const auto comma = [](double value) {
    std::string digits = fmt::format("{:.5f}", value);
    digits[digits.find('.')] = ',';
    return digits;
  };
  for (int k = 0; k < kRows; k += 2)
    text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\n", k, comma(x_at(k)), k, comma(v_at(k)), k, comma(i_at(k)));
  text += "EOF\n";
  const host::Opening opening = open({write("scope.csv", text)});
  EXPECT_EQ(opening.files[0].understood.layout, "twincat-scope");
  ASSERT_EQ(opening.records().size(), 1u) << opening.files[0].understood.missing.front();
  EXPECT_DOUBLE_EQ(opening.records()[0]->record.sample_period_s, 2e-3);
  EXPECT_TRUE(opening.asks().empty());
}

TEST_F(Opening, SinumerikTrace) {
  std::string text =
      "<?xml version=\"1.0\"?><traceDataRoot><traceData><dataFrame>"
      "<dataSignal id=\"f1\" name=\"/nck/x\" description=\"Actual position [mm]\"/>"
      "<dataSignal id=\"f2\" name=\"/nck/i\" description=\"Current &lt;A&gt;\"/>";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("<rec time=\"{:.3f}\" f1=\"{:.5f}\" f2=\"{:.5f}\"/>\n", 2e-3 * k, x_at(k), i_at(k));
  const host::Opening opening = open({write("trace.xml", text + "</dataFrame></traceData></traceDataRoot>")});
  EXPECT_EQ(opening.files[0].understood.layout, "sinumerik");
  ASSERT_EQ(opening.records().size(), 1u) << opening.files[0].understood.missing.front();
}

TEST_F(Opening, HalsamplerIsNamedByItsHalFile) {
  std::string text;
  for (int k = 0; k < kRows; ++k) text += fmt::format("{:f} {:f} {:f} \n", x_at(k + 1), x_at(k), i_at(k));
  host::OpeningOptions options;
  options.hal_path =
      write("loop.hal",
            "loadrt threads name1=servo period1=2000000\naddf sampler.0 servo\n"
            "net cmd siggen.0.sine pid.0.command sampler.0.pin.0\nnet fb plant.0.x pid.0.feedback sampler.0.pin.1\n"
            "net out pid.0.output plant.0.u sampler.0.pin.2\n");
  const host::Opening opening = open({write("pid.txt", text)}, options);
  auto found = channels(opening.files[0]);
  EXPECT_EQ(found["cmd"].taken_as, "x_ref_mm");
  EXPECT_EQ(found["fb"].taken_as, "x_mm");
  EXPECT_EQ(found["out"].taken_as, "u_V");
  EXPECT_DOUBLE_EQ(opening.files[0].understood.rate_Hz, 500.0);
}

TEST_F(Opening, AScaleOnTheTableIsTheSecondPosition) {
  std::string text = "time [s],motor position [mm],glass scale [um],current [A]\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f},{:.5f},{:.2f},{:.4f}\n", 1e-3 * k, x_at(k),
                        120.0 - 1e3 * (x_at(k) - 0.004 * (v_at(k) > 0.0 ? 1.0 : -1.0)), i_at(k));
  const host::Opening opening = open({write("scale.csv", text)});
  EXPECT_TRUE(opening.asks().empty());
  ASSERT_EQ(opening.records().size(), 1u);
  const host::Record& record = opening.records()[0]->record;
  EXPECT_EQ(channels(opening.files[0])["glass scale [um]"].taken_as, "x2_mm");
  EXPECT_DOUBLE_EQ(channels(opening.files[0])["glass scale [um]"].factor, -1e-3)
      << "the scale counts in the other direction";
  ASSERT_TRUE(record.has_table_position());
  EXPECT_NEAR(record.x2[1000] - record.x2[0], record.x[1000] - record.x[0], 0.02);
}

TEST_F(Opening, ASecondPositionThatIsNoTableIsLeftOut) {
  std::string text = "time [s],motor position [mm],link position [mm],current [A]\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:.3f},{:.5f},{:.5f},{:.4f}\n", 1e-3 * k, x_at(k), 0.01 * x_at(k), i_at(k));
  const host::Opening opening = open({write("geared.csv", text)});
  ASSERT_EQ(opening.records().size(), 1u);
  EXPECT_FALSE(opening.records()[0]->record.has_table_position());
  EXPECT_THAT(channels(opening.files[0])["link position [mm]"].why, HasSubstr("--map x2_mm="));
}

/// Signals of two joints as in configurations of LinuxCNC. An output belongs to the axis with its letter.
TEST_F(Opening, HalsamplerOfTwoJointsMakesARecordOfEach) {
  std::string text, hal = "loadrt threads name1=servo period1=1000000\naddf sampler.0 servo\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{:f} {:f} {:f} {:f} {:f} {:f} {:f} \n", x_at(k + 1), x_at(k), i_at(k), 1e-3 * i_at(k),
                        -2.0 * x_at(k + 1), -2.0 * x_at(k), -i_at(k));
  int pin = 0;
  for (const auto& [axis, joint] : {std::pair{'x', 0}, std::pair{'y', 1}}) {
    hal += fmt::format("net {0}-pos-cmd joint.{1}.motor-pos-cmd => pid.{0}.command sampler.0.pin.{2}\n", axis, joint,
                       pin++);
    hal +=
        fmt::format("net {0}-pos-fb encoder.{1}.position => pid.{0}.feedback sampler.0.pin.{2}\n", axis, joint, pin++);
    hal += fmt::format("net {0}-output pid.{0}.output => sampler.0.pin.{1}\n", axis, pin++);
    if (joint == 0) hal += fmt::format("net x-f-error joint.0.f-error => sampler.0.pin.{}\n", pin++);
  }
  host::OpeningOptions options;
  options.hal_path = write("loop.hal", hal);
  const host::Opening opening = open({write("log.txt", text)}, options);
  auto found = channels(opening.files[0]);
  for (const char* axis : {"x", "y"}) {
    EXPECT_EQ(found[fmt::format("{}-pos-fb", axis)].taken_as, "x_mm");
    EXPECT_EQ(found[fmt::format("{}-output", axis)].taken_as, "u_V");
  }
  EXPECT_EQ(found["x-f-error"].taken_as, "");
  ASSERT_EQ(opening.records().size(), 2u);
  EXPECT_EQ(opening.records()[1]->axis, "y");
  EXPECT_NEAR(opening.records()[1]->record.x[5], -2.0 * x_at(5), 1e-6);
}

TEST_F(Opening, TheMappingFileNeedsNoQuestion) {
  std::string text = "time,position,current\n";
  for (int k = 0; k < kRows; ++k) text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 1e-3 * k, x_at(k), i_at(k));
  const std::string log = write("a.csv", text);
  const host::Opening asked = open({log});
  EXPECT_FALSE(asked.asks().empty());
  host::OpeningOptions options;
  options.mapping_path = write("mapping.toml", host::format_mapping(asked));
  const host::Opening again = open({log}, options);
  EXPECT_TRUE(again.asks().empty());
  ASSERT_EQ(again.records().size(), 1u);
  EXPECT_EQ(again.records()[0]->record.x, asked.records()[0]->record.x);
}

TEST_F(Opening, WithoutTimesThePeriodIsMissing) {
  std::string text = ",X1_ActualPosition,X1_CurrentFeedback\n";
  for (int k = 0; k < 400; ++k) text += fmt::format("{},{:.3f},{:.3f}\n", k, x_at(k), i_at(k));
  const host::Opening opening = open({write("a.csv", text)});
  EXPECT_TRUE(opening.records().empty());
  EXPECT_THAT(opening.files[0].understood.missing.front(), HasSubstr("--period"));
}

/// Six simulated machines, each with only its four logs. The encoder's step is exact.
TEST_F(Opening, ControllerLogs) {
  if (!fs::exists(kShared / "controller-logs")) GTEST_SKIP() << kShared << " is not there";
  for (const char* name : {"worn_screw", "gap_only", "honest_clean", "warm_gear", "vertical_z", "crank"}) {
    std::vector<std::string> logs;
    for (const char* log : {"steps", "jog", "sweep", "valid"})
      logs.push_back(kShared / "controller-logs" / name / fmt::format("{}.csv", log));
    const host::Opening opening = open(logs);
    EXPECT_EQ(opening.records().size(), 4u) << name;
    const bool german = std::string_view(name) == "worn_screw" || std::string_view(name) == "gap_only";
    for (const host::OpenedFile& file : opening.files) {
      auto found = channels(file);
      EXPECT_NEAR(found[german ? "Pos [Ink]" : "ActPos(inc)"].factor, german ? 1.25e-4 : 1.52587890625e-4, 1e-12)
          << file.path;
      EXPECT_EQ(found[german ? "Iist [A]" : "Iq(A)"].taken_as, "i_A") << file.path;
    }
    std::vector<host::Record> records;
    for (const host::OpenedRecord* opened : opening.records()) records.push_back(opened->record);
    const sim::DataSheet sheet = host::sheet_of_constant(records, 0.6, 0.0).data;
    EXPECT_NEAR(sheet.encoder_resolution, german ? 1.25e-4 : 1.52587890625e-4, 1e-9) << name;
    EXPECT_TRUE(host::is_known_by_current(sheet)) << name;
  }
}

/// No public log contains all properties of a drive. Each must open and name the missing information.
TEST_F(Opening, ForeignLogsSayWhatIsMissing) {
  if (!fs::exists(kShared / "foreign-logs")) GTEST_SKIP() << kShared << " is not there";
  std::size_t seen = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kShared / "foreign-logs")) {
    const std::string extension = entry.path().extension();
    if (!entry.is_regular_file() || (extension != ".csv" && extension != ".txt")) continue;
    const host::Opening opening = open({entry.path()});
    EXPECT_TRUE(opening.records().empty()) << entry.path();
    EXPECT_FALSE(opening.files[0].understood.missing.empty()) << entry.path();
    EXPECT_GT(opening.files[0].understood.rate_Hz, 0.0) << entry.path();
    ++seen;
  }
  EXPECT_EQ(seen, 9u);
}

}  // namespace
