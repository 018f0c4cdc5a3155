#include "host/axes/path_force.hpp"

#include <fmt/format.h>

namespace host {

void add_path_forces(Record& record, const PathCapture& capture, const PathBoard& board,
                     const std::vector<PathForceModel>& models) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    const PathForceRows& rows = capture.force.at(i);
    Record axis;
    axis.kind = models[i].model.data.kind;
    axis.sample_period_s = record.sample_period_s;
    axis.t_s = record.t_s;
    axis.x = capture.mm[i];
    for (double& position : axis.x) position /= board.scale.unit_mm[i];
    axis.w_ref = rows.w_ref;
    axis.extra = {{"d_hat_V", rows.d_hat_V, {}}, {"u_friction_V", rows.u_friction_V, {}}};
    add_process_force(axis, models[i].model, models[i].Kobs);
    const std::string prefix = i == 0 ? "" : fmt::format("{}_", firmware::kAxisNames.at(board.scale.axes[i]));
    record.extra.push_back({prefix + kProcessForce, axis.extra.back().values, {}});
    for (const char* key : {kProcessForceBand, kProcessForceDelay}) record.header[prefix + key] = axis.header.at(key);
  }
}

}  // namespace host
