// Handles the requests for a table of pitch errors.
#pragma once

#include <algorithm>
#include <bit>

#include "firmware/app/board_application.hpp"
#include "firmware/app/protocol/pitch_messages.hpp"
#include "firmware/app/protocol/report.hpp"

namespace firmware {

template <typename Application>
class PitchRequests {
 public:
  explicit PitchRequests(Application& app) : app_(app) {}

  Status answer(const Message& request, Message& reply) {
    switch (request.type) {
      case MessageType::begin_table:
        return with<BeginTableRequest>(request, [&](const auto& r) { return begin(r, reply); });
      case MessageType::table_points:
        return with<TablePointsRequest>(request, [&](const auto& r) { return take(r, reply); });
      case MessageType::finish_table:
        return with<FinishTableRequest>(request, [&](const auto& r) { return finish(r); });
      default:
        return with<ReadTableRequest>(request, [&](const auto& r) { return read(r, reply); });
    }
  }

 private:
  Status begin(const BeginTableRequest& r, Message& reply) {
    if (r.axis >= Application::kAxes || r.points == 1 || r.points > kMostPitchPoints) return Status::malformed;
    if (app_.any_enabled()) return Status::drive_enabled;
    if (r.resolution_bits != resolution_bits(app_.active(), r.axis)) {
      reply.put(limit_reply<"drive.encoder_resolution">(app_.active(), r.axis));
      return Status::bad_value;
    }
    return status_of(app_.write_flash(
        [&] { return app_.store().begin_table(app_.active().size(), r.axis, r.points, r.resolution_bits); }));
  }

  Status take(const TablePointsRequest& r, Message& reply) {
    if (r.count == 0 || r.count > kPointsPerReport) return Status::malformed;
    if (app_.any_enabled()) return Status::drive_enabled;
    if (!app_.store().is_staging_table() || r.first != app_.store().staged_points()) return Status::set_differs;
    const bool taken = app_.write_flash([&] {
      return std::all_of(r.point.begin(), r.point.begin() + r.count,
                         [&](const PitchPoint& point) { return app_.store().add_point(point); });
    });
    if (taken) return Status::ok;
    reply.put(limit_reply<"pitch.on">(app_.active(), app_.store().staged_table().axis));
    return Status::bad_value;
  }

  Status finish(const FinishTableRequest& r) {
    const StoredTableHead& staged = app_.store().staged_table();
    if (app_.any_enabled()) return Status::drive_enabled;
    if (!app_.store().is_staging_table() || staged.resolution_bits != resolution_bits(app_.active(), staged.axis))
      return Status::set_differs;
    if (r.on > 1 || (r.on == 1 && staged.points == 0)) return Status::malformed;
    return app_.finish_table(r.crc, r.on == 1);
  }

  Status read(const ReadTableRequest& r, Message& reply) {
    if (r.axis >= Application::kAxes) return Status::malformed;
    const PitchTable points = app_.store().table(r.axis).points;
    if (r.first > points.size()) return Status::no_such_row;
    TablePointsPayload payload;
    payload.points = static_cast<std::uint16_t>(points.size());
    payload.first = r.first;
    std::copy_n(points.begin() + r.first, std::min(points.size() - r.first, kPointsPerReport), payload.point.begin());
    reply.put(payload);
    return Status::ok;
  }

  Application& app_;
};

}  // namespace firmware
