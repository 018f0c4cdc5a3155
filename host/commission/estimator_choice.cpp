#include "host/commission/estimator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/commission/following.hpp"

namespace host {

namespace {

/// "35 % worse", "4 % better".
std::string compared(double value, double reference, const char* more, const char* less) {
  const double percent = 100.0 * (value / reference - 1.0);
  return fmt::format("{:.0f} % {}", std::abs(percent), percent > 0.0 ? more : less);
}

std::string neighbour(const TrackingTest& other, const TrackingTest& knee) {
  return fmt::format("{:g} V² follows {} with {} noise of the command", other.disturbance_variance,
                     compared(other.error_um, knee.error_um, "worse", "better"),
                     compared(other.noise_V, knee.noise_V, "more", "less"));
}

/// Whether the error falls from `calmer` to `next` by more than equal runs differ, and by a larger factor than that by
/// which the noise rises.
bool is_worth_its_noise(const TrackingTest& next, const TrackingTest& calmer) {
  const double repeatability_um = std::max(calmer.repeats_um, next.repeats_um);
  return calmer.error_um - next.error_um > repeatability_um &&
         next.error_um * next.noise_V < calmer.error_um * calmer.noise_V;
}

}  // namespace

double command_noise_V(const Record& once, const Record& again) {
  constexpr double kDeviationsPerMedian = 1.4826;  // of a normal distribution
  const MovingRows a = moving_rows(once), b = moving_rows(again);
  const std::size_t rows = std::min(a.end - a.begin, b.end - b.begin);
  std::vector<double> changes;
  for (std::size_t k = 0; k < rows; ++k) changes.push_back(std::abs(once.u_V[a.begin + k] - again.u_V[b.begin + k]));
  const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(rows / 2);
  std::ranges::nth_element(changes, middle);
  return kDeviationsPerMedian * *middle / std::sqrt(2.0);
}

EstimatorChoice choose_estimator(const std::vector<TrackingTest>& tests) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < tests.size(); ++i)
    if (tests[i].unusable_because.empty()) usable.push_back(i);
  if (usable.empty()) return {{}, "no value can be used on this machine"};
  std::size_t place = 0;
  while (place + 1 < usable.size() && is_worth_its_noise(tests[usable[place + 1]], tests[usable[place]])) ++place;
  const TrackingTest& knee = tests[usable[place]];
  std::string why = fmt::format("Rwd {:g} V² is the knee", knee.disturbance_variance);
  if (place > 0) why += ": " + neighbour(tests[usable[place - 1]], knee);
  if (place + 1 < usable.size()) why += (place > 0 ? ", " : ": ") + neighbour(tests[usable[place + 1]], knee);
  if (usable.size() == 1) why += ": no other value can be used";
  return {usable[place], why};
}

nlohmann::json tracking_json(const std::vector<TrackingTest>& tests, const EstimatorChoice& choice) {
  nlohmann::json tried = nlohmann::json::array();
  for (const TrackingTest& test : tests) {
    const auto figure = [&](double value) {
      return test.unusable_because.empty() ? nlohmann::json(value) : nlohmann::json();
    };
    tried.push_back({{"rwd_V2", test.disturbance_variance},
                     {"bandwidth_Hz", test.bandwidth_Hz},
                     {"observer_Hz", test.observer_Hz},
                     {"modulus", test.modulus ? nlohmann::json(*test.modulus) : nlohmann::json()},
                     {"rms_um", figure(test.error_um)},
                     {"repeats_um", figure(test.repeats_um)},
                     {"command_noise_V", figure(test.noise_V)},
                     {"unusable_because", test.unusable_because}});
  }
  return {{"tried", tried},
          {"chosen_V2", choice.knee ? nlohmann::json(tests[*choice.knee].disturbance_variance) : nlohmann::json()},
          {"why", choice.why}};
}

}  // namespace host
