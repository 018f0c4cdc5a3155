#include "host/demo/shipped_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/compare/prediction.hpp"
#include "host/demo/model_plot.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/model/model_file.hpp"
#include "host/read_file.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

struct Truth {
  double J, B, forward, backward;
};

Truth read_truth(const std::string& path) {
  try {
    const auto base = nlohmann::json::parse(read_file(path)).at("base");
    const auto coulomb = base.at("Tcoul").get<std::vector<double>>();
    return {base.at("J").get<double>(), base.at("B").get<double>(), coulomb.at(0), coulomb.at(1)};
  } catch (const nlohmann::json::exception& error) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: not the truth of a drive case: {}", path, error.what()));
  }
}

Record read_for(const std::string& path, const sim::DataSheet& data) {
  Record record = read_record(path);
  adapt_to(record, data);
  check_units(record, data);
  return record;
}

std::vector<double> predicted_speed(const sim::DriveDescription& model, const Record& record) {
  Prediction prediction;
  prediction.w.assign(record.size(), std::numeric_limits<double>::quiet_NaN());
  prediction.x = prediction.w;
  predict(sim::Drive(model), prepare(record, model), prediction);
  return prediction.w;
}

}  // namespace

DemoPart show_shipped_drive(const std::string& folder, Report& report) {
  const sim::DriveDescription given = read_model(folder + "/model.toml");
  const Truth truth = read_truth(folder + "/truth.json");
  const Record steps = read_for(folder + "/train-steps.csv", given.data);
  const Record unseen = read_for(folder + "/validate.csv", given.data);
  const Identification found =
      identify_drive(MeasurementGate(given).admit({steps}), given, IdentificationMethod::sliding_ls);
  const double unseen_error = relative_error(found.model, unseen);

  const RigidEstimate& estimate = found.estimate;
  std::vector<DemoFigure> figures = {
      within_fraction("inertia J, kg m²", estimate.inertia.value, truth.J, 0.001),
      within_fraction("viscous B, Nm s/rad", estimate.viscous.value, truth.B, 0.01),
      within_fraction("Coulomb forward, Nm", estimate.positive->value, truth.forward, 0.01),
      within_fraction("Coulomb backward, Nm", estimate.negative->value, truth.backward, 0.01),
      at_most("torque error on an unseen record, %", 100.0 * unseen_error, 2.0),
  };

  report.section(
      "A drive identified from its record",
      "The record comes from an independent plant, not from this project's simulator. The model is fitted to "
      "five seconds of steps and then predicts another motion.");
  const std::vector<double> modelled = predicted_speed(found.model, unseen);
  const double speed_error = rms_difference(unseen.w, modelled);
  const double speed_noise = std::sqrt(given.data.tach_noise_variance.value_or(0.0));
  TimePlot plot = model_plot("speed", "rad/s", unseen.t_s, unseen.w, modelled);
  plot.title = "Measured and modelled speed on the unseen record (as Fig. 8)";
  plot.caption = fmt::format(
      "The model gets only the command and restarts from the measured state every {:g} ms. Difference {} rad/s rms; "
      "the tachometer's own noise is {} rad/s.",
      1e3 * kWindow_s, format_value(speed_error, 2), format_value(speed_noise, 2));
  report.add(std::move(plot));
  return {
      fmt::format("A drive from an independent simulator: inertia found within {} %; on an unseen motion the torque is "
                  "{} % off and the predicted speed {} rad/s, where the tachometer's noise is {}.",
                  format_value(100.0 * std::abs(estimate.inertia.value / truth.J - 1.0), 1),
                  format_value(100.0 * unseen_error, 2), format_value(speed_error, 2), format_value(speed_noise, 2)),
      std::move(figures)};
}

}  // namespace host
