#include "host/response/response_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/excitation/excitation_run.hpp"
#include "host/device/closed_loops.hpp"
#include "host/device/excitation_end.hpp"
#include "host/exit_codes.hpp"
#include "host/response/axis_controller.hpp"
#include "host/response/plant_fit.hpp"

namespace host {

namespace {

using Complex = std::complex<double>;

constexpr double kMostTo_Hz = 250.0;
constexpr double kRunPeriods = 2.0;  ///< of a run: in short runs the jog is fast, and friction varies between runs
constexpr double kRun = kRunPeriods + 1.4;  ///< periods, including fade-in and settling of the excitation
constexpr double kRunAndStop = kRun + 1.1;  ///< periods including the fade-out
constexpr double kShareOfBands = 0.6;       ///< of the time; the rest is for more lines around resonances
constexpr double kMostRealisations = 12.0;
constexpr double kRideOfBox = 0.45;      ///< speed of the jog relative to the box; excitation and noise add to it
constexpr double kAnswerOfRide = 0.5;    ///< peak speed of the response relative to the jog: the axis never reverses
constexpr double kAnswerOfWatch = 0.4;   ///< peak of its position as a part of the following-error limit; the response
                                         ///< may be twice that of the rigid model
constexpr double kStrokeShare = 0.85;    ///< of half the travel at which the board reverses
constexpr double kLinesPerOctave = 6.0;  ///< desired number
constexpr double kFullTurn = 2.0 * std::numbers::pi;

class BandPlanner {
 public:
  BandPlanner(const ResponsePlan& plan, const ExcitationScale& scale, const firmware::AxisParameters<float>& parameters)
      : plan_(plan), scale_(scale), parameters_(parameters), controller_(parameters) {
    period_ = std::exp2(std::round(std::log2(scale.rate_Hz)));
    period_s_ = period_ / scale.rate_Hz;
    run_s_ = kRunAndStop * period_s_;
    top_Hz_ = plan.to_Hz > 0.0 ? plan.to_Hz : std::min(kMostTo_Hz, scale.rate_Hz / 4.0);
    if (!(plan.from_Hz > 0.0) || !(top_Hz_ > plan.from_Hz) || top_Hz_ >= 0.45 * scale.rate_Hz)
      throw Failure(ExitCode::usage, fmt::format("from {:g} Hz to {:g} Hz is no range below 0.45 of the control rate",
                                                 plan.from_Hz, top_Hz_));
    if (plan.realisations < 2) throw Failure(ExitCode::usage, "at least two realisations of the phases are needed");
    if (!(parameters.drive.Bd2 > 0.0F) || !(scale.lead > 0.0))
      throw Failure(ExitCode::refused, "the axis has no controller yet: `axistool design`, then `set-params`");
  }

  std::vector<Excitation> bands() {
    const double octaves = std::log2(top_Hz_ / plan_.from_Hz);
    const double wanted = std::max(2.0, std::ceil(octaves * kLinesPerOctave / firmware::kExcitationEntries));
    const double bands = std::min(wanted, std::floor(plan_.box.time_s / least_s()));
    if (bands < 1.0) refuse_time();
    const double ratio = std::pow(top_Hz_ / plan_.from_Hz, 1.0 / bands);
    std::vector<std::pair<double, double>> ranges;
    for (double band = 0.0; band < bands; ++band)
      ranges.emplace_back(plan_.from_Hz * std::pow(ratio, band), plan_.from_Hz * std::pow(ratio, band + 1.0));
    return runs(ranges);
  }

  std::vector<Excitation> about(double f_Hz) {
    const double half = static_cast<double>(firmware::kExcitationEntries) / period_s_;  // odd lines are two apart
    if (plan_.box.time_s < least_s()) refuse_time();
    return runs({{std::max(0.5 * f_Hz, f_Hz - half), std::min(0.44 * scale_.rate_Hz, f_Hz + half)}});
  }

  double run_s() const { return run_s_; }
  /// Shortest time for one band.
  double least_s() const { return run_s_ * fewest(); }

 private:
  double fewest() const { return static_cast<double>(plan_.realisations); }

  [[noreturn]] void refuse_time() const {
    throw Failure(
        ExitCode::refused,
        fmt::format(
            "{:g} s of motion are too short for {} realisations with periods of {:g} s: one band needs at least {:g} s",
            plan_.box.time_s, plan_.realisations, period_s_, std::ceil(least_s())));
  }

  std::vector<Excitation> runs(const std::vector<std::pair<double, double>>& ranges) {
    const double affordable = std::floor(plan_.box.time_s / (static_cast<double>(ranges.size()) * run_s_));
    const double realisations = std::max(fewest(), std::min(kMostRealisations, affordable));
    const double ride = choose_ride(kRun * period_s_);
    std::vector<Excitation> made;
    for (const auto& [from, to] : ranges)
      for (double m = 0.0; m < realisations; ++m) {
        ExcitationLimits box = plan_.box;
        box.time_s = kRun * period_s_;
        const bool is_forward = made.size() % 2 == 0;
        ExcitationNumbers numbers;
        numbers.named = {{"from", from}, {"to", to}, {"period", period_}, {"ride", is_forward ? ride : -ride}};
        numbers.named["amplitude"] = amplitude(from, to, ride);
        made.push_back(design_excitation("multisine", numbers, box, scale_, "output",
                                         plan_.seed + static_cast<unsigned>(made.size())));
      }
    return made;
  }

  double stop(double speed) const {
    return speed * speed / (2.0 * scale_.acceleration) + speed * scale_.acceleration / (2.0 * scale_.jerk) +
           10.0 * speed / scale_.rate_Hz;
  }

  /// The highest jog speed that box and travel allow.
  double choose_ride(double run_s) const {
    const double room = kStrokeShare * plan_.box.travel / 2.0;
    double ride = kRideOfBox * plan_.box.speed;
    ride = std::min({ride, room / run_s, static_cast<double>(parameters_.velocity_limit)});
    for (int i = 0; i < 20 && ride * run_s + stop(ride) > room; ++i) ride *= 0.95;
    if (ride * scale_.lead > 0.0 && ride * run_s >= 50.0 * scale_.encoder_resolution) return ride;
    throw Failure(ExitCode::refused, fmt::format("travel = {:g} is too narrow for a jog of {:g} s: give a wider box",
                                                 plan_.box.travel, run_s));
  }

  /// Peak amplitude, V.
  double amplitude(double from, double to, double ride) const {
    constexpr int kPoints = 24;
    double speed_power = 0.0, position_power = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector2cd answer = answer_per_volt(from * std::pow(to / from, (i + 0.5) / kPoints));
      position_power += std::norm(answer(0)) / kPoints;
      speed_power += std::norm(answer(1)) / kPoints;
    }
    const double speed = ride / scale_.lead;
    const auto& watch = parameters_.monitors;
    const double allowed = static_cast<double>(watch.following_error_floor) +
                           static_cast<double>(watch.following_error_per_velocity) * speed;
    // RMS of one line, times its peak
    return plan_.share * std::min({plan_.box.volts, kAnswerOfRide * speed / std::sqrt(speed_power),
                                   kAnswerOfWatch * allowed / std::sqrt(position_power)});
  }

  /// Position and speed of the rigid axis in its loop, from the controller's output.
  Eigen::Vector2cd answer_per_volt(double f_Hz) const {
    const Complex z = std::polar(1.0, kFullTurn * f_Hz * static_cast<double>(parameters_.sample_period_s));
    const auto& drive = parameters_.drive;
    const Complex speed = static_cast<double>(drive.Bd2) / (z - static_cast<double>(drive.Ad22));
    const Complex position = (static_cast<double>(drive.Ad12) * speed + static_cast<double>(drive.Bd1)) / (z - 1.0);
    const Eigen::Vector2cd drive_answers(position, speed);
    return drive_answers * controller_.own_response(f_Hz) / (1.0 + (controller_.at(f_Hz) * drive_answers)(0));
  }

  const ResponsePlan& plan_;
  const ExcitationScale& scale_;
  const firmware::AxisParameters<float>& parameters_;
  AxisController controller_;
  double period_ = 0.0, period_s_ = 0.0, run_s_ = 0.0, top_Hz_ = 0.0;
};

}  // namespace

std::vector<Excitation> plan_response(const ResponsePlan& plan, const ExcitationScale& scale,
                                      const firmware::AxisParameters<float>& parameters) {
  return BandPlanner(plan, scale, parameters).bands();
}

std::vector<Excitation> plan_resonance(const ResponsePlan& plan, double f_Hz, const ExcitationScale& scale,
                                       const firmware::AxisParameters<float>& parameters) {
  return BandPlanner(plan, scale, parameters).about(f_Hz);
}

void make_response_runs(BoardClient& board, std::uint8_t axis, const std::vector<Excitation>& runs,
                        const firmware::ParameterValues& values, const ExcitationScale& scale,
                        const std::function<bool()>& stop, std::vector<Record>& records,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  const ClosedLoops loop(board, static_cast<std::uint8_t>(1u << axis));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ExcitationOutcome outcome = run_excitation(board, axis, runs[i], values, scale, stop);
    Record record = capture_record(outcome.capture, outcome.settings, std::string(firmware::kAxisNames.at(axis)));
    record.path = fmt::format("run {}", records.size() + 1);
    record.header["source"] = "axistool bode";
    record.header.insert(runs[i].header.begin(), runs[i].header.end());
    record.header["excitation_ended"] = std::string(end_name(outcome.state));
    require_completed(board, axis, outcome, fmt::format("run {} of {}", i + 1, runs.size()));
    records.push_back(std::move(record));
    if (progress) progress(i + 1, runs.size());
  }
}

void measure_axis(BoardClient& board, std::uint8_t axis, const ResponsePlan& plan,
                  const firmware::ParameterValues& values, const ExcitationScale& scale,
                  const std::function<bool()>& stop, std::vector<Record>& records,
                  const std::function<void(std::size_t, std::size_t)>& progress) {
  const firmware::AxisParameters<float> parameters = firmware::axis_parameters<float>(values.axis(axis));
  ResponsePlan part = plan;
  part.box.time_s = plan.box.time_s * kShareOfBands;
  const BandPlanner bands(part, scale, parameters);
  if (bands.least_s() > part.box.time_s) part.box.time_s = plan.box.time_s;
  const std::vector<Excitation> runs = plan_response(part, scale, parameters);
  const ClosedLoops loop(
      board, static_cast<std::uint8_t>(1u << axis));  // also during the analysis: opening the loop makes the axis ring
  make_response_runs(board, axis, runs, values, scale, stop, records, progress);
  double left_s = plan.box.time_s - bands.run_s() * static_cast<double>(runs.size());
  const PlantFit fit = fit_plant(frequency_response(records));
  for (const Resonance& mode : fit.resonances) {
    if (left_s < bands.least_s()) break;
    part.box.time_s = std::max(bands.least_s(), std::min(left_s, 0.5 * plan.box.time_s * kShareOfBands));
    part.seed += 1000;
    const std::vector<Excitation> closer = plan_resonance(part, mode.f_Hz.value, scale, parameters);
    make_response_runs(board, axis, closer, values, scale, stop, records, progress);
    left_s -= bands.run_s() * static_cast<double>(closer.size());
  }
}

}  // namespace host
