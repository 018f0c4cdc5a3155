#include "host/external_plant/external_plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

class ExternalAxis : public sim::ForeignMotion {
 public:
  ExternalAxis(std::shared_ptr<ExternalPlant> plant, std::size_t index) : plant_(std::move(plant)), index_(index) {}

  void command(std::optional<double> u_V) override { plant_->commands_V_[index_] = u_V; }

  void advance(double duration_s) override {
    const double periods = duration_s / plant_->period_s_;
    const double whole = std::round(periods);
    if (!(whole >= 1.0) || std::abs(periods - whole) > 1e-6)
      throw Failure(ExitCode::bad_input,
                    fmt::format("the board's control period is {:g} s, the plant's lines are {:g} s apart: give the "
                                "board control.rate = {:g}, or the data sheet another sample_period_s",
                                duration_s, plant_->period_s_, std::round(1.0 / plant_->period_s_)));
    periods_ += static_cast<std::uint64_t>(whole);
    plant_->run_to(periods_);
  }

  sim::ForeignReading reading() const override { return plant_->readings_[index_]; }

 private:
  std::shared_ptr<ExternalPlant> plant_;
  std::size_t index_;
  std::uint64_t periods_ = 0;
};

ExternalPlant::ExternalPlant(const std::string& command, std::size_t axes, double period_s,
                             std::chrono::milliseconds patience)
    : program_(command), period_s_(period_s), patience_(patience), commands_V_(axes), readings_(axes, {0.0, 0.0}) {
  constexpr std::chrono::seconds kStart{30};  // interpreters load their libraries
  const std::string answer =
      program_.ask(plant_greeting(axes, period_s), std::max<std::chrono::milliseconds>(patience, kStart));
  if (answer != "ready" && answer != "ready\r")
    throw Failure(ExitCode::protocol, program_.complaint("does not answer axis-plant/1 with ready"));
}

std::shared_ptr<sim::ForeignMotion> ExternalPlant::axis(const std::shared_ptr<ExternalPlant>& plant,
                                                        std::size_t index) {
  return std::make_shared<ExternalAxis>(plant, index);
}

void ExternalPlant::run_to(std::uint64_t periods) {
  for (; periods_ < periods; ++periods_) {
    const std::string answer = program_.ask(plant_line(periods_, commands_V_), patience_);
    try {
      readings_ = parse_plant_answer(answer, periods_, commands_V_.size());
    } catch (const Failure& error) {
      throw Failure(error.code, program_.complaint(fmt::format("answers nonsense: {}", error.what())));
    }
  }
}

sim::DriveDescription data_sheet_alone(const sim::DriveDescription& drive) {
  sim::DriveDescription alone{drive.name, drive.data, {}};
  alone.effects.push_back({"inertia", {{"J", 1.0}}, {}, {}});
  return alone;
}

}  // namespace host
