#include "host/model/known_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

sim::DriveDescription drive() {
  sim::DriveDescription model;
  model.effects.push_back({"inertia", {{"J", 0.01}}, {}, {}});
  model.effects.push_back({"cogging", {{"cosine", 0.1}, {"sine", 0.0}, {"period", 5.0}}, {}, {}});
  model.effects.push_back({"cogging", {{"cosine", 0.2}, {"sine", 0.0}, {"period", 8.0}}, {}, {}});
  model.effects.push_back({"torque_ripple", {{"cosine", 0.2}, {"sine", 0.0}, {"period", 8.0}}, {}, {}});
  return model;
}

TEST(KnownParameters, AreNamedAsInTheModelFile) {
  const sim::DriveDescription model = host::with_knowledge(drive(), {"J_kg_m2", "cogging.period_mm"}, {});
  EXPECT_TRUE(model.effects[0].held.contains("J"));
  EXPECT_TRUE(model.effects[1].held.contains("period"));
  EXPECT_TRUE(model.effects[2].held.contains("period"));
  EXPECT_TRUE(model.effects[3].held.empty()) << "the key of that name belongs to another effect";
}

TEST(KnownParameters, AreBelievedAtTheirValue) {
  const sim::DriveDescription model = host::with_knowledge(drive(), {}, {"J_kg_m2=1e-4"});
  EXPECT_EQ(model.effects[0].believed.at("J"), (sim::Belief{0.01, 1e-4}));
}

TEST(KnownParameters, ThatTheModelLacksAreRefused) {
  const auto message = [](const std::vector<std::string>& held, const std::vector<std::string>& believed) {
    try {
      host::with_knowledge(drive(), held, believed);
    } catch (const host::Failure& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({"M_kg"}, {}), testing::HasSubstr("it has inertia.J_kg_m2"));
  EXPECT_THAT(message({}, {"J_kg_m2"}), testing::HasSubstr("KEY=DEVIATION"));
  EXPECT_THAT(message({}, {"J_kg_m2=0"}), testing::HasSubstr("KEY=DEVIATION"));
}

}  // namespace
