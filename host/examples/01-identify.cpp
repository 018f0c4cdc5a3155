// Inertia from a record of steps.
#include <cstdio>
#include <string>

#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/identification.hpp"
#include "host/model/model_file.hpp"

int main(int argc, char** argv) try {
  const std::string folder = argc > 1 ? argv[1] : "/usr/share/axistool/drive";
  const sim::DriveDescription drive = host::read_drive(folder + "/model.toml");
  const host::Measurements steps = host::MeasurementGate(drive).read({folder + "/train-steps.csv"});
  const host::Identification found = host::identify_drive(steps, drive, host::default_method(steps.training()));
  std::printf("J = %.16g\n", found.estimate.inertia.value);
} catch (const host::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.code);
}
