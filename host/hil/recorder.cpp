#include "host/hil/recorder.hpp"

#include "host/hil/closed_loop.hpp"

namespace host {

Recorder::Recorder(const Machine& machine) : machine_(machine) {
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    Record& record = records_[i];
    record.drive = kAxisNames[i];
    record.kind = machine.plant(i).data().kind;
    record.sample_period_s = machine.sample_period_s();
    record.extra = {{"state", {}, {}}, {"fault", {}, {}}};
  }
}

void Recorder::take() {
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    Record& record = records_[i];
    const auto& axis = machine_.axes()[i];
    const auto& seen = axis.telemetry();
    const sim::DataSheet& data = machine_.plant(i).data();
    record.t_s.push_back(next_time(record));
    record.u_V.push_back(seen.dac_code * data.dac_resolution_V);
    record.x.push_back(static_cast<double>(seen.encoder_counts) * data.encoder_resolution);
    if (const auto table = machine_.plant(i).read_load_encoder()) record.x2.push_back(*table);
    if (data.tach_noise_variance) record.w.push_back(static_cast<double>(seen.tachometer_velocity));
    record.x_ref.push_back(firmware::counts_from<double>(0, seen.reference) * data.encoder_resolution);
    record.w_ref.push_back(static_cast<double>(seen.reference_velocity));
    record.extra[0].values.push_back(static_cast<double>(axis.state()));
    record.extra[1].values.push_back(static_cast<double>(axis.fault()));
  }
}

std::vector<double> Recorder::tracking_error_um(std::size_t axis) const {
  const Record& record = records_[axis];
  const double half_count = machine_.plant(axis).data().encoder_resolution / 2.0;
  const double um = record.kind == sim::DriveKind::rotary ? 1e3 : 1e6;
  std::vector<double> error(record.size());
  for (std::size_t k = 0; k < record.size(); ++k) error[k] = um * (record.x_ref[k] - record.x[k] - half_count);
  return error;
}

}  // namespace host
