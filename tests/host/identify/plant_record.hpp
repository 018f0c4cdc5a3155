// Records of a simulated plant for the identification tests.
#pragma once

#include <string>
#include <vector>

#include "host/record/record.hpp"
#include "sim/plant.hpp"

namespace identify_test {

/// Samples what the sensors read before a period and the command held during it.
class PlantRecorder {
 public:
  PlantRecorder(const sim::DriveDescription& drive, unsigned seed) : plant_(drive, seed) {
    record_.path = "simulated " + drive.name;
    record_.drive = drive.name;
    record_.kind = drive.data.kind;
    record_.sample_period_s = drive.data.sample_period_s;
    read_sensors();
  }

  double position() const { return position_; }
  double speed() const { return speed_; }  ///< as the tachometer reads it; 0 without one

  void apply(double u_V) {
    record_.t_s.push_back(record_.sample_period_s * static_cast<double>(record_.size()));
    record_.u_V.push_back(u_V);
    record_.x.push_back(position_);
    if (plant_.data().tach_noise_variance) record_.w.push_back(speed_);
    plant_.set_command(u_V);
    plant_.advance(record_.sample_period_s);
    read_sensors();
  }

  const host::Record& record() const { return record_; }

 private:
  void read_sensors() {
    // Half a count: the counter rounds down, the position lies in the middle of the step on average.
    position_ = (static_cast<double>(plant_.encoder_counts()) + 0.5) * plant_.data().encoder_resolution;
    speed_ = plant_.read_tachometer().value_or(0.0);
  }

  sim::Plant plant_;
  host::Record record_;
  double position_ = 0.0;
  double speed_ = 0.0;
};

inline host::Record open_loop_record(const sim::DriveDescription& drive, const std::vector<double>& command,
                                     unsigned seed = 1) {
  PlantRecorder recorder(drive, seed);
  for (const double u_V : command) recorder.apply(u_V);
  return recorder.record();
}

}  // namespace identify_test
