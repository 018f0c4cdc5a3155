// A capture: rows at loop rate from a board, beginning before a trigger, while the axis makes commanded jogs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/device/board_client.hpp"
#include "host/device/capture_channels.hpp"
#include "host/record/record.hpp"

namespace host {

struct Trigger {
  firmware::Channel channel = firmware::Channel::dac_code;
  bool rising = true;  ///< triggers at the first row above the level; otherwise at the first row below
  double level = 0.0;
};

/// "w_rad_s>5", "x_mm<0.1". Throws Failure(usage).
Trigger parse_trigger(std::string_view text, sim::DriveKind kind);

struct JogStep {
  double velocity = 0.0;  ///< mm/s (m/s)
  double duration_s = 0.0;
};

/// "20:1.5": 20 mm/s for 1.5 s. Throws Failure(usage).
JogStep parse_jog(const std::string& text);

struct CaptureSettings {
  std::uint8_t axis = 0;
  sim::DriveKind kind = sim::DriveKind::rotary;
  std::vector<firmware::Channel> channels;  ///< 1 to kWordsPerReport different ones
  std::uint16_t every = 1;                  ///< control periods from row to row
  double duration_s = 1.0;                  ///< from the first row, or from the trigger; 0: the duration of the jogs
  std::optional<Trigger> trigger;           ///< its channel is among `channels`
  double before_s = 0.0;                    ///< time before the trigger to keep
  double patience_s = 60.0;                 ///< time-out for the trigger
  double table_resolution = 0.0;            ///< mm (m) per count of the scale on the table (channel table_counts)
  std::vector<JogStep> jogs;                ///< one after the other, from the first row on; the axis is enabled
};

struct Capture {
  std::vector<std::uint32_t> number;  ///< of each row; a jump means lost rows
  std::vector<std::vector<double>> channel;
  double row_period_s = 0.0;
  std::optional<double> trigger_s;  ///< from the first row to the trigger; empty until it occurs
  std::size_t lost = 0;             ///< number of missing rows between the first and the last
  std::uint32_t dropped_by_board = 0;
};

/// Called some hundred times a second with the capture so far. If it returns false, the capture ends with the rows so
/// far.
using CaptureWatch = std::function<bool(const Capture&)>;

/// Rows in one report, with this number of channels. Throws Failure(protocol) for an incomplete row.
std::size_t rows_in(const BoardClient::Samples& samples, std::size_t channels);

/// Appends a row; its words stand in the order of the channels' numbers.
void append_row(Capture& capture, const std::vector<firmware::Channel>& channels, ChannelScale& scale,
                std::uint32_t number, const std::uint32_t* words);

/// Number of rows missing between the first and the last, by the rows' numbers.
std::size_t lost_rows(const std::vector<std::uint32_t>& numbers);

/// Throws Failure(refused) for jogs beyond the axis's limits, Failure(usage) for more rows than USB carries.
void require_capturable(const firmware::ParameterValues& values, const CaptureSettings& settings);

/// Throws Failure(protocol) if rows were lost; `where` names the file with the gap.
void require_no_loss(const Capture& capture, const std::string& where);

/// Runs a capture. Throws Failure: time_out (no trigger), refused (ended before the trigger or the first row),
/// device_fault if the axis stops during the jogs, and those of BoardClient. However it ends, the axis is stopped and
/// the board's capture ended.
Capture run_capture(BoardClient& board, const CaptureSettings& settings, const CaptureWatch& watch = {});

/// Converts a capture to a record; t_s follows from the rows' numbers and is 0 at the first row.
Record capture_record(const Capture& capture, const CaptureSettings& settings, const std::string& drive);

}  // namespace host
