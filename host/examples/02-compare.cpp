// Error over noise floor on a held-back record: about 1 for a perfect model.
#include <cstdio>
#include <string>

#include "host/compare/model_comparison.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"

int main(int argc, char** argv) try {
  const std::string drive = argc > 1 ? argv[1] : "/usr/share/axistool/drive";
  const sim::DriveDescription read = host::read_model(drive + "/model.toml");
  const host::Measurements measured =
      host::MeasurementGate(read, {.accepted = {}, .as_logged = true}).read({drive + "/validate.csv"});
  const sim::DriveDescription model = host::with_measured_sensors(read, measured);
  const host::RecordSet set = host::compare_on(measured.training_records(), model);
  std::printf("error over floor = %.16g\n", host::compare_model(model, measured, set).error.combined);
} catch (const host::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.code);
}
