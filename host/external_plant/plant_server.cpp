#include "host/external_plant/plant_server.hpp"

#include <fmt/format.h>

#include <istream>
#include <ostream>
#include <string>

#include "host/exit_codes.hpp"
#include "host/external_plant/plant_answer.hpp"
#include "sim/plant.hpp"

namespace host {

namespace {
constexpr double kFinest = 1e-9;  ///< resolution of Plant::encoder_counts if the data sheet has none
}

void serve_plant(const std::vector<sim::DriveDescription>& drives, std::uint64_t seed, std::istream& in,
                 std::ostream& out) {
  std::string line;
  if (!std::getline(in, line)) return;
  const PlantGreeting greeting = parse_plant_greeting(line);
  if (greeting.axes != drives.size())
    throw Failure(ExitCode::protocol, fmt::format("the controller has {} axes, the machine {}: --axes {}",
                                                  greeting.axes, drives.size(), greeting.axes));
  std::vector<sim::Plant> plants;
  for (const sim::DriveDescription& drive : drives) plants.emplace_back(drive, seed + plants.size());
  out << "ready" << std::endl;
  std::vector<sim::ForeignReading> readings(plants.size());
  for (std::uint64_t k = 0; std::getline(in, line); ++k) {
    const auto commands_V = parse_plant_line(line, k, plants.size());
    for (std::size_t axis = 0; axis < plants.size(); ++axis) {
      sim::Plant& plant = plants[axis];
      plant.set_enabled(commands_V[axis].has_value());
      plant.set_command(commands_V[axis].value_or(0.0));
      plant.advance(greeting.period_s);
      const double resolution = plant.data().encoder_resolution;
      const double step = resolution > 0.0 ? resolution : kFinest;
      readings[axis] = {step * static_cast<double>(plant.encoder_counts()), plant.read_tachometer()};
    }
    out << plant_answer(k, readings) << std::flush;
  }
}

}  // namespace host
