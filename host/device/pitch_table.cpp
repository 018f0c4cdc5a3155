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

/// Two erases of the largest sector, as a save may take.
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

PitchPoints read_pitch(BoardClient& board, std::uint8_t axis) {
  PitchPoints points;
  firmware::TablePointsPayload part;
  do {
    const firmware::ReadTableRequest wanted{axis, 0, static_cast<std::uint16_t>(points.size())};
    const Message reply = ask(board, MessageType::read_table, wanted, board.patience());
    if (!reply.get(part) || part.points > firmware::kMostPitchPoints)
      throw Failure(ExitCode::protocol, "the board reports an impossible table of pitch errors");
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
  if (points.empty()) return "";
  return fmt::format("{} points, {:g} to {:g} mm, {}", points.size(), points.front().counts * count_mm,
                     points.back().counts * count_mm, on ? "on" : "off");
}

}  // namespace host
