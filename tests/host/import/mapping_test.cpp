// Valid arguments of --map, and messages about invalid ones.
#include "host/import/mapping.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

using testing::HasSubstr;

TEST(Mapping, NamesScalesAndShifts) {
  const auto mappings =
      host::parse_mappings("t_s=t_ms/1000, x_mm=counts*0.00122+0, w_rad_s = -2 * speed * 3 - 0.5 + 1, u_V=5-v/2");
  ASSERT_EQ(mappings.size(), 4u);
  EXPECT_EQ(mappings[0].column, "t_s");
  EXPECT_EQ(mappings[0].source, "t_ms");
  EXPECT_DOUBLE_EQ(mappings[0].apply(250.0), 0.25);
  EXPECT_DOUBLE_EQ(mappings[1].apply(1000.0), 1.22);
  EXPECT_EQ(mappings[2].source, "speed");
  EXPECT_DOUBLE_EQ(mappings[2].apply(10.0), -59.5);
  EXPECT_EQ(mappings[3].source, "v");
  EXPECT_DOUBLE_EQ(mappings[3].apply(4.0), 3.0);
}

TEST(Mapping, NegativeAndExponents) {
  const auto mappings = host::parse_mappings("x_m=-pos*1e-3-2.5E-1,u_V=v/-2");
  EXPECT_DOUBLE_EQ(mappings[0].apply(1000.0), -1.25);
  EXPECT_DOUBLE_EQ(mappings[1].apply(3.0), -1.5);
}

TEST(Mapping, ColumnsByNumber) {
  const auto mappings = host::parse_mappings("t_s=1,x_mm=3*0.5-1e-3,u_V=#12*2,w_rad_s=2");
  EXPECT_EQ(mappings[0].source, "1");
  EXPECT_EQ(mappings[1].source, "3");
  EXPECT_DOUBLE_EQ(mappings[1].apply(4.0), 1.999);
  EXPECT_EQ(mappings[2].source, "#12");
  EXPECT_DOUBLE_EQ(mappings[2].apply(4.0), 8.0);
  EXPECT_EQ(mappings[3].source, "2");
}

TEST(Mapping, QuotedNamesMatricesFieldsAndOwnStamps) {
  const auto mappings = host::parse_mappings("t_s='Time (s)',u_V=\"Command, V\"*2,x_m=run.log(:,2)@run.t2");
  EXPECT_EQ(mappings[0].source, "Time (s)");
  EXPECT_EQ(mappings[1].source, "Command, V");
  EXPECT_EQ(mappings[2].source, "run.log(:,2)");
  EXPECT_EQ(mappings[2].time_source, "run.t2");
}

std::string message_of(const char* text) {
  try {
    host::parse_mappings(text);
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::usage);
    EXPECT_THAT(failure.what(), HasSubstr(text));
    return failure.what();
  }
  return "no failure";
}

TEST(Mapping, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(message_of(""), HasSubstr("the name of a column"));
  EXPECT_THAT(message_of("t_s"), HasSubstr("character 4: expected '=' after 't_s'"));
  EXPECT_THAT(message_of("t_s=t,x_mm="), HasSubstr("character 12"));
  EXPECT_THAT(message_of("t_s=t,t_s=u"), HasSubstr("'t_s' is mapped twice"));
  EXPECT_THAT(message_of("x_mm=a*b"), HasSubstr("a column comes from one source"));
  EXPECT_THAT(message_of("x_mm=a+b"), HasSubstr("a column comes from one source"));
  EXPECT_THAT(message_of("x_mm=1/a"), HasSubstr("a number over 'a'"));
  EXPECT_THAT(message_of("x_mm=a/0"), HasSubstr("division by zero"));
  EXPECT_THAT(message_of("x_mm=a*0"), HasSubstr("would not depend on 'a'"));
  EXPECT_THAT(message_of("x_mm=0.5"), HasSubstr("no variable or column to come from"));
  EXPECT_THAT(message_of("x_mm=a b"), HasSubstr("'b' is not expected here"));
  EXPECT_THAT(message_of("x_mm=\"a"), HasSubstr("expected a name in quotes"));
}

}  // namespace
