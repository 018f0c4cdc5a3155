#include "host/hil/contouring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr double kPaperRest_s = 0.4;  // as in the paper's Fig. 11

double worst_between(const std::vector<double>& t_s, const std::vector<double>& values, double begin_s, double end_s) {
  double worst = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (t_s[k] >= begin_s && t_s[k] <= end_s) worst = std::max(worst, std::abs(values[k]));
  return worst;
}

class ContourDriver {
 public:
  explicit ContourDriver(Machine& machine) : machine_(machine), recorder_(machine) {}

  void rest(double duration_s) {
    const auto samples = std::lround(duration_s / machine_.sample_period_s());
    for (long k = 0; k < samples; ++k) follow({0, 0});
  }

  void move_to(double x_mm, double y_mm) {
    const std::array<double, hal::kAxisCount> target_mm{x_mm, y_mm};
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      const auto counts = std::llround(target_mm[i] / machine_.plant(i).data().encoder_resolution);
      machine_.axes()[i].start(machine_.axes()[i].plan_move_to(firmware::CountPosition::at(counts)).plan);
    }
    do {
      machine_.step();
      check();
    } while (!machine_.axes()[0].is_at_rest() || !machine_.axes()[1].is_at_rest());
  }

  void follow(const std::array<firmware::Increment, hal::kAxisCount>& increments) {
    machine_.step_with(increments);
    check();
    recorder_.take();
  }

  const Recorder& recorder() const { return recorder_; }

 private:
  void check() const {
    for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
      const auto fault = machine_.axes()[i].fault();
      if (fault == firmware::AxisFault::none) continue;
      const auto& info = firmware::fault_info(fault);
      throw Failure(ExitCode::device_fault,
                    fmt::format("axis {} stopped: {} ({}); {}", kAxisNames[i], info.name, info.cause, info.remedy));
    }
  }

  Machine& machine_;
  Recorder recorder_;
};

}  // namespace

double ContouringRun::worst_tracking_um(std::size_t axis) const {
  return worst_between(t_s, tracking_um[axis], begin_s, end_s);
}
double ContouringRun::worst_contour_um() const { return worst_between(t_s, contour_um, begin_s, end_s); }

double ContouringRun::standing_before_um() const {
  const double settled_s = begin_s - kPaperRest_s / 2.0, last_s = begin_s - 0.01;
  return std::max(worst_between(t_s, tracking_um[0], settled_s, last_s),
                  worst_between(t_s, tracking_um[1], settled_s, last_s));
}
double ContouringRun::standing_after_um() const {
  const double settled_s = end_s + kPaperRest_s / 2.0;
  return std::max(worst_between(t_s, tracking_um[0], settled_s, t_s.back()),
                  worst_between(t_s, tracking_um[1], settled_s, t_s.back()));
}

ContouringRun run_contour(const std::array<MachineAxis, hal::kAxisCount>& axes, const Path& path,
                          const PathLimits& limits, std::uint64_t seed, double approach_mm) {
  Machine machine(axes, seed);
  machine.enable();
  ContourDriver driver(machine);
  driver.move_to(-approach_mm, approach_mm);
  driver.move_to(0.0, 0.0);
  driver.rest(kPaperRest_s);

  ContouringRun run;
  const std::array<double, 2> count_mm{axes[0].drive.data.encoder_resolution, axes[1].drive.data.encoder_resolution};
  run.begin_s = driver.recorder().record(0).t_s.back();
  for (const auto& increments : follow_path(path, limits, machine.sample_period_s(), count_mm))
    driver.follow(increments);
  run.end_s = driver.recorder().record(0).t_s.back();
  driver.rest(kPaperRest_s);

  const Recorder& recorder = driver.recorder();
  run.t_s = recorder.record(0).t_s;
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    run.records[i] = recorder.record(i);
    run.tracking_um[i] = recorder.tracking_error_um(i);
  }
  run.contour_um.reserve(run.t_s.size());
  for (std::size_t k = 0; k < run.t_s.size(); ++k) {
    const bool on_path = run.t_s[k] >= run.begin_s && run.t_s[k] <= run.end_s;
    const PlanePoint point{recorder.record(0).x[k] + count_mm[0] / 2.0, recorder.record(1).x[k] + count_mm[1] / 2.0};
    run.contour_um.push_back(on_path ? 1e3 * path.distance_to(point) : 0.0);
  }
  return run;
}

}  // namespace host
