// Inertia 20 % too high: shows where the prediction fails.
#include <cstdio>
#include <string>

#include "host/compare/model_comparison.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"

int main(int argc, char** argv) try {
  const std::string drive = argc > 1 ? argv[1] : "/usr/share/axistool/drive";
  sim::DriveDescription wrong = host::read_model(drive + "/model.toml");
  wrong.find("inertia")->parameters.at("J") *= 1.2;
  const host::Measurements measured =
      host::MeasurementGate(wrong, {.accepted = {}, .as_logged = true}).read({drive + "/train-steps.csv"});
  const sim::DriveDescription model = host::with_measured_sensors(wrong, measured);
  const host::RecordSet set = host::compare_on(measured.training_records(), model);
  const host::ModelComparison found = host::compare_model(model, measured, set);
  std::printf("%s\n", host::where_it_fails(found.where).c_str());
} catch (const host::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.code);
}
