// The motion of a processor-in-the-loop run: the paper's two drives, simulated on this computer, and their commands.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "firmware/boards/pil/pil_station.hpp"
#include "firmware/core/fixed_units.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace target_test {

inline constexpr std::uint32_t kPeriods = 10'000;  // 10 s at 1 kHz

/// Parameters of both axes in the units that the scalar computes in, and a velocity in them.
template <typename Scalar>
struct BoardUnits {
  static typename firmware::boards::PilStation<Scalar>::Parameters parameters();
  static Scalar velocity(double mm_per_s);
};

/// Every part of the compensation, each large enough to show in the words.
template <typename Real>
firmware::CompensationParameters<Real> all_compensation() {
  firmware::CompensationParameters<Real> c;
  c.cogging_on = c.position_friction_on = true;
  c.cogging_V[0] = {Real(0.1), Real(-0.05), firmware::kOneCount / 1024};
  c.cogging_V[2] = {Real(0.02), Real(0.01), firmware::kOneCount / 341};
  c.position_friction = {Real(0.2), Real(0.1), firmware::kOneCount / 28'672};
  c.presliding = {true, Real(20), Real(0.3)};
  c.backlash = {true, 16 * firmware::kOneCount, 5 * firmware::kOneCount, 10};
  return c;
}

/// At 1 kHz: a notch at 150 Hz, damping 0.5, that leaves a fifth; a low-pass at 300 Hz, damping 0.7.
template <typename Real>
firmware::FilterParameters<Real> both_filters() {
  return {{{true, false, Real(0.56526), Real(0.288), Real(0.14674), Real(-0.8)},
           {true, true, Real(0.20741), Real(0.28548), Real(0.39293), Real(0)}}};
}

/// Between them, the two axes use every part of the control law; only the second compensates and filters.
template <typename Real>
firmware::AxisParameters<Real> with_all_parts(firmware::AxisParameters<Real> parameters, std::size_t axis) {
  parameters.friction_feedforward_on = true;
  parameters.zero_phase_feedforward_on = axis == 0;
  parameters.disturbance_cancellation_on = axis == 1;
  if (axis == 1) parameters.compensation = all_compensation<Real>();
  if (axis == 1) parameters.filters = both_filters<Real>();
  if (axis == 1)
    parameters.sequence = {
        .ready_input = true, .brake_fitted = true, .amplifier_wait = 5, .brake_release = 3, .brake_application = 4};
  return parameters;
}

template <>
struct BoardUnits<float> {
  static firmware::boards::PilStation<float>::Parameters parameters() {
    return {with_all_parts(firmware_test::parameters_of<float>(firmware_test::kPaperX), 0),
            with_all_parts(firmware_test::parameters_of<float>(firmware_test::kPaperY), 1)};
  }
  static float velocity(double mm_per_s) { return static_cast<float>(mm_per_s); }
};

template <>
struct BoardUnits<firmware::FixedPoint> {
  static firmware::boards::PilStation<firmware::FixedPoint>::Parameters parameters() {
    return {firmware::to_fixed(with_all_parts(firmware_test::parameters_of<double>(firmware_test::kPaperX), 0)),
            firmware::to_fixed(with_all_parts(firmware_test::parameters_of<double>(firmware_test::kPaperY), 1))};
  }
  static firmware::FixedPoint velocity(double mm_per_s) {
    return firmware::FixedPoint::from(mm_per_s * firmware_test::kSamplePeriod_s / firmware_test::kEncoderResolution_mm);
  }
};

/// One command at one period.
struct Order {
  std::uint32_t period;
  std::size_t axis;
  firmware::boards::PilCommand command;
  double argument;  ///< jog: mm/s; move: encoder counts
};

/// State of the lines from one period on, in the bits of PilAxisRequest::lines and PilRequest::board.
struct LineEvent {
  std::uint32_t period;
  std::array<std::uint32_t, 2> axis_lines;
  std::uint32_t board;
  std::uint32_t late_us = 0;  ///< by which this one period comes late
};

struct Story {
  std::uint32_t periods;
  std::vector<Order> orders;
  std::vector<LineEvent> lines;
};

/// Moves long and short, cut moves, jogs up to the velocity limit, reversals, disabling in motion: 10 s on both axes.
const Story& motion_story();

/// Faults: limit switch, late control, drive fault, emergency stop, low supply, amplifier not ready; cleared and
/// enabled again.
const Story& fault_story();

/// Two simulated drives behind the simulated board's connectors.
class Plants {
 public:
  Plants();

  /// The readings of this period, to be completed with commands.
  firmware::boards::PilRequest read(std::uint32_t period);
  /// Puts out the words, and lets one period pass.
  void apply(const firmware::boards::PilReply& reply);

 private:
  std::array<std::unique_ptr<sim::Plant>, 2> plant_;
  std::array<std::unique_ptr<hal::pc::SimulatedAxis>, 2> connector_;
};

template <typename Scalar>
void add_orders(const Story& story, firmware::boards::PilRequest& request) {
  using firmware::boards::PilCommand;
  for (const LineEvent& event : story.lines) {
    if (event.period > request.number) continue;
    request.board = event.board;
    for (std::size_t i = 0; i < 2; ++i) request.axis[i].lines = event.axis_lines[i];
    request.now_us += event.late_us;
  }
  for (const Order& order : story.orders) {
    if (order.period != request.number) continue;
    firmware::boards::PilAxisRequest& axis = request.axis[order.axis];
    axis.command = order.command;
    if (order.command == PilCommand::jog)
      axis.operand_low = std::bit_cast<std::uint32_t>(BoardUnits<Scalar>::velocity(order.argument));
    if (order.command == PilCommand::move) {
      const auto target = static_cast<std::uint64_t>(static_cast<std::int64_t>(order.argument));
      axis.operand_low = static_cast<std::uint32_t>(target);
      axis.operand_high = static_cast<std::uint32_t>(target >> 32);
    }
  }
}

using Replies = std::vector<firmware::boards::PilReply>;

/// Closes the loop for this many periods: `exchange` replaces the board.
template <typename Scalar, typename Exchange>
Replies run(std::uint32_t periods, Exchange&& exchange, const Story& story = motion_story()) {
  Plants plants;
  Replies replies;
  replies.reserve(periods);
  for (std::uint32_t period = 0; period < periods; ++period) {
    firmware::boards::PilRequest request = plants.read(period);
    add_orders<Scalar>(story, request);
    replies.push_back(exchange(request));
    plants.apply(replies.back());
  }
  return replies;
}

/// The same run with the control core built for this computer. Throws if it refuses the parameters.
template <typename Scalar>
Replies run_on_host(std::uint32_t periods = kPeriods, const Story& story = motion_story());

/// FNV-1a, 64 bits, over every bit of every reply.
std::uint64_t hash(const Replies& replies);

/// The first reply that differs, in words; empty if none does.
std::string first_difference(const Replies& expected, const Replies& seen);

}  // namespace target_test
