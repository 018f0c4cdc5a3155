// The effect that a machine hides looks most like its residual, over the coordinate in which it shows.
#include "host/compare/look_alike.hpp"

#include <gtest/gtest.h>

#include "host/compare/residual_figures.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "sim/catalogue.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

using host::LookAlike;

std::vector<LookAlike> alike_in(const std::string& number, const std::string& coordinate) {
  const std::string folder = std::string(AXIS_TEST_DATA) + "/drive-cases/single/case-" + number;
  const sim::DriveDescription model = host::read_model(folder + "/model.toml");
  const host::ComparedModel compared =
      host::compare_with("model.toml", model, {host::read_record(folder + "/train-jog.csv")}, host::kWindow_s, {});
  return host::look_alikes(compared.model, compared.set, coordinate, host::ripple_period(model));
}

TEST(LookAlike, TheHiddenEffectHasTheShapeOfTheResidual) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const std::vector<LookAlike> ripple = alike_in("00", "phase");  // this machine cogs
  ASSERT_GT(ripple.size(), 10U);
  EXPECT_EQ(ripple.front().kind, "cogging");
  EXPECT_GT(ripple.front().likeness, 0.8);
  for (const LookAlike& one : ripple) {
    EXPECT_TRUE(one.likeness >= 0.0 && one.likeness <= 1.0) << one.kind;
    EXPECT_TRUE(sim::find_effect(one.kind)->periodic || one.likeness < 0.6) << one.kind << " " << one.likeness;
  }
  EXPECT_EQ(alike_in("09", "speed").front().kind, "dac_dead_zone");
}

TEST(LookAlike, ThePageSaysWhatTheCommandSays) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  const nlohmann::json request = {
      {"do", "compare"}, {"models", {"model.toml"}}, {"records", {"train-jog.csv"}}, {"like", "phase"}};
  const auto [status, told] = served.post("/api/like", request);
  ASSERT_EQ(status, 200) << told;
  EXPECT_EQ(told["command"], "axistool compare model.toml train-jog.csv --like phase");
  EXPECT_EQ(told["document"]["effects"].size(), 5U);
  EXPECT_EQ(told["document"]["effects"][0]["kind"], "cogging");
  nlohmann::json without = request;
  without.erase("like");
  EXPECT_EQ(served.post("/api/like", without).first, 400);
}

}  // namespace
