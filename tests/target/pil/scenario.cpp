#include "tests/target/pil/scenario.hpp"

#include <fmt/format.h>

#include <span>
#include <stdexcept>

#include "tests/firmware/friction_drive.hpp"

namespace target_test {

namespace {

using firmware::boards::PilCommand;

}  // namespace

const Story& motion_story() {
  static const Story story{kPeriods,
                           {
                               {60, 0, PilCommand::enable, 0},        {60, 1, PilCommand::enable, 0},
                               {100, 0, PilCommand::move, 40'000},    {150, 1, PilCommand::move, -25'000},
                               {1'400, 0, PilCommand::move, 39'990},  {1'500, 1, PilCommand::move, -24'999},
                               {1'900, 0, PilCommand::jog, 250},      {2'000, 1, PilCommand::jog, -250},
                               {2'600, 0, PilCommand::jog, -120},     {2'700, 1, PilCommand::jog, 0.05},
                               {3'600, 0, PilCommand::stop, 0},       {3'900, 1, PilCommand::jog, 3},
                               {4'200, 0, PilCommand::move, -60'000}, {4'400, 1, PilCommand::stop, 0},
                               {4'500, 0, PilCommand::stop, 0},  // cuts the move short
                               {4'800, 1, PilCommand::move, 10'000},  {5'200, 0, PilCommand::jog, 0.5},
                               {6'500, 1, PilCommand::disable, 0},    {6'700, 1, PilCommand::enable, 0},
                               {6'800, 1, PilCommand::jog, 200},      {6'900, 0, PilCommand::jog, -0.5},
                               {7'000, 1, PilCommand::disable, 0},  // in motion: it slows down first
                               {7'600, 1, PilCommand::enable, 0},     {7'700, 1, PilCommand::move, 0},
                               {7'900, 0, PilCommand::stop, 0},       {8'200, 0, PilCommand::move, 0},
                               {9'700, 0, PilCommand::move, 1},       {9'700, 1, PilCommand::stop, 0},
                           },
                           {}};
  return story;
}

const Story& fault_story() {
  using Lines = std::array<std::uint32_t, 2>;
  static const Story story{3'300,
                           {{60, 0, PilCommand::enable, 0},         {60, 1, PilCommand::enable, 0},
                            {70, 0, PilCommand::jog, 150},          {70, 1, PilCommand::jog, -200},
                            {600, 0, PilCommand::clear_fault, 0},   {600, 1, PilCommand::clear_fault, 0},
                            {660, 0, PilCommand::enable, 0},        {660, 1, PilCommand::enable, 0},
                            {670, 0, PilCommand::move, 60'000},     {670, 1, PilCommand::jog, 100},
                            {1'300, 0, PilCommand::clear_fault, 0}, {1'300, 1, PilCommand::clear_fault, 0},
                            {1'400, 0, PilCommand::enable, 0},      {1'400, 1, PilCommand::enable, 0},
                            {1'410, 0, PilCommand::jog, -250},      {1'410, 1, PilCommand::jog, 250},
                            {2'100, 0, PilCommand::clear_fault, 0}, {2'100, 1, PilCommand::clear_fault, 0},
                            {2'200, 0, PilCommand::enable, 0},      {2'200, 1, PilCommand::enable, 0},
                            {2'210, 0, PilCommand::jog, 50},        {2'750, 0, PilCommand::clear_fault, 0},
                            {2'750, 1, PilCommand::clear_fault, 0}, {2'850, 0, PilCommand::enable, 0},
                            {2'850, 1, PilCommand::enable, 0},      {2'870, 1, PilCommand::jog, 150}},
                           {{300, Lines{1, 0}, 0},  // x reaches its positive end
                            {500, Lines{0, 0}, 0},
                            {900, Lines{0, 0}, 0, 700},  // a period comes late
                            {1'700, Lines{0, 8}, 0},     // y's amplifier fails
                            {1'800, Lines{0, 0}, 0},
                            {2'500, Lines{0, 0}, 1},  // emergency stop
                            {2'600, Lines{0, 0}, 2},  // supply low
                            {2'700, Lines{0, 0}, 0},
                            {3'000, Lines{0, 16}, 0}}};  // y's amplifier is not ready any more
  return story;
}

Plants::Plants() {
  const std::array<const firmware_test::PaperAxis*, 2> axes{&firmware_test::kPaperX, &firmware_test::kPaperY};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    plant_[i] = std::make_unique<sim::Plant>(firmware_test::friction_drive(*axes[i]), 20'010 + i);
    connector_[i] = std::make_unique<hal::pc::SimulatedAxis>(*plant_[i]);
  }
}

firmware::boards::PilRequest Plants::read(std::uint32_t period) {
  firmware::boards::PilRequest request;
  request.number = period;
  request.now_us = 1000 * period;
  for (std::size_t i = 0; i < connector_.size(); ++i) {
    const hal::TachometerReading tachometer = connector_[i]->tachometer().read();
    request.axis[i].encoder_counts = connector_[i]->encoder().read().counts;
    request.axis[i].tachometer_code = tachometer.code;
    request.axis[i].tachometer_valid = tachometer.valid ? 1 : 0;
  }
  return request;
}

void Plants::apply(const firmware::boards::PilReply& reply) {
  for (std::size_t i = 0; i < connector_.size(); ++i) {
    connector_[i]->drive_enable().set((reply.axis[i].outputs & 1u) != 0);
    connector_[i]->dac().write(reply.axis[i].dac_code);
    plant_[i]->advance(firmware_test::kSamplePeriod_s);
  }
}

template <typename Scalar>
Replies run_on_host(std::uint32_t periods, const Story& story) {
  auto station = std::make_unique<firmware::boards::PilStation<Scalar>>();
  for (const std::uint32_t error : station->configure(BoardUnits<Scalar>::parameters()).error)
    if (error != 0) throw std::runtime_error(fmt::format("the host build refuses the parameters: error {}", error));
  return run<Scalar>(
      periods, [&station](const firmware::boards::PilRequest& request) { return station->step(request); }, story);
}

template Replies run_on_host<float>(std::uint32_t, const Story&);
template Replies run_on_host<firmware::FixedPoint>(std::uint32_t, const Story&);

std::uint64_t hash(const Replies& replies) {
  std::uint64_t value = 0xCBF29CE484222325;
  for (const std::byte byte : std::as_bytes(std::span(replies))) {
    value ^= static_cast<std::uint64_t>(byte);
    value *= 0x100000001B3;
  }
  return value;
}

std::string first_difference(const Replies& expected, const Replies& seen) {
  if (expected.size() != seen.size()) return fmt::format("{} replies instead of {}", seen.size(), expected.size());
  for (std::size_t period = 0; period < expected.size(); ++period) {
    if (expected[period] == seen[period]) continue;
    constexpr std::size_t kWords = sizeof(firmware::boards::PilReply) / 4;
    const auto want = std::bit_cast<std::array<std::uint32_t, kWords>>(expected[period]);
    const auto have = std::bit_cast<std::array<std::uint32_t, kWords>>(seen[period]);
    for (std::size_t word = 0; word < kWords; ++word)
      if (want[word] != have[word])
        return fmt::format("period {}: word {} is {:#010x} instead of {:#010x}", period, word, have[word], want[word]);
  }
  return {};
}

}  // namespace target_test
