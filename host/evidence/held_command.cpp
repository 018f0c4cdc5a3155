#include "host/evidence/held_command.hpp"

#include <utility>

#include "host/evidence/smoothed_motion.hpp"
#include "host/identify/effort_timing.hpp"

namespace host {

HeldCommand::HeldCommand(const Record& record, const sim::DataSheet& data)
    : t_s_(&record.t_s), u_V_(record.u_V), change_s_(record.sample_period_s), rest_s_(0.0) {
  if (!u_V_.empty()) return;
  const double gain_A_per_V = current_per_volt(record, data);
  HeldCurrent held = held_current(record);
  for (double& value : held.i_A) value /= gain_A_per_V;
  u_V_ = std::move(held.i_A);
  change_s_ = held.change * record.sample_period_s;
  rest_s_ = record.sample_period_s - change_s_;
}

}  // namespace host
