// Records from MATLAB files and tables, with even and uneven sampling.
#include "host/import/import_record.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <cmath>
#include <cstdint>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"
#include "host/record/resample.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

host::Record import(const host::Log& log, std::string_view map, std::optional<double> resample_s = {}) {
  host::ImportOptions options;
  if (!map.empty()) options.mappings = host::parse_mappings(map);
  options.resample_period_s = resample_s;
  return host::import_record(log, options);
}

std::string message_of(const host::Log& log, std::string_view map, std::optional<double> resample_s = {}) {
  try {
    import(log, map, resample_s);
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr(log.path));
    return failure.what();
  }
  return "no failure";
}

/// Writes variables to a .mat file with the library that also reads them.
class MatFile {
 public:
  MatFile(const std::string& path, mat_ft version) : file_(Mat_CreateVer(path.c_str(), nullptr, version)) {}
  MatFile(const MatFile&) = delete;
  MatFile& operator=(const MatFile&) = delete;
  ~MatFile() { Mat_Close(file_); }

  template <typename T>
  void add(const char* name, matio_classes kind, matio_types type, std::vector<T> values, std::size_t columns = 1) {
    matvar_t* variable = create(name, kind, type, values, columns);
    Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
  }

  void add_struct(const char* name, const char* field, std::vector<double> values) {
    std::size_t dims[2] = {1, 1};
    const char* fields[] = {field};
    matvar_t* variable = Mat_VarCreateStruct(name, 2, dims, fields, 1);
    Mat_VarSetStructFieldByName(variable, field, 0, create(field, MAT_C_DOUBLE, MAT_T_DOUBLE, values, 1));
    Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
  }

 private:
  template <typename T>
  static matvar_t* create(const char* name, matio_classes kind, matio_types type, std::vector<T>& values,
                          std::size_t columns) {
    std::size_t dims[2] = {values.size() / columns, columns};
    return Mat_VarCreate(name, kind, type, 2, dims, values.data(), 0);
  }
  mat_t* file_;
};

constexpr int kMatRows = 200;

std::vector<double> series(double (*f)(double)) {
  std::vector<double> values;
  for (int k = 0; k < kMatRows; ++k) values.push_back(f(0.001 * k));
  return values;
}

class ImportMat : public testing::TestWithParam<mat_ft> {};

TEST_P(ImportMat, DoublesIntegersMatricesAndStructs) {
  const TemporaryFolder folder;
  const std::string path = folder.path("run.mat");
  {
    MatFile file(path, GetParam());
    file.add("t", MAT_C_DOUBLE, MAT_T_DOUBLE, series([](double t) { return t; }));
    std::vector<std::uint8_t> counts;
    std::vector<std::int16_t> command;
    std::vector<double> matrix = series([](double t) { return 5.0 + t; });
    const std::vector<double> speed = series([](double t) { return 20.0 * std::cos(20.0 * t); });
    matrix.insert(matrix.end(), speed.begin(), speed.end());
    for (int k = 0; k < kMatRows; ++k) {
      counts.push_back(static_cast<std::uint8_t>(k < 100 ? 2 * k : 2 * (199 - k)));
      command.push_back(static_cast<std::int16_t>(k % 50 * 600 - 15000));
    }
    file.add("counts", MAT_C_UINT8, MAT_T_UINT8, counts);
    file.add("dac", MAT_C_INT16, MAT_T_INT16, command);
    file.add("both", MAT_C_DOUBLE, MAT_T_DOUBLE, matrix, 2);
    file.add_struct("rig", "temperature", series([](double t) { return 20.0 + t; }));
  }
  const host::Log log = host::read_log(path);
  const host::Record record =
      import(log, "t_s=t,u_V=dac/3276.8,x_mm=counts*0.5-100,w_rad_s=both(:,2),temp_C=rig.temperature,load_V=both(1)");
  ASSERT_EQ(record.size(), static_cast<std::size_t>(kMatRows));
  EXPECT_DOUBLE_EQ(record.sample_period_s, 0.001);
  EXPECT_DOUBLE_EQ(record.u_V[0], -15000.0 / 3276.8);
  EXPECT_DOUBLE_EQ(record.x[0], -100.0);  // negative, so no value wraps as an unsigned byte would
  EXPECT_DOUBLE_EQ(record.x[99], -1.0);
  EXPECT_DOUBLE_EQ(record.x[110], -11.0);
  EXPECT_DOUBLE_EQ(record.w[50], 20.0 * std::cos(1.0));
  EXPECT_DOUBLE_EQ(record.temp_C[100], 20.1);
  EXPECT_EQ(record.extra.at(0).name, "load_V");
  EXPECT_EQ(record.header.at("imported_from"), "run.mat");
  host::write_record(record, folder.path("record.csv"));
  EXPECT_EQ(host::read_record(folder.path("record.csv")).x, record.x);
}

TEST_P(ImportMat, UnknownAndUnusableVariablesAreNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.path("run.mat");
  {
    MatFile file(path, GetParam());
    file.add("t", MAT_C_DOUBLE, MAT_T_DOUBLE, series([](double t) { return t; }));
    file.add("vir", MAT_C_SINGLE, MAT_T_SINGLE, std::vector<float>(kMatRows, 1.5F));
    file.add("short", MAT_C_DOUBLE, MAT_T_DOUBLE, std::vector<double>(7, 1.0));
    file.add("note", MAT_C_CHAR, MAT_T_UINT8, std::vector<char>{'h', 'i'});
  }
  const host::Log log = host::read_log(path);
  EXPECT_THAT(message_of(log, "t_s=t,u_V=vri,x_mm=t"),
              AllOf(HasSubstr("'vri'"), HasSubstr("did you mean vir?"), HasSubstr("vir (single, 200 x 1)")));
  EXPECT_THAT(message_of(log, "t_s=t,u_V=vir,x_mm=short"),
              AllOf(HasSubstr("lengths differ"), HasSubstr("short has 7 values"), HasSubstr("t has 200 time stamps")));
  EXPECT_THAT(message_of(log, "t_s=t,u_V=note,x_mm=short"), AllOf(HasSubstr("'note'"), HasSubstr("no real numbers")));
  EXPECT_THAT(message_of(log, "t_s=t,u_v=vir,x_mm=short"),
              AllOf(HasSubstr("missing column: u_V"), HasSubstr("did you mean u_V?")));
  EXPECT_THAT(message_of(log, "t_s=t,u_V=vir,x_mm=t"), HasSubstr("duplicated channel"));
}

INSTANTIATE_TEST_SUITE_P(Versions, ImportMat, testing::Values(MAT_FT_MAT5, MAT_FT_MAT73),
                         [](const auto& version) { return version.param == MAT_FT_MAT5 ? "v5" : "v73"; });

TEST(ImportLog, NotAMatlabFile) {
  const TemporaryFolder folder;
  try {
    host::read_log(folder.write("broken.mat", "MATLAB 5.0 MAT-file, cut off"));
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("broken.mat"));
  }
}

/// A table of time, command and position. `stamp` gives the time of row k.
template <typename Stamp>
std::string table(std::string_view heading, std::string_view separator, Stamp stamp) {
  std::string text(heading);
  for (int k = 0; k < kMatRows; ++k)
    text += fmt::format("{0:.6f}{3}{1:.6f}{3}{2:.6f}\n", stamp(k), std::sin(0.1 * k), 3.0 * stamp(k), separator);
  return text;
}

double even(int k) { return 0.001 * k; }

TEST(ImportTable, SeparatorsAndHeadingsAreFound) {
  const std::pair<const char*, const char*> tables[] = {{"time,cmd,pos\n", ","},
                                                        {"# scope: A\n% more\ntime;cmd;pos\n", ";"},
                                                        {"time\tcmd\tpos\n", "\t"},
                                                        {"  time cmd   pos\n", "  "},
                                                        {"\"time\",\"cmd\",pos\r\n", ","}};
  for (const auto& [heading, separator] : tables) {
    const host::Log log = host::parse_table(table(heading, separator, even), "log.txt");
    const host::Record record = import(log, "t_s=time,u_V=cmd*2,x_mm=pos");
    ASSERT_EQ(record.size(), static_cast<std::size_t>(kMatRows)) << heading;
    EXPECT_NEAR(record.u_V[10], 2.0 * std::sin(1.0), 1e-6);
    EXPECT_NEAR(record.x[10], 0.03, 1e-9);
  }
}

TEST(ImportTable, ColumnsByNumberWithoutHeadings) {
  const host::Log log = host::parse_table(table("", ",", even), "log.txt");
  const host::Record record = import(log, "t_s=1,u_V=#2,x_mm=3*10");
  EXPECT_NEAR(record.x[10], 0.3, 1e-9);
  const host::Record counted = import(log, "t_s=row*0.001,u_V=#2,x_mm=3*10");
  EXPECT_EQ(counted.t_s[100], 0.1);
  EXPECT_THAT(message_of(log, "t_s=1,u_V=2,x_mm=4"), AllOf(HasSubstr("'4'"), HasSubstr("#3 (200 numbers)")));
}

TEST(ImportTable, HeadingsWithBlanksInQuotes) {
  const host::Log log = host::parse_table(table("Time (s);Command, V;Position [mm]\n", ";", even), "log.txt");
  EXPECT_EQ(import(log, "t_s='Time (s)',u_V=\"Command, V\",x_mm='Position [mm]'").size(),
            static_cast<std::size_t>(kMatRows));
}

TEST(ImportTable, BadFieldsAreNamedWhereTheyMatter) {
  const host::Log log = host::parse_table("a,b\n1,x\n2,y\n", "log.txt");
  EXPECT_THAT(message_of(log, "t_s=a,u_V=b,x_mm=a"),
              AllOf(HasSubstr("line 2, column 2 (b)"), HasSubstr("'x' is not a number")));
  try {
    host::parse_table("a,b,c\n1,2,3\n1,2\n", "log.txt");
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_THAT(failure.what(), AllOf(HasSubstr("line 3"), HasSubstr("2 fields where there are 3 columns")));
  }
}

double jittered(int k) { return 0.001 * k + (k % 3 == 2 ? 0.0002 : 0.0); }

// Catches a step with the wrong sign, and a range that is added once too few.
TEST(ImportUnwrap, AnAngleGoesOnBeyondItsTurn) {
  constexpr double kTurn = 2.0 * M_PI;
  const auto angle = [](int k) { return 9.0 * std::sin(0.01 * k); };
  std::string text = "t_s,u_V,x_mm\n";
  for (int k = 0; k < 1000; ++k)
    fmt::format_to(std::back_inserter(text), "{:.3f},{:.4f},{:.6f}\n", 0.001 * k, std::cos(0.02 * k),
                   std::remainder(angle(k), kTurn));
  host::ImportOptions options;
  options.unwrap = {host::parse_unwrapping("x_mm=6.283185307")};
  const host::Record record = host::import_record(host::parse_table(text, "angle.csv"), options);
  for (int k = 0; k < 1000; ++k) ASSERT_NEAR(record.x[static_cast<std::size_t>(k)], angle(k), 2e-6) << k;
  EXPECT_THAT(record.header.at("unwrapped_x_mm"), HasSubstr("7 times"));
  options.unwrap = {{"x_mm", 3.0}};
  EXPECT_THROW(host::import_record(host::parse_table(text, "angle.csv"), options), host::Failure);
  options.unwrap = {{"y_mm", kTurn}};
  EXPECT_THROW(host::import_record(host::parse_table(text, "angle.csv"), options), host::Failure);
  for (const char* bad : {"x_mm", "x_mm=", "x_mm=0", "x_mm=-1", "x_mm=nan", "x_mm=a"})
    EXPECT_THROW(host::parse_unwrapping(bad), host::Failure) << bad;
}

TEST(ImportJitter, IsAnErrorThatNamesItsSizeAndTheRemedy) {
  const host::Log log = host::parse_table(table("t_s,u_V,x_mm\n", ",", jittered), "log.txt");
  EXPECT_THAT(message_of(log, ""), AllOf(HasSubstr("uneven sampling"), HasSubstr("0.2 ms at worst"), HasSubstr("line "),
                                         testing::EndsWith("--resample 0.001")));
}

TEST(ImportJitter, ResampledAndStated) {
  const host::Log log = host::parse_table(table("t_s,u_V,x_mm\n", ",", jittered), "log.txt");
  const host::Record record = import(log, "", 0.001);
  EXPECT_EQ(record.sample_period_s, 0.001);
  for (std::size_t k = 0; k < record.size(); ++k) {
    EXPECT_NEAR(record.t_s[k], 0.001 * static_cast<double>(k), 1e-12);
    EXPECT_NEAR(record.x[k], 3.0 * record.t_s[k], 2e-6);  // the position is a straight line in time
  }
  // Row 2 was commanded 0.2 ms late. During this time row 1 was still held.
  EXPECT_NEAR(record.u_V[2], 0.2 * std::sin(0.1) + 0.8 * std::sin(0.2), 2e-6);
  EXPECT_THAT(record.header.at("resampled"),
              AllOf(HasSubstr("to 0.001 s from 200 rows"), HasSubstr("0.2 ms at worst")));
  EXPECT_EQ(record.header.at("resampled_gaps"), "none");
  EXPECT_THAT(host::format_record(record), HasSubstr("# resampled_by: straight lines"));
}

TEST(ImportJitter, GapsAreFilledOnlyWhenAskedAndThenStated) {
  const auto gapped = [](int k) { return 0.001 * (k < 100 ? k : k + 5); };
  const host::Log log = host::parse_table(table("t_s,u_V,x_mm\n", ",", gapped), "log.txt");
  EXPECT_THAT(message_of(log, ""), AllOf(HasSubstr("line 102"), HasSubstr("dropped samples"), HasSubstr("--resample")));
  const host::Record record = import(log, "", 0.001);
  EXPECT_EQ(record.size(), 205u);
  EXPECT_THAT(record.header.at("resampled_gaps"),
              AllOf(HasSubstr("1 gap(s), 5 sample(s) missing"), HasSubstr("longest 0.006 s")));
}

TEST(ImportJitter, SlowerChannelsWithBlankFieldsOrStampsOfTheirOwn) {
  std::string text = "t_s,u_V,x_mm,temp_C\n";
  for (int k = 0; k < kMatRows; ++k)
    text +=
        fmt::format("{:.3f},{},{},{}\n", even(k), k % 7, 2 * k, k % 10 == 0 ? fmt::format("{}", 20.0 + 0.1 * k) : "");
  const host::Log log = host::parse_table(text, "log.txt");
  EXPECT_THAT(message_of(log, ""), AllOf(HasSubstr("line 3, temp_C"), HasSubstr("--resample")));
  const host::Record record = import(log, "", 0.001);
  EXPECT_EQ(record.size(), 191u);  // up to the last temperature
  EXPECT_NEAR(record.temp_C[15], 21.5, 1e-9);
  EXPECT_THAT(record.header.at("resampled_temp_C"), HasSubstr("20 values"));

  host::Log two_clocks;
  two_clocks.path = "two.mat";
  std::vector<double> fast, slow, command, position;
  for (int k = 0; k < 100; ++k) fast.push_back(0.001 * k), command.push_back(k % 5);
  for (int k = 0; k < 25; ++k) slow.push_back(0.0005 + 0.004 * k), position.push_back(slow.back() * 7.0);
  two_clocks.columns = {{"t", "", fast, ""}, {"u", "", command, ""}, {"ts", "", slow, ""}, {"pos", "", position, ""}};
  EXPECT_THAT(message_of(two_clocks, "t_s=t,u_V=u,x_mm=pos@ts"), HasSubstr("--resample"));
  const host::Record merged = import(two_clocks, "t_s=t,u_V=u,x_mm=pos@ts", 0.001);
  EXPECT_NEAR(merged.t_s.front(), 0.0005, 1e-12);
  for (std::size_t k = 0; k < merged.size(); ++k) EXPECT_NEAR(merged.x[k], 7.0 * merged.t_s[k], 1e-9);
}

TEST(ImportJitter, HopelessPeriodsAreRefused) {
  const host::Log log = host::parse_table(table("t_s,u_V,x_mm\n", ",", even), "log.txt");
  EXPECT_THAT(message_of(log, "", 1e-9), HasSubstr("give a period in seconds near that of the log, 0.001"));
  EXPECT_THAT(message_of(log, "", 1.0), HasSubstr("give a shorter period"));
}

TEST(Resample, MeanOfAHeldCommand) {
  const host::StampedChannel command{{0.0, 1.0, 1.5, 3.0}, {2.0, 4.0, -6.0, 8.0}};
  const std::vector<double> means = host::mean_of_held(command, {0.0, 1.0, 2.0, 3.0}, 1.0);
  EXPECT_THAT(means, testing::ElementsAre(2.0, 0.5 * 4.0 - 0.5 * 6.0, -6.0, 8.0));
}

TEST(ImportMat, PublicBenchmarkOfAnElectromechanicalPositioningSystem) {
  const std::filesystem::path folder = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "emps";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no records in " << folder;
  for (const char* name : {"DATA_EMPS.mat", "DATA_EMPS_PULSES.mat"}) {
    const host::Record record = import(host::read_log((folder / name).string()), "t_s=t,x_m=qm,u_V=vir");
    EXPECT_EQ(record.size(), 24841u);
    EXPECT_EQ(record.sample_period_s, 0.001);
    EXPECT_EQ(record.kind, sim::DriveKind::linear);
  }
}

}  // namespace
