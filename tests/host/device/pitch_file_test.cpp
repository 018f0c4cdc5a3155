// Files with the measured errors of a screw: their contents, and messages about bad files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host/device/pitch_table.hpp"
#include "host/exit_codes.hpp"

namespace {

constexpr double kEncoderStep_mm = 0.0025;

host::PitchPoints parse(const std::string& text) { return host::parse_pitch(text, "screw.csv", kEncoderStep_mm); }

TEST(PitchFile, ReadsPlacesAndDeviationsOfBothDirections) {
  const auto points =
      parse("# laser, 20 C\r\nforward_um,x_mm, backward_mm\r\n0,-10,0\r\n5, 0 ,-0.0025\r\n\r\n2.5,1e1,1e-3\r\n");
  const host::PitchPoints expected{{-4000, 0, 0}, {0, 2 * 65536, -65536}, {4000, 65536, 26214}};
  EXPECT_EQ(points, expected);
}

TEST(PitchFile, OneColumnServesBothDirections) {
  EXPECT_EQ(parse("x_m,error_um\n0,0\n0.01,-2.5\n"), (host::PitchPoints{{0, 0, 0}, {4000, -65536, -65536}}));
}

TEST(PitchFile, ReadsBackWhatItShows) {
  const host::PitchPoints points{{-12345, 7, -8}, {1, 65536 * 3 + 1, 0}, {70001, 99999, -131071}};
  EXPECT_EQ(parse(host::format_pitch(points, kEncoderStep_mm)), points);
}

struct Bad {
  const char* name;
  std::string text;
  std::vector<std::string> says;
};

TEST(PitchFile, NamesFileLineColumnAndRemedy) {
  std::string many = "x_mm,error_um\n";
  for (int i = 0; i < 257; ++i) many += fmt::format("{},0\n", i);
  for (const Bad& bad : {
           Bad{"empty", "", {"screw.csv:0", "no header", "x_mm"}},
           Bad{"comments alone", "# a\n# b\n", {"screw.csv:2", "no header"}},
           Bad{"no rows", "x_mm,error_um\n", {"screw.csv:1", "0 rows", "2 to 256"}},
           Bad{"one row", "x_mm,error_um\n1,1\n", {"screw.csv:2", "1 rows"}},
           Bad{"unknown column", "x_mm,deviation_um\n", {"screw.csv:1", "deviation_um", "forward_um"}},
           Bad{"unknown unit", "x_mm,error_in\n", {"screw.csv:1", "error_in", "units _um"}},
           Bad{"no unit", "x,error_um\n", {"screw.csv:1", "column x", "units _um"}},
           Bad{"half a pair", "x_mm,forward_um\n", {"screw.csv:1", "backward_um"}},
           Bad{"both kinds", "x_mm,error_um,forward_um,backward_um\n", {"screw.csv:1", "or error_um"}},
           Bad{"no place", "error_um\n", {"screw.csv:1", "x_mm"}},
           Bad{"twice", "x_mm,x_m,error_um\n", {"screw.csv:1", "twice"}},
           Bad{"too few fields", "x_mm,error_um\n0,0\n1\n", {"screw.csv:3", "1 fields, but the header has 2"}},
           Bad{"too many fields", "x_mm,error_um\n0,0\n1,2,3\n", {"screw.csv:3", "3 fields"}},
           Bad{"no number", "x_mm,error_um\n0,0\n1,one\n", {"screw.csv:3", "column error", "'one'", "decimal point"}},
           Bad{"comma for point", "x_mm;error_um\n", {"screw.csv:1", "not known"}},
           Bad{"not finite", "x_mm,error_um\n0,0\n1,nan\n", {"screw.csv:3", "column error", "not a number"}},
           Bad{"falling", "x_mm,error_um\n5,0\n1,0\n", {"screw.csv:3", "column x", "ascending order"}},
           Bad{"same place", "x_mm,error_um\n5,0\n5.001,0\n", {"screw.csv:3", "column x", "average repeated"}},
           Bad{"steep", "x_mm,error_mm\n0,0\n1,0.1\n", {"screw.csv:3", "1/64", "check the unit"}},
           Bad{"large", "x_mm,error_m\n0,0\n1,1\n", {"screw.csv:3", "column error", "check the unit"}},
           Bad{"far", "x_m,error_um\n0,0\n1e9,1\n", {"screw.csv:3", "column x", "check the unit"}},
           Bad{"too many", many, {"screw.csv:258", "more than 256"}},
       }) {
    try {
      parse(bad.text);
      ADD_FAILURE() << bad.name << ": taken";
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::bad_input) << bad.name;
      for (const std::string& word : bad.says)
        EXPECT_NE(std::string(failure.what()).find(word), std::string::npos) << bad.name << ": " << failure.what();
    }
  }
}

}  // namespace
