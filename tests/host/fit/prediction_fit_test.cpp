// The two limits of the likelihood on one drive. The model cannot represent its friction, which falls with speed,
// because the model has only Coulomb friction. Each fit must be better in its own measure, on a record that neither fit
// has used. Catches a fit that does not change the estimate, and a fit that changes a complete model.
#include "host/fit/prediction_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/identify/excitation.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/identify/paper_drives.hpp"
#include "sim/drive.hpp"

namespace {

host::Record steps(const sim::DriveDescription& drive, double Ku, std::uint64_t seed) {
  return host::record_open_loop(drive, host::doublet_series(Ku * host::kStepUnit_V, 0.001), seed);
}

/// RMS position error, mm, of predictions over a second from the measured position and speed, by the recorded command.
double predicted_mm(const sim::DriveDescription& model, const host::Record& record) {
  const sim::Drive drive(model);
  double squares = 0.0, count = 0.0;
  for (std::size_t begin = 200; begin + 1000 < record.size(); begin += 1000) {
    const double speed = (record.x[begin + 10] - record.x[begin - 10]) / 0.02 / model.data.lead;
    sim::DriveState state = drive.at(record.x[begin], speed);
    for (std::size_t k = begin; k < begin + 1000; ++k) {
      squares += std::pow(state.x - record.x[k], 2);
      count += 1.0;
      drive.step(state, record.u_V[k], record.t_s[k], 0.001);
    }
  }
  return std::sqrt(squares / count);
}

struct BothFits {
  host::Identification control, prediction;
  host::PredictionFit fit;
};

BothFits both(const sim::DriveDescription& machine) {
  const sim::DriveDescription sheet = host::data_sheet_of(machine);
  const host::Measurements measured =
      host::MeasurementGate(sheet).admit({steps(machine, 7.5, 1), steps(machine, 10.0, 2)});
  BothFits fits;
  fits.control = host::identify_drive(measured, sheet, host::IdentificationMethod::sliding_ls);
  fits.prediction = fits.control;
  fits.fit = host::fit_for_prediction(fits.prediction, measured, 1.0);
  return fits;
}

TEST(PredictionFit, EachFitWinsByItsOwnMeasure) {
  const sim::DriveDescription machine = *host::paper_drive("x");
  const BothFits fits = both(machine);
  const host::Record unseen = steps(machine, 6.0, 3);
  const double torque_control = host::relative_error(fits.control.model, unseen);
  const double torque_prediction = host::relative_error(fits.prediction.model, unseen);
  const double motion_control = predicted_mm(fits.control.model, unseen);
  const double motion_prediction = predicted_mm(fits.prediction.model, unseen);
  std::printf(
      "torque off by %.2f %% (control), %.2f %% (prediction); motion by %.3f mm, %.3f mm; floors %.2f -> %.2f\n",
      100.0 * torque_control, 100.0 * torque_prediction, motion_control, motion_prediction, fits.fit.before,
      fits.fit.after);
  EXPECT_LT(torque_control, torque_prediction);
  EXPECT_LT(motion_prediction, motion_control);
  EXPECT_LT(fits.fit.after, fits.fit.before);
  EXPECT_EQ(fits.fit.relative_error_before, fits.control.relative_error);
}

TEST(PredictionFit, AgreesWhereTheModelIsComplete) {
  sim::DriveDescription machine = *host::paper_drive("x");
  std::erase_if(machine.effects, [](const sim::EffectEntry& one) { return one.kind == "stribeck"; });
  const BothFits fits = both(machine);
  EXPECT_NEAR(fits.prediction.estimate.inertia.value, 7.65e-3, 0.01 * 7.65e-3);
  EXPECT_NEAR(fits.prediction.estimate.viscous.value, 0.0321, 0.03 * 0.0321);
  EXPECT_NEAR(fits.prediction.estimate.positive->value, 2.205, 0.03 * 2.205);
  EXPECT_LE(fits.prediction.estimate.inertia.ci95[0], 7.65e-3 * 1.002);
}

TEST(PredictionFit, ARecordShorterThanItsPredictionIsRefused) {
  const sim::DriveDescription machine = *host::paper_drive("x"), sheet = host::data_sheet_of(machine);
  const host::Measurements measured = host::MeasurementGate(sheet).admit({steps(machine, 7.5, 1)});
  host::Identification found = host::identify_drive(measured, sheet, host::IdentificationMethod::sliding_ls);
  EXPECT_THROW(host::fit_for_prediction(found, measured, 99.0), host::Failure);
}

}  // namespace
