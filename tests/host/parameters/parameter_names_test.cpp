// Names, units and error texts of parameters, and the page that documents them.
#include "host/parameters/parameter_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/app/parameters/parameter_check.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/parameter_page.hpp"
#include "host/read_file.hpp"

namespace {

using firmware::ValueRefusal;
using testing::HasSubstr;

std::string complaint(const char* name, ValueRefusal kind, float value) {
  return host::describe(firmware::key_at(host::require_place(name)), static_cast<std::uint8_t>(kind), value);
}

TEST(ParameterNames, AreTheSameBothWays) {
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place)
    EXPECT_EQ(host::place_named(host::full_name(place)), place);
  EXPECT_EQ(host::place_named("kalman.k11"), std::nullopt) << "the axis is missing";
  EXPECT_EQ(host::place_named("x.control.rate"), std::nullopt);
}

TEST(ParameterNames, AnUnknownNameIsAnsweredWithTheNearest) {
  try {
    host::require_place("x.kalman.k1l", "file.toml:3: ");
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(),
                HasSubstr("file.toml:3: no parameter is called x.kalman.k1l; did you mean x.kalman.k11"));
  }
}

TEST(ParameterNames, ErrorsNameParameterRangeAndUnit) {
  EXPECT_EQ(complaint("x.kalman.k11", ValueRefusal::above_maximum, 5.2F),
            "x.kalman.k11 = 5.2 is above its maximum 2.0 (1)");
  EXPECT_EQ(complaint("y.drive.sample_period", ValueRefusal::below_minimum, 1e-5F),
            "y.drive.sample_period = 1e-05 is below its minimum 5e-05 (s)");
  EXPECT_EQ(complaint("x.feedback.k1", ValueRefusal::below_minimum, -1.0F),
            "x.feedback.k1 = -1.0 is below its minimum 0.0 (V/mm; linear drive: V/m)");
  EXPECT_EQ(complaint("x.drive.fitted", ValueRefusal::above_maximum, 2.0F), "x.drive.fitted = 2 must be true or false");
  EXPECT_THAT(complaint("x.drive.sample_period", ValueRefusal::rate_disagrees, 0.002F),
              HasSubstr("set control.rate = 500"));
}

TEST(ParameterNames, ValuesReadBackAsTheSameBits) {
  const firmware::ParameterInfo& gain = host::info_at(host::require_place("x.feedback.k2"));
  for (const float value : {0.1F, 1.0F / 3.0F, -48.44405F, 1e-7F, 0.0F, -0.0F, 99999.0F}) {
    const std::string text = host::value_text(gain, value);
    EXPECT_EQ(std::stof(text), value) << text;
    EXPECT_NE(text.find_first_of(".e"), std::string::npos) << text << " would be a whole number in TOML";
  }
}

TEST(ParameterNames, ATypoIsAnsweredWithTheNearestParameterOrGroup) {
  EXPECT_EQ(host::parameter_hint("x.feedbak.k1"), "; did you mean x.feedback.k1?");
  EXPECT_EQ(host::parameter_hint("kalmna"), "; did you mean kalman?");
  EXPECT_EQ(host::parameter_hint("y.fricton"), "; did you mean y.friction?");
  EXPECT_EQ(host::parameter_hint("entirely else"), "");
}

TEST(ParameterPage, IsTheOneInTheRepository) {
  EXPECT_EQ(host::read_file(AXIS_TEST_DATA "/../../firmware/app/parameters/README.md"), host::parameter_page())
      << "write it anew: build/bin/axistool parameters --markdown > firmware/app/parameters/README.md";
}

TEST(ParameterPage, DataHoldsEveryParameter) {
  const nlohmann::json table = host::parameter_table_json();
  EXPECT_EQ(table["parameters"].size(), firmware::parameter_count(hal::kAxisCount));
  EXPECT_EQ(table["schema_hash"], firmware::kSchemaHash);
}

}  // namespace
