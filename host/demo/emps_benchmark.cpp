#include "host/demo/emps_benchmark.hpp"

#include <fmt/format.h>

#include "host/demo/model_plot.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/import/import_record.hpp"
#include "host/record/channel_checks.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

struct EmpsLog {
  Record record;
  double force_constant_N_per_V;
};

EmpsLog read_emps(const std::string& path) {
  const Log log = read_log(path);
  const LogColumn& gain = log.find("gtau");
  if (gain.values.empty()) throw Failure(ExitCode::bad_input, path + ": gtau, the drive's gain in N/V, is empty");
  ImportOptions options;
  options.mappings = parse_mappings("t_s=t,x_m=qm,u_V=vir");
  options.drive = "EMPS";
  return {import_record(log, options), gain.values.front()};
}

}  // namespace

DemoPart show_emps(const std::string& folder, Report& report) {
  EmpsLog seen = read_emps(folder + "/DATA_EMPS.mat");
  EmpsLog unseen = read_emps(folder + "/DATA_EMPS_PULSES.mat");
  sim::DriveDescription drive;
  drive.name = "EMPS";
  drive.data.kind = sim::DriveKind::linear;
  drive.data.force_constant_N_per_V = seen.force_constant_N_per_V;
  drive.data.sample_period_s = seen.record.sample_period_s;
  adapt_to(seen.record, drive.data);
  adapt_to(unseen.record, drive.data);
  const Identification found =
      identify_drive(MeasurementGate(drive).admit({seen.record}), drive, IdentificationMethod::unbiased_ls);
  const double forward = found.estimate.positive->value, backward = found.estimate.negative->value;

  // Published: Janot, Gautier, Brunot 2019, inverse model with offset; the ranges allow for a different filter.
  std::vector<DemoFigure> figures = {
      {"EMPS mass M, kg", found.estimate.inertia.value, 95.0, 95.2, "published 95.1089"},
      {"EMPS viscous Fv, N s/m", found.estimate.viscous.value, 202.7, 203.9, "published 203.5034"},
      {"EMPS Coulomb Fc, N", 0.5 * (forward - backward), 20.34, 20.46, "published 20.3935"},
      {"EMPS offset, N", 0.5 * (forward + backward), -3.20, -3.14, "published -3.1648"},
      {"EMPS force error, %", 100.0 * found.relative_error, 4.08, 4.12, "published 4.0834"},
      {"EMPS force error on PULSES, %", 100.0 * relative_error(found.model, unseen.record), 5.9, 6.0,
       "published 5.9824"},
  };

  report.section(
      "A real drive: the EMPS benchmark",
      "A ball-screw carriage measured by others, with an encoder only. Model: mass, viscous and Coulomb "
      "friction, offset. Compares the force that the model needs for the measured motion with the motor's force.");
  const Motion motion = prepare_motion(seen.record, drive.data, {});
  TimePlot plot = model_plot("force", "N", motion.t_s, motion.effort, inverse_effort(sim::Drive(found.model), motion));
  plot.title = "Measured and modelled force (DATA_EMPS)";
  plot.caption = "The difference at the reversals and in the strokes is the error of this simple model.";
  report.add(std::move(plot));
  return {fmt::format(
              "The real EMPS drive: mass {} kg (published 95.11), force error {} % (published 4.08), and {} % on "
              "another experiment (published 5.98).",
              format_value(figures[0].found, 4), format_value(figures[4].found, 3), format_value(figures[5].found, 3)),
          std::move(figures)};
}

}  // namespace host
