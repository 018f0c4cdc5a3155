#include "host/open_board.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"
#include "host/exit_codes.hpp"
#include "host/external_plant/external_plant.hpp"
#include "host/link/open_device.hpp"
#include "host/model/model_file.hpp"
#include "host/simulated_board/simulated_link.hpp"

namespace host {

namespace {

/// A simulated board with this drive on every axis, for the duration of the command.
std::unique_ptr<ReportLink> simulated_board(const std::string& model) {
  const SimulatedDrive drive{read_model(model)};
  return std::make_unique<SimulatedLink>(
      SimulatedDeviceOptions{std::vector<SimulatedDrive>(hal::kAxisCount, drive), "", 1});
}

/// A simulated board with one axis whose plant is a program: "DRIVE.toml:COMMAND".
std::unique_ptr<ReportLink> board_around_program(const std::string& words, std::chrono::milliseconds patience) {
  const std::size_t colon = words.find(':');
  if (colon == std::string::npos)
    throw Failure(ExitCode::usage,
                  "--device plant:" + words + ": write plant:DRIVE.toml:COMMAND, data sheet and program");
  const sim::DriveDescription drive = data_sheet_alone(read_drive(words.substr(0, colon)));
  const auto plant = std::make_shared<ExternalPlant>(words.substr(colon + 1), 1, drive.data.sample_period_s, patience);
  return std::make_unique<SimulatedLink>(SimulatedDeviceOptions{{{drive, {}, ExternalPlant::axis(plant, 0)}}, "", 1});
}

}  // namespace

BoardClient open_board(const std::string& device, std::chrono::duration<double> patience) {
  const auto limit = std::chrono::duration_cast<std::chrono::milliseconds>(patience);
  constexpr std::string_view kModel = "model:", kPlant = "plant:";
  if (device.starts_with(kModel)) return BoardClient(simulated_board(device.substr(kModel.size())), limit);
  if (device.starts_with(kPlant)) return BoardClient(board_around_program(device.substr(kPlant.size()), limit), limit);
  return BoardClient(open_device(device), limit);
}

std::uint8_t axis_index(const std::string& name, std::size_t axes) {
  for (std::size_t axis = 0; axis < axes; ++axis)
    if (firmware::kAxisNames[axis] == name) return static_cast<std::uint8_t>(axis);
  throw Failure(ExitCode::usage,
                fmt::format("the board has no axis '{}'; it has {}", name,
                            fmt::join(firmware::kAxisNames.begin(), firmware::kAxisNames.begin() + axes, ", ")));
}

}  // namespace host
