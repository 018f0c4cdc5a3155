#include "host/device/fault_record.hpp"

#include "host/device/capture_channels.hpp"

namespace host {

std::optional<Record> read_fault_record(BoardClient& board, std::uint8_t axis, sim::DriveKind kind) {
  using firmware::Channel;
  const firmware::ParameterValues values = board.read_values();
  ChannelScale scale(values.axis(axis), board.identify().fixed_point != 0, board.status().axis.at(axis).counts());
  const bool has_tachometer = values.axis(axis).get<"tachometer.fitted">();
  Record record;
  record.drive = firmware::kAxisNames.at(axis);
  record.kind = kind;
  record.header["source"] = "axistool faults";
  ExtraChannel error{channel_name(Channel::position_error, kind), {}, {}};
  ExtraChannel speed{channel_name(Channel::velocity_estimate, kind), {}, {}};
  ExtraChannel disturbance{channel_name(Channel::disturbance, kind), {}, {}};
  for (std::uint16_t n = 0;; ++n) {
    const auto row = board.fault_row(axis, n);
    if (!row) break;
    record.sample_period_s = static_cast<double>(row->every) / values.get<"control.rate">();
    record.t_s.push_back(n * static_cast<double>(row->every) / values.get<"control.rate">());
    record.u_V.push_back(scale(Channel::dac_code, row->dac_code));
    record.x.push_back(scale(Channel::counts, row->counts));
    if (has_tachometer) record.w.push_back(scale(Channel::tachometer_velocity, row->tachometer_velocity));
    record.w_ref.push_back(scale(Channel::reference_velocity, row->reference_velocity));
    error.values.push_back(scale(Channel::position_error, row->position_error));
    speed.values.push_back(scale(Channel::velocity_estimate, row->velocity_estimate));
    disturbance.values.push_back(scale(Channel::disturbance, row->disturbance));
  }
  if (record.size() < 2) return std::nullopt;
  record.extra = {error, speed, disturbance};
  return record;
}

}  // namespace host
