// Tries five disturbance variances of the estimator on the machine (Erkorkmaz & Altintas 2001, p. 1503).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "host/commission/estimator_choice.hpp"
#include "host/commission/following.hpp"
#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/tachometer.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

constexpr std::array kFactors = {0.01, 0.1, 1.0, 10.0, 100.0};  // of the first controller's Rwd
constexpr double kRuns = 2.0 * static_cast<double>(kFactors.size());
constexpr const char* kFile = "estimator.json";

constexpr const char* kMovingFile = "ladder-fast.csv";

/// Variance of the tachometer, (rad/s)^2 ((m/s)^2). It changes between measurements; the design uses the larger value
/// (p. 1503).
struct TachometerNoise {
  std::optional<double>
      at_rest;  ///< eq. (46); of the disabled axis if the powered one never rests; empty if no record shows a rest
  std::vector<std::string> rest_files;  ///< records that show one
  double moving = 0.0;                  ///< from kMovingFile
  double used() const { return std::max(at_rest.value_or(0.0), moving); }

  nlohmann::json json() const {
    return {{"at_rest", at_rest ? nlohmann::json(*at_rest) : nlohmann::json()},
            {"moving", moving},
            {"used", used()},
            {"from", {{"at_rest", rest_files}, {"moving", nlohmann::json::array({kMovingFile})}}}};
  }

  std::string sentence(sim::DriveKind kind) const {
    const std::string why = at_rest ? fmt::format("the larger of {:.2g} in motion ({}) and {:.2g} at rest ({})", moving,
                                                  kMovingFile, *at_rest, fmt::join(rest_files, ", "))
                                    : fmt::format("as in motion ({}); no record shows a rest", kMovingFile);
    return fmt::format(" Rw, the tachometer's variance, is {:.2g} ({})², {}.", used(), units_of(kind).speed, why);
  }
};

class EstimatorStep {
 public:
  explicit EstimatorStep(CommissionSession& session)
      : session_(session),
        folder_(session.folder()),
        model_(read_model(folder_.require("improved.toml", "improve"))),
        options_(session.first_options()) {}

  CommissionStepResult run() {
    folder_.put("estimator", nullptr);
    const std::optional<TachometerNoise> noise = tachometer_noise();
    if (noise && noise->used() > 0.0) options_.tach_variance = noise->used();
    const double needed_s = kRuns * jogs("").time_s + kLeft * judging_jogs(session_, "").time_s,
                 left_s = session_.options().box.time_s - session_.motion_s();
    if (needed_s > left_s)
      return {{},
              fmt::format("Not tried: these tests and the last comparison need {:.0f} s of motion, and the box's time "
                          "leaves {:.0f} s. A longer --box time=… allows them.",
                          needed_s, left_s)};
    session_.ask("Estimator: the same two jogs with five variances of the disturbance, twice each.");
    for (const double factor : kFactors) tests_.push_back(test(factor * options_.disturbance_variance));
    session_.disable();
    const EstimatorDemand demand{compliance_of(raised_loop(session_, model_, session_.first_options())),
                                 session_.options().force_N, session_.feedback_V() / kDeviations};
    const EstimatorChoice choice = choose_estimator(tests_, demand);
    nlohmann::json document = tracking_json(tests_, demand, choice);
    if (noise) document["tachometer_variance"] = noise->json();
    folder_.write_json(kFile, document);
    files_.emplace_back(kFile);
    if (choice.value)
      folder_.put("estimator",
                  {{"rwd_V2", tests_[*choice.value].disturbance_variance},
                   {"rw", options_.tach_variance ? nlohmann::json(*options_.tach_variance) : nlohmann::json()}});
    return {files_, choice.why + "." + (noise ? noise->sentence(model_.data.kind) : "")};
  }

 private:
  static constexpr double kLeft = 12.0;  // jogs of the last comparison: five sets twice, and a reserve of two

  /// The command must not saturate, because the design is linear (p. 1490): this many standard deviations of its noise
  /// must fit, 99.7 % of a normal distribution.
  static constexpr double kDeviations = 3.0;

  Compliance compliance_of(const CommissionLoop& loop) const {
    return compliance_with(session_, model_, designed_parameters(model_, loop.design, loop.filters));
  }

  /// Both directions slowly, where friction changes most, and fast.
  CommissionRun jogs(const std::string& file) const {
    constexpr double kHold_s = 0.5;
    const double top = session_.top_speed();
    const std::vector<double> speeds = {0.02 * top, 0.3 * top};
    return {file, "ladder", {speeds, {{"hold", kHold_s}}}, "", 2.5 * kHold_s * static_cast<double>(speeds.size())};
  }

  std::optional<TachometerNoise> tachometer_noise() const {
    if (!model_.data.tach_noise_variance) return std::nullopt;
    TachometerNoise noise;
    std::vector<Record> resting;
    const auto add = [&](const char* file) {
      if (!folder_.has(file)) return;
      Record record = read_record(folder_.path(file));
      if (!standstill_variance({record}, model_.data)) return;
      resting.push_back(std::move(record));
      noise.rest_files.emplace_back(file);
    };
    add("steps.csv");
    add("dwell.csv");
    if (resting.empty()) add("standstill.csv");  // a fine encoder shows motion wherever feedback acts
    const Record jog = read_record(folder_.require(kMovingFile, "ladder"));
    const MovingRows rows = moving_rows(jog);
    const auto moving = moving_variance(jog, rows.begin, rows.end - rows.begin, model_);
    if (!moving) return std::nullopt;
    noise.at_rest = standstill_variance(resting, model_.data);
    noise.moving = *moving;
    return noise;
  }

  TrackingTest test(double disturbance_variance) {
    TrackingTest test;
    test.disturbance_variance = disturbance_variance;
    DesignOptions options = options_;
    options.disturbance_variance = disturbance_variance;
    try {
      const CommissionLoop loop = measured_loop(session_, model_, options);
      test.bandwidth_Hz = loop.design.used.bandwidth_Hz;
      test.observer_Hz = loop.design.observer_fn_Hz.front();
      test.modulus = loop.modulus;
      test.compliance = compliance_of(loop);
      test.force = force_estimate(loop.design, model_.data);
      make_runs(test, loop);
    } catch (const Failure& failure) {
      if (failure.code != ExitCode::refused || session_.talk().stop()) throw;
      test.unusable_because = failure.what();
    }
    return test;
  }

  /// With the whole controller, because feed-forward changes the disturbance that remains for the estimate.
  void make_runs(TrackingTest& test, const CommissionLoop& loop) {
    const std::string name = fmt::format("estimator-{}", tests_.size() + 1);
    files_.push_back(name + "-params.toml");
    session_.download(session_.design(model_, loop, files_.back()));
    std::vector<Record> runs;
    std::vector<double> errors;
    for (const char* which : {"", "-again"}) {
      std::optional<Record> run = session_.try_record(jogs(name + which + ".csv"), test.unusable_because);
      if (folder_.has(name + which + ".csv")) files_.push_back(name + which + ".csv");
      if (!run) return;
      errors.push_back(following_error(*run, model_.data).rms_um);
      runs.push_back(std::move(*run));
    }
    test.error_um = (errors[0] + errors[1]) / 2.0;
    test.repeats_um = std::abs(errors[0] - errors[1]);
    test.noise_V = command_noise_V(runs[0], runs[1]);
  }

  CommissionSession& session_;
  CommissionFolder& folder_;
  sim::DriveDescription model_;
  DesignOptions options_;  ///< with the tachometer's own variance
  std::vector<TrackingTest> tests_;
  std::vector<std::string> files_;
};

}  // namespace

CommissionStepResult tune_estimator(CommissionSession& session) { return EstimatorStep(session).run(); }

}  // namespace host
