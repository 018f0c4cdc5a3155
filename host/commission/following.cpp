#include "host/commission/following.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

namespace {

double um_per_unit(const Record& record) { return record.kind == sim::DriveKind::rotary ? 1e3 : 1e6; }

}  // namespace

MovingRows moving_rows(const Record& record) {
  MovingRows rows{record.size(), 0};
  for (std::size_t k = 1; k < record.x_ref.size(); ++k) {
    if (record.x_ref[k] == record.x_ref[k - 1]) continue;
    rows.begin = std::min(rows.begin, k - 1);
    rows.end = k + 1;
  }
  if (rows.end <= rows.begin)
    throw Failure(ExitCode::bad_input, record.path + ": the reference does not move, so there is no following error");
  return rows;
}

std::vector<double> following_um(const Record& record, const sim::DataSheet& data) {
  const MovingRows rows = moving_rows(record);
  std::vector<double> error;
  for (std::size_t k = rows.begin; k < rows.end; ++k)
    error.push_back(um_per_unit(record) * (record.x_ref[k] - record.x[k] - data.encoder_resolution / 2.0));
  return error;
}

FollowingError following_error(const Record& record, const sim::DataSheet& data) {
  FollowingError found;
  double squares = 0.0;
  const std::vector<double> error = following_um(record, data);
  for (const double e : error) {
    squares += e * e;
    found.largest_um = std::max(found.largest_um, std::abs(e));
  }
  found.rms_um = std::sqrt(squares / static_cast<double>(error.size()));
  return found;
}

double following_floor_um(const Record& once, const Record& again) {
  const MovingRows a = moving_rows(once), b = moving_rows(again);
  const std::size_t rows = std::min(a.end - a.begin, b.end - b.begin);
  double squares = 0.0;
  for (std::size_t k = 0; k < rows; ++k) {
    const auto error = [&](const Record& r, std::size_t row) { return r.x_ref[row] - r.x[row]; };
    const double change = error(once, a.begin + k) - error(again, b.begin + k);
    squares += change * change / 2.0;
  }
  return um_per_unit(once) * std::sqrt(squares / static_cast<double>(rows));
}

}  // namespace host
