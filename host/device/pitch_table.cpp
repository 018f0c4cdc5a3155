#include "host/device/pitch_table.hpp"

#include <fmt/format.h>

#include <bit>

#include "firmware/app/crc32.hpp"
#include "firmware/app/protocol/pitch_messages.hpp"
#include "host/device/board_report.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using firmware::Message;
using firmware::MessageType;

/// A save may take two erases of the largest sector.
constexpr std::chrono::milliseconds kErasePatience{5000};

template <typename Payload>
Message ask(BoardClient& board, MessageType type, const Payload& payload, std::chrono::milliseconds patience) {
  Message message;
  message.type = type;
  message.put(payload);
  return board.exchange(message, patience);
}

}  // namespace

double count_mm_of(const firmware::ParameterValues& values, std::size_t axis) {
  const double resolution = static_cast<double>(values.axis(axis).get<"drive.encoder_resolution">());
  return is_linear(axis, values) ? 1000.0 * resolution : resolution;
}

namespace {

firmware::TablePointsPayload read_points(BoardClient& board, std::uint8_t axis, std::size_t first) {
  const firmware::ReadTableRequest wanted{axis, 0, static_cast<std::uint16_t>(first)};
  firmware::TablePointsPayload part;
  if (!ask(board, MessageType::read_table, wanted, board.patience()).get(part) ||
      part.points > firmware::kMostPitchPoints)
    throw Failure(ExitCode::protocol, "the board reports an impossible table of pitch errors");
  return part;
}

std::string extent_text(std::size_t points, const firmware::PitchPoint& first, const firmware::PitchPoint& last,
                        bool on, double count_mm) {
  return fmt::format("{} points, {:g} to {:g} mm, {}", points, first.counts * count_mm, last.counts * count_mm,
                     on ? "on" : "off");
}

}  // namespace

PitchPoints read_pitch(BoardClient& board, std::uint8_t axis) {
  PitchPoints points;
  firmware::TablePointsPayload part;
  do {
    part = read_points(board, axis, points.size());
    for (const firmware::PitchPoint& point : part.point)
      if (points.size() < part.points) points.push_back(point);
  } while (points.size() < part.points);
  return points;
}

void write_pitch(BoardClient& board, std::uint8_t axis, const PitchPoints& points, bool on) {
  const auto resolution = board.read_values().axis(axis).get<"drive.encoder_resolution">();
  const auto count = static_cast<std::uint16_t>(points.size());
  ask(board, MessageType::begin_table,
      firmware::BeginTableRequest{axis, 0, count, std::bit_cast<std::uint32_t>(resolution)}, kErasePatience);
  for (std::size_t first = 0; first < points.size(); first += firmware::kPointsPerReport) {
    firmware::TablePointsRequest part;
    part.first = static_cast<std::uint16_t>(first);
    for (; part.count < firmware::kPointsPerReport && first + part.count < points.size(); ++part.count)
      part.point[part.count] = points[first + part.count];
    ask(board, MessageType::table_points, part, kErasePatience);
  }
  const std::uint32_t crc = firmware::crc32(std::as_bytes(std::span(points)));
  ask(board, MessageType::finish_table, firmware::FinishTableRequest{crc, static_cast<std::uint8_t>(on ? 1 : 0), {}},
      kErasePatience);
  if (read_pitch(board, axis) != points)
    throw Failure(ExitCode::protocol, "the board reports another table than was sent: send it again");
}

std::string pitch_text(const PitchPoints& points, bool on, double count_mm) {
  return points.empty() ? "" : extent_text(points.size(), points.front(), points.back(), on, count_mm);
}

std::string read_pitch_text(BoardClient& board, std::uint8_t axis, bool on, double count_mm) {
  const firmware::TablePointsPayload begin = read_points(board, axis, 0);
  if (begin.points == 0) return "";
  const firmware::PitchPoint last = read_points(board, axis, begin.points - 1u).point.front();
  return extent_text(begin.points, begin.point.front(), last, on, count_mm);
}

}  // namespace host
