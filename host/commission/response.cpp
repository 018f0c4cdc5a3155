// Measures the frequency response, designs a loop on it as fast as the requested margin allows, and measures again.
#include <fmt/format.h>

#include <optional>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "host/response/loop_design.hpp"
#include "host/response/response_measurement.hpp"
#include "host/response/response_report.hpp"

namespace host {

namespace {

constexpr double kFirst_s = 70.0, kAgain_s = 46.0;  // of motion: three bands and a resonance; two bands
constexpr std::size_t kRealisations = 3;
constexpr double kGently = 0.25;  // reduced amplitude, relative to the usual one
constexpr double kKept = 0.9;     // part of the requested margin that the second measurement must show
constexpr double kWorth = 1.05;   // smallest factor of bandwidth for which the loop is changed
constexpr const char* kMeasured = "response.json";

nlohmann::json filters_json(const ControlFilterChoice& filters) {
  if (!filters.notch) return nullptr;
  return {{"f_Hz", filters.notch->f_Hz}, {"damping", filters.notch->damping}, {"depth", filters.notch->depth}};
}

class ResponseStep {
 public:
  explicit ResponseStep(CommissionSession& session)
      : session_(session),
        folder_(session.folder()),
        model_(read_model(folder_.require("model.toml", "friction"))),
        former_(session.with_file(folder_.require("first-params.toml", "control"))) {}

  CommissionStepResult run() {
    folder_.put("raised", nullptr);
    session_.ask("Response: slow jogs in both directions with a sum of sines added.");
    session_.download(former_);
    std::optional<AxisResponse> found;
    // A large response may cause a following-error fault: then repeat with a smaller amplitude.
    for (const double share : {1.0, kGently}) {
      try {
        found = measure(kFirst_s, "response", share);
        share_ = share;
        break;
      } catch (const Failure& failure) {
        const bool is_fault = failure.code == ExitCode::device_fault;
        if ((failure.code != ExitCode::refused && !is_fault) || session_.talk().stop()) throw;
        if (is_fault) session_.recover();
        if (!is_fault || share == kGently)
          return done(fmt::format("Not measured: {}. The bandwidth stays as designed.", failure.what()));
      }
    }
    const AxisResponse& measured = *found;
    keep(response_json(measured), kMeasured);
    said_ = fmt::format("Measured at {} frequencies", measured.response.lines.size());
    if (measured.fit)
      for (const Resonance& mode : measured.fit->resonances)
        said_ += fmt::format(", resonance at {:.3g} Hz", mode.f_Hz.value);
    said_ += ". ";
    try {
      raise(measured);
    } catch (const Failure& failure) {
      if (failure.code != ExitCode::refused || session_.talk().stop()) throw;
      give_up(failure.what());
    }
    return done("");
  }

 private:
  CommissionStepResult done(const std::string& more) {
    session_.disable();
    return {files_, said_ + more};
  }

  void keep(const nlohmann::json& content, const char* file) {
    folder_.write_json(file, content);
    files_.emplace_back(file);
  }

  /// `share`: amplitude relative to the usual one.
  AxisResponse measure(double time_s, const std::string& name, double share) {
    BoardClient& board = session_.board();
    const std::uint8_t axis = session_.options().axis;
    const firmware::ParameterValues values = board.read_values();
    ResponsePlan plan;
    plan.box = session_.room_for(time_s, "the " + name, values);
    plan.share = share;
    plan.realisations = kRealisations;
    std::vector<Record> records;
    const auto keep_records = [&] {
      for (std::size_t i = 0; i < records.size(); ++i) {
        files_.push_back(fmt::format("{}-{:02}.csv", name, i + 1));
        write_record(records[i], folder_.path(files_.back()));
      }
    };
    const auto begin = board.now();
    try {
      measure_axis(board, axis, plan, values, session_.scale(values), session_.talk().stop, records);
    } catch (const Failure&) {
      session_.spend(begin);
      keep_records();
      throw;
    }
    session_.spend(begin);
    keep_records();
    session_.disable();
    const Computing computing(session_);
    const auto controller = firmware::axis_parameters<float>(values.axis(axis));
    return analyse_response(records, &controller);
  }

  LoopDesign design(const AxisResponse& measured) const {
    const Computing computing(session_);
    LoopAim aim;
    aim.modulus = session_.options().modulus;
    aim.seek_notch = true;
    return design_loop(model_, session_.first_options(), aim, measured);
  }

  void raise(const AxisResponse& measured) {
    const LoopDesign loop = design(measured);
    const double before_Hz = session_.first_options().bandwidth_Hz, after_Hz = loop.design.used.bandwidth_Hz;
    response_report(loop.after, "axis " + session_.options().axis_name + ", from the measured response", &measured)
        .write(folder_.path("response.html"));
    files_.emplace_back("response.html");
    if (after_Hz < kWorth * before_Hz && keeps_margin(measured)) return give_up("the requested margin allows no more");
    const std::string change =
        fmt::format("The bandwidth is {} from {:.3g} to {:.3g} Hz at a modulus margin of {:.2g}{}",
                    after_Hz < before_Hz ? "lowered" : "raised", before_Hz, after_Hz, session_.options().modulus,
                    loop.filters.notch ? fmt::format(", with a notch at {:.3g} Hz", loop.filters.notch->f_Hz) : "");
    session_.ask(change +
                 ", from the measured response. The parameters are downloaded but not saved, and the response is "
                 "measured again.");
    session_.download(session_.design(model_, {loop.design, loop.filters}, "raised-params.toml"));
    files_.emplace_back("raised-params.toml");
    const AxisResponse again = try_loop();
    keep(response_json(again), "response-after.json");
    if (!again.margins || !again.margins->is_stable) return give_up("measured again, the loop has no margin");
    if (!keeps_margin(again))
      return give_up(fmt::format("measured again, the modulus margin is {:.2g}", again.margins->modulus->value));
    folder_.put("raised", {{"bandwidth_Hz", {{"before", before_Hz}, {"after", after_Hz}}},
                           {"notch", filters_json(loop.filters)},
                           {"margins",
                            {{"before", response_json(measured)["margins"]},
                             {"designed", response_json(loop.after)["margins"]},
                             {"measured", response_json(again)["margins"]}}}});
    said_ += fmt::format("{}; measured again: {:.2g}.", change, again.margins->modulus->value);
  }

  bool keeps_margin(const AxisResponse& axis) const {
    return axis.margins && axis.margins->is_stable && axis.margins->modulus &&
           axis.margins->modulus->ci95[1] >= kKept * session_.options().modulus;
  }

  /// Measures with the new loop; rejects an oscillating loop.
  AxisResponse try_loop() {
    try {
      return measure(kAgain_s, "response-after", share_);
    } catch (const Failure& failure) {
      if (failure.code != ExitCode::device_fault || session_.talk().stop()) throw;
      session_.recover();
      throw Failure(ExitCode::refused, failure.what());
    }
  }

  void give_up(const std::string& why) {
    session_.download(former_);
    said_ += fmt::format("The former loop is kept: {}.", why);
  }

  CommissionSession& session_;
  CommissionFolder& folder_;
  sim::DriveDescription model_;
  firmware::ParameterValues former_;
  double share_ = 1.0;
  std::vector<std::string> files_;
  std::string said_;
};

}  // namespace

CommissionStepResult measure_response(CommissionSession& session) { return ResponseStep(session).run(); }

CommissionLoop measured_loop(CommissionSession& session, const sim::DriveDescription& model,
                             const DesignOptions& options) {
  const CommissionFolder& folder = session.folder();
  const nlohmann::json raised = folder.document().value("raised", nlohmann::json());
  if (!raised.is_object()) return {design_axis(model, options), {}};
  const Computing computing(session);
  LoopAim aim;
  aim.modulus = session.options().modulus;
  if (const nlohmann::json& notch = raised.at("notch"); notch.is_object())
    aim.filters.notch = Notch{notch.at("f_Hz"), notch.at("damping"), notch.at("depth")};
  LoopDesign loop = design_loop(model, options, aim, read_response(folder.require(kMeasured, "response")));
  CommissionLoop made{std::move(loop.design), loop.filters};
  if (loop.after.margins && loop.after.margins->modulus) made.modulus = loop.after.margins->modulus->value;
  return made;
}

CommissionLoop raised_loop(CommissionSession& session, const sim::DriveDescription& model,
                           const DesignOptions& options) {
  try {
    return measured_loop(session, model, options);
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::refused) throw;
    return session.first_loop(model);
  }
}

Compliance compliance_with(CommissionSession& session, const sim::DriveDescription& model,
                           const firmware::AxisParameters<float>& controller) {
  std::optional<AxisResponse> measured;
  if (session.folder().has(kMeasured)) measured = read_response(session.folder().path(kMeasured));
  const FinePlant drive =
      measured && measured->fit ? fine_plant(measured->response, *measured->fit) : fine_plant(plant_of(model));
  return largest_compliance(drive, AxisController(controller), rigid_axis(model), model.data.kind);
}

}  // namespace host
