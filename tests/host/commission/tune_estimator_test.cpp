// Tracking tests of the estimator on a board whose machine shares no code with the simulator.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "host/commission/steps.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/commission/own_machine.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;

class TunedEstimator : public testing::Test {
 protected:
  explicit TunedEstimator(double time_s = 600.0, std::uint32_t seed = 7) {
    board_.machine->seed(seed);
    host::CommissionOptions options = own_options();
    options.box.time_s = time_s;
    session_ = std::make_unique<host::CommissionSession>(client_, options, host::CommissionTalk{}, folder_);
    sim::DriveDescription model = own_sheet();
    model.effects = {{"inertia", {{"J", 0.008}}, {}, {}},
                     {"viscous", {{"B", 0.03}}, {}, {}},
                     {"coulomb", {{"positive", 2.0}, {"negative", -2.0}}, {}, {}}};
    host::write_model(model, folder_.path("improved.toml"));
    host::write_model(model, folder_.path("model.toml"));
    session_->give_scales();
    session_->plan_limits(model);
    session_->download(session_->design(model, session_->first_loop(model), "first-params.toml"));
    session_->record({"ladder-fast.csv", "ladder", {{20.0, 40.0}, {{"hold", 0.5}}}, "", 5.0});
  }

  /// By another formula than the tool's: from the first move of the reference to the last one.
  double error_um(const std::string& file) const {
    const host::Record run = host::read_record(folder_.path(file));
    std::size_t first = 0, last = run.size() - 1;
    while (run.x_ref[first + 1] == run.x_ref[0]) ++first;
    while (run.x_ref[last - 1] == run.x_ref[run.size() - 1]) --last;
    double squares = 0.0;
    for (std::size_t k = first; k <= last; ++k) squares += std::pow(run.x_ref[k] - run.x[k] - 0.0005, 2);
    return 1e3 * std::sqrt(squares / static_cast<double>(last - first + 1));
  }

  const TemporaryFolder disk_;
  OwnBoard board_;
  host::BoardClient client_ = board_.client();
  host::CommissionFolder folder_{disk_.path("x")};
  std::unique_ptr<host::CommissionSession> session_;
};

/// Catches figures of other runs, a value that does not trade error for noise, a variance of another sensor, and a
/// choice that later designs do not use.
TEST_F(TunedEstimator, TradesFollowingErrorForNoise) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  host::tune_estimator(*session_);
  const json found = folder_.read_json("estimator.json"), tried = found["tried"];
  ASSERT_EQ(tried.size(), 5u);
  const json* chosen = nullptr;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    std::printf("Rwd %g V2: observer %.1f Hz, error %s +- %s um, noise %s V %s\n", tried[i]["rwd_V2"].get<double>(),
                tried[i]["observer_Hz"].get<double>(), tried[i]["rms_um"].dump().c_str(),
                tried[i]["repeats_um"].dump().c_str(), tried[i]["command_noise_V"].dump().c_str(),
                tried[i]["unusable_because"].get<std::string>().c_str());
    if (i > 0) {
      EXPECT_NEAR(tried[i]["rwd_V2"].get<double>(), 10.0 * tried[i - 1]["rwd_V2"].get<double>(), 1e-9);
      EXPECT_GT(tried[i]["observer_Hz"], tried[i - 1]["observer_Hz"]);
    }
    if (tried[i]["rwd_V2"] == found["chosen_V2"]) chosen = &tried[i];
    if (tried[i]["rms_um"].is_null()) continue;
    const std::string name = "estimator-" + std::to_string(i + 1);
    const double once = error_um(name + ".csv"), again = error_um(name + "-again.csv");
    EXPECT_NEAR(tried[i]["rms_um"], (once + again) / 2.0, 0.01 * once);
  }
  std::printf("%s\n", found["why"].get<std::string>().c_str());
  ASSERT_NE(chosen, nullptr);
  // Every step up to the choice lowers the error by a larger factor than it raises the noise; the next one does not.
  const auto gain = [&](std::size_t i) {
    return std::log(tried[i]["rms_um"].get<double>() / tried[i + 1]["rms_um"].get<double>()) -
           std::log(tried[i + 1]["command_noise_V"].get<double>() / tried[i]["command_noise_V"].get<double>());
  };
  const auto place = static_cast<std::size_t>(chosen - &tried[0]);
  for (std::size_t i = 0; i < place; ++i) EXPECT_GT(gain(i), 0.0) << i;
  if (place + 1 < tried.size() && !tried[place + 1]["rms_um"].is_null()) {
    EXPECT_LE(gain(place), 0.0);
  }
  EXPECT_GT(tried[4]["command_noise_V"], tried[0]["command_noise_V"]);
  const double true_variance = std::pow(board_.machine->tachometer_deviation, 2);
  EXPECT_NEAR(found["tachometer_variance"]["moving"], true_variance, 0.15 * true_variance);
  EXPECT_EQ(session_->tuned_options().disturbance_variance, found["chosen_V2"]);
  EXPECT_EQ(*session_->tuned_options().tach_variance, found["tachometer_variance"]["used"]);
}

/// The same machine with other noise of its speed.
class Reseeded : public TunedEstimator, public testing::WithParamInterface<std::uint32_t> {
 protected:
  Reseeded() : TunedEstimator(600.0, GetParam()) {}
};

/// Catches a choice that changes with the noise of a run.
TEST_P(Reseeded, ChoosesAlike) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  static std::optional<double> chosen;
  host::tune_estimator(*session_);
  const json found = folder_.read_json("estimator.json");
  for (const json& test : found["tried"])
    std::printf("Rwd %g V2: error %s +- %s um, noise %s V\n", test["rwd_V2"].get<double>(),
                test["rms_um"].dump().c_str(), test["repeats_um"].dump().c_str(),
                test["command_noise_V"].dump().c_str());
  std::printf("%s\n", found["why"].get<std::string>().c_str());
  if (!chosen) chosen = found["chosen_V2"].get<double>();
  EXPECT_EQ(found["chosen_V2"], *chosen);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Reseeded, testing::Values(1u, 2u));

/// Catches an estimator that stays although the machine follows worse with it: an Rwd far above the tried ones.
TEST_F(TunedEstimator, IsTakenBackWhereItFollowsWorse) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  folder_.put("estimator", {{"rwd_V2", 1e4 * session_->first_options().disturbance_variance}, {"rw", nullptr}});
  std::printf("%s\n", host::compensate(*session_).said.c_str());
  const json errors = folder_.read_json("errors.json");
  std::map<std::string, json> sets;
  for (const json& set : errors["sets"]) sets[set["name"]] = set;
  ASSERT_TRUE(sets.contains("untuned"));
  ASSERT_TRUE(sets["after"]["rms_um"].is_null() || sets["after"]["rms_um"] > sets["untuned"]["rms_um"]);
  EXPECT_NE(errors["kept"], "after");
  EXPECT_NE(errors["kept"], "loop");
  EXPECT_EQ(folder_.document()["estimator_kept"], false);
  EXPECT_EQ(session_->kept_options().disturbance_variance, session_->first_options().disturbance_variance);
}

class HurriedEstimator : public TunedEstimator {
 protected:
  HurriedEstimator() : TunedEstimator(60.0) {}
};

/// Catches tests that leave no time for the comparison of the old parameters and the new ones.
TEST_F(HurriedEstimator, IsLeftAsItIs) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const double before_s = session_->motion_s();
  EXPECT_NE(host::tune_estimator(*session_).said.find("Not tried"), std::string::npos);
  EXPECT_EQ(session_->motion_s(), before_s);
  EXPECT_EQ(session_->tuned_options().disturbance_variance, session_->first_options().disturbance_variance);
}

}  // namespace
