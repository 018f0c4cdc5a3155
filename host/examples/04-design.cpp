// Estimator and state feedback from a model, with the loop at 25 Hz: its gain on the position error.
#include <cstdio>
#include <string>

#include "host/exit_codes.hpp"
#include "host/identify/axis_design.hpp"
#include "host/model/model_file.hpp"

int main(int argc, char** argv) try {
  const std::string drive = argc > 1 ? argv[1] : "/usr/share/axistool/drive";
  host::DesignOptions options;
  options.bandwidth_Hz = 25.0;
  std::printf("K1 = %.16g\n", host::design_axis(host::read_model(drive + "/model.toml"), options).Kc(0));
} catch (const host::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.code);
}
