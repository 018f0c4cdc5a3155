// Tracking tests of the estimator on a board whose machine shares no code with the simulator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

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
  explicit TunedEstimator(double time_s = 600.0, std::uint32_t seed = 7, std::optional<double> force_N = {}) {
    board_.machine->seed(seed);
    host::CommissionOptions options = own_options();
    options.box.time_s = time_s;
    options.force_N = force_N;
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
    session_->record(fast_jogs());
  }

  static host::CommissionRun fast_jogs() {
    return {"ladder-fast.csv", "ladder", {{20.0, 40.0}, {{"hold", 0.5}}}, "", 5.0};
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

/// Catches figures of other runs, a chosen value that is not the least noisy one with a small error, a softer axis, the
/// variance of another sensor, and a choice that later designs do not use.
TEST_F(TunedEstimator, IsTheCalmestThatIsNoSofter) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  host::tune_estimator(*session_);
  const json found = folder_.read_json("estimator.json"), tried = found["tried"];
  ASSERT_EQ(tried.size(), 5u);
  std::size_t place = tried.size();
  for (std::size_t i = 0; i < tried.size(); ++i) {
    std::printf("Rwd %g V2: observer %.1f Hz, error %s +- %s um, noise %s V, %.4f um/N at %.1f Hz %s\n",
                tried[i]["rwd_V2"].get<double>(), tried[i]["observer_Hz"].get<double>(),
                tried[i]["rms_um"].dump().c_str(), tried[i]["repeats_um"].dump().c_str(),
                tried[i]["command_noise_V"].dump().c_str(), tried[i]["compliance_um_N"].get<double>(),
                tried[i]["softest_at_Hz"].get<double>(), tried[i]["unusable_because"].get<std::string>().c_str());
    if (i > 0) {
      EXPECT_NEAR(tried[i]["rwd_V2"].get<double>(), 10.0 * tried[i - 1]["rwd_V2"].get<double>(), 1e-9);
      EXPECT_GT(tried[i]["observer_Hz"], tried[i - 1]["observer_Hz"]);
      EXPECT_LT(tried[i]["compliance_um_N"], tried[i - 1]["compliance_um_N"]);
    }
    if (tried[i]["rwd_V2"] == found["chosen_V2"]) place = i;
    if (tried[i]["rms_um"].is_null()) continue;
    const std::string name = "estimator-" + std::to_string(i + 1);
    const double once = error_um(name + ".csv"), again = error_um(name + "-again.csv");
    EXPECT_NEAR(tried[i]["rms_um"], (once + again) / 2.0, 0.01 * once);
  }
  std::printf("%s\n", found["why"].get<std::string>().c_str());
  // On this machine, every larger value has a larger following error.
  ASSERT_LT(place, tried.size());
  EXPECT_LE(tried[place]["compliance_um_N"].get<double>(), 1.09 * found["first_compliance_um_N"].get<double>());
  ASSERT_GT(place, 0u);
  EXPECT_GT(tried[place - 1]["compliance_um_N"], found["first_compliance_um_N"]);
  EXPECT_LT(tried[place - 1]["rms_um"], tried[place]["rms_um"]);
  EXPECT_GT(tried[4]["command_noise_V"], tried[0]["command_noise_V"]);
  const double true_variance = std::pow(board_.machine->tachometer_deviation, 2);
  EXPECT_NEAR(found["tachometer_variance"]["moving"], true_variance, 0.15 * true_variance);
  EXPECT_EQ(session_->tuned_options().disturbance_variance, found["chosen_V2"]);
  EXPECT_EQ(*session_->tuned_options().tach_variance, found["tachometer_variance"]["used"]);
}

/// Catches a variance of another sensor, record or state of the axis, one that the text or the folder states otherwise,
/// and a design with the smaller of both.
TEST_F(TunedEstimator, UsesTheLargerNoiseOfRestAndMotion) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const double converter = std::pow(hal::pc::AxisWiring{}.tachometer_resolution, 2) / 12.0;
  for (const auto& [moving, resting] : {std::pair{0.1, 0.05}, {0.06, 0.08}}) {
    board_.machine->tachometer_deviation = moving;
    board_.machine->resting_deviation = resting;
    session_->record(fast_jogs());
    session_->record({"dwell.csv", "dwell", {{0.4, 1.0}, {{"speed", 5.0}, {"hold", 0.25}}}, "", 4.0});
    const host::CommissionStepResult result = host::tune_estimator(*session_);
    const json found = folder_.read_json("estimator.json")["tachometer_variance"];
    std::printf("%s\n%s\n", found.dump().c_str(), result.said.c_str());
    for (const auto& [key, deviation] : {std::pair{"moving", moving}, {"at_rest", resting}}) {
      const double true_variance = std::pow(deviation, 2) + converter;
      EXPECT_NEAR(found[key], true_variance, 0.15 * true_variance) << key;
    }
    EXPECT_EQ(found["used"], found[resting > moving ? "at_rest" : "moving"]);
    EXPECT_EQ(found["from"], json::parse(R"({"at_rest": ["dwell.csv"], "moving": ["ladder-fast.csv"]})"));
    EXPECT_THAT(result.said, testing::HasSubstr("in motion (ladder-fast.csv)"));
    EXPECT_THAT(result.said, testing::HasSubstr("at rest (dwell.csv)"));
    EXPECT_EQ(*session_->tuned_options().tach_variance, found["used"]);
  }
}

/// Catches an Rw without the noise at rest where no powered record shows a rest.
TEST_F(TunedEstimator, TakesTheNoiseOfTheDisabledAxisIfThePoweredOneNeverRests) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  board_.machine->resting_deviation = 0.3;
  host::look(*session_);
  host::tune_estimator(*session_);
  const json found = folder_.read_json("estimator.json")["tachometer_variance"];
  EXPECT_EQ(found["from"]["at_rest"], json::array({"standstill.csv"}));
  EXPECT_NEAR(found["at_rest"], 0.09, 0.15 * 0.09);
  EXPECT_EQ(found["used"], found["at_rest"]);
}

/// The rows in which a reference moves forward at constant speed, without the first part, in which the loop settles.
std::pair<std::size_t, std::size_t> steady_rows(const host::Record& run) {
  std::size_t begin = 0, best = 0, from = 0;
  for (std::size_t k = 2; k < run.size(); ++k) {
    const double step = run.x_ref[k] - run.x_ref[k - 1], before = run.x_ref[k - 1] - run.x_ref[k - 2];
    if (step <= 1e-4 || std::abs(step - before) > 1e-4) from = k;
    if (k - from > best) {
      best = k - from;
      begin = from;
    }
  }
  return {begin + best / 5, begin + best};
}

/// Catches a stiffness in a wrong unit, of another loop, or without the estimator's part. The machine is moved under a
/// sinusoidal force; its amplitude must be the one on which the choice is based (the model is 5 % off).
TEST_F(TunedEstimator, YieldsToAForceAsStated) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  host::tune_estimator(*session_);
  const json tried = folder_.read_json("estimator.json")["tried"];
  for (const std::size_t i : {0u, 2u, 4u}) {
    const double f_Hz = tried[i]["softest_at_Hz"], stated = tried[i]["compliance_um_N"], force_N = 6.0 / stated;
    session_->download(session_->with_file(folder_.path("estimator-" + std::to_string(i + 1) + "-params.toml")));
    const auto sine = [&](double t_s) { return force_N * std::sin(2.0 * std::numbers::pi * f_Hz * t_s); };
    board_.machine->process_N = sine;
    const host::Record run = session_->record({"forced.csv", "ladder", {{20.0}, {{"hold", 1.5}}}, "", 8.0});
    board_.machine->process_N = nullptr;
    const auto [begin, end] = steady_rows(run);
    const double turn = 2.0 * std::numbers::pi * f_Hz * 1e-3;
    const auto rows =
        static_cast<std::size_t>(std::floor(static_cast<double>(end - begin) * turn / 6.2831853) * 6.2831853 / turn);
    ASSERT_GT(rows, 700u);
    std::complex<double> sum = 0.0;
    double mean = 0.0;
    for (std::size_t k = begin; k < begin + rows; ++k) mean += (run.x_ref[k] - run.x[k]) / static_cast<double>(rows);
    for (std::size_t k = begin; k < begin + rows; ++k)
      sum += (run.x_ref[k] - run.x[k] - mean) *
             std::polar(2e3 / static_cast<double>(rows), -turn * static_cast<double>(k));
    std::printf("Rwd %g V2, %.1f Hz: stated %.5f, measured %.5f um/N\n", tried[i]["rwd_V2"].get<double>(), f_Hz, stated,
                std::abs(sum) / force_N);
    EXPECT_NEAR(std::abs(sum) / force_N, stated, 0.15 * stated) << i;
  }
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

/// Catches a calmer estimator that stays because the axis follows better with it, although process forces move it more.
TEST_F(TunedEstimator, IsTakenBackWhereItIsSofter) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  board_.machine->tachometer_deviation = 0.5;  // its noise moves the axis
  folder_.put("estimator", {{"rwd_V2", 0.01 * session_->first_options().disturbance_variance}, {"rw", nullptr}});
  std::printf("%s\n", host::compensate(*session_).said.c_str());
  const json errors = folder_.read_json("errors.json");
  std::map<std::string, json> sets;
  for (const json& set : errors["sets"]) {
    sets[set["name"]] = set;
    const bool is_tuned = set["name"] == "loop" || set["name"] == "after";
    EXPECT_EQ(set["too_soft"], is_tuned) << set["name"];
  }
  ASSERT_LT(sets["after"]["rms_um"].get<double>() + sets["after"]["repeats_um"].get<double>(),
            sets["before"]["rms_um"].get<double>() - sets["before"]["repeats_um"].get<double>());
  EXPECT_EQ(folder_.document()["estimator_kept"], false);
}

/// The same machine with a process force that is known.
class LoadedEstimator : public TunedEstimator, public testing::WithParamInterface<double> {
 protected:
  LoadedEstimator() : TunedEstimator(600.0, 7, GetParam()) {}
};

/// Catches a force that has no influence: a small one is worth no noise, a large one much.
TEST_P(LoadedEstimator, DeviatesLeastUnderTheForce) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  host::tune_estimator(*session_);
  const json found = folder_.read_json("estimator.json");
  EXPECT_EQ(found["force_N"], GetParam());
  std::printf("%s\n", found["why"].get<std::string>().c_str());
  EXPECT_EQ(found["chosen_V2"], GetParam() < 100.0 ? 1e-4 : 1.0);
  std::printf("%s\n", host::compensate(*session_).said.c_str());
  EXPECT_EQ(folder_.document()["estimator_kept"], GetParam() > 100.0);  // calm, it follows the longer jogs no better
  for (const json& set : folder_.read_json("errors.json")["sets"]) EXPECT_EQ(set["too_soft"], false) << set["name"];
}

INSTANTIATE_TEST_SUITE_P(Forces, LoadedEstimator, testing::Values(1.0, 3000.0));

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
