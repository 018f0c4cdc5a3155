#include "host/commission/estimator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/commission/following.hpp"
#include "host/response/loop_design.hpp"

namespace host {

namespace {

/// "35 % worse", "4 % better".
std::string compared(double value, double reference, const char* more, const char* less) {
  const double percent = 100.0 * (value / reference - 1.0);
  return fmt::format("{:.0f} % {}", std::abs(percent), percent > 0.0 ? more : less);
}

/// Why a value is not allowed; empty if it is.
std::string objection(const TrackingTest& test, const EstimatorDemand& demand) {
  if (!test.unusable_because.empty()) return "cannot be used";
  if (test.noise_V > demand.most_noise_V)
    return fmt::format("makes {:.2g} V of noise, and the limits leave room for {:.2g} V", test.noise_V,
                       demand.most_noise_V);
  if (!demand.force_N && is_softer(test.compliance, demand.first))
    return fmt::format("makes the axis {} than the first estimator",
                       compared(test.compliance.um_per_N, demand.first.um_per_N, "softer", "stiffer"));
  return {};
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

double deviation_um(double error_um, const Compliance& compliance, std::optional<double> force_N) {
  return std::hypot(error_um, compliance.um_per_N * force_N.value_or(0.0) / std::sqrt(2.0));
}

bool is_softer(const Compliance& one, const Compliance& other) {
  // Compliance falls at most with the square of the bandwidth.
  return one.um_per_N > kBandwidthStep * kBandwidthStep * other.um_per_N;
}

EstimatorChoice choose_estimator(const std::vector<TrackingTest>& tests, const EstimatorDemand& demand) {
  const auto deviation = [&](std::size_t i) {
    return deviation_um(tests[i].error_um, tests[i].compliance, demand.force_N);
  };
  std::vector<std::size_t> allowed;
  for (std::size_t i = 0; i < tests.size(); ++i)
    if (objection(tests[i], demand).empty()) allowed.push_back(i);
  EstimatorChoice choice;
  if (!allowed.empty()) {
    const std::size_t best = *std::ranges::min_element(allowed, {}, deviation);
    choice.value = *std::ranges::find_if(allowed, [&](std::size_t i) {
      return deviation(i) - deviation(best) <= std::max(tests[i].repeats_um, tests[best].repeats_um);
    });
  }
  choice.why = choice.value ? fmt::format("Rwd {:g} V² is chosen", tests[*choice.value].disturbance_variance)
                            : "No value is chosen";
  const char* separator = ": ";
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (i == choice.value || (choice.value && i + 1 != *choice.value && i != *choice.value + 1)) continue;
    std::string against = objection(tests[i], demand);
    if (against.empty())
      against = fmt::format("deviates {}{} with {} noise of the command",
                            compared(deviation(i), deviation(*choice.value), "more", "less"),
                            demand.force_N ? fmt::format(" under {:g} N", *demand.force_N) : "",
                            compared(tests[i].noise_V, tests[*choice.value].noise_V, "more", "less"));
    choice.why += fmt::format("{}{:g} V² {}", separator, tests[i].disturbance_variance, against);
    separator = ", ";
  }
  return choice;
}

nlohmann::json tracking_json(const std::vector<TrackingTest>& tests, const EstimatorDemand& demand,
                             const EstimatorChoice& choice) {
  nlohmann::json tried = nlohmann::json::array();
  for (const TrackingTest& test : tests) {
    const auto figure = [&](double value) {
      return test.unusable_because.empty() ? nlohmann::json(value) : nlohmann::json();
    };
    const auto designed = [&](double value) {
      return test.compliance.um_per_N > 0.0 ? nlohmann::json(value) : nlohmann::json();
    };
    tried.push_back({{"rwd_V2", test.disturbance_variance},
                     {"bandwidth_Hz", test.bandwidth_Hz},
                     {"observer_Hz", test.observer_Hz},
                     {"modulus", test.modulus ? nlohmann::json(*test.modulus) : nlohmann::json()},
                     {"rms_um", figure(test.error_um)},
                     {"repeats_um", figure(test.repeats_um)},
                     {"command_noise_V", figure(test.noise_V)},
                     {"compliance_um_N", designed(test.compliance.um_per_N)},
                     {"softest_at_Hz", designed(test.compliance.at_Hz)},
                     {"newton_per_V", designed(test.force.newton_per_V)},
                     {"force_band_N", designed(test.force.band_N)},
                     {"force_delay_s", designed(test.force.delay_s)},
                     {"deviation_um", figure(deviation_um(test.error_um, test.compliance, demand.force_N))},
                     {"unusable_because", test.unusable_because}});
  }
  return {{"tried", tried},
          {"chosen_V2", choice.value ? nlohmann::json(tests[*choice.value].disturbance_variance) : nlohmann::json()},
          {"first_compliance_um_N", demand.first.um_per_N},
          {"force_N", demand.force_N ? nlohmann::json(*demand.force_N) : nlohmann::json()},
          {"most_noise_V", demand.most_noise_V},
          {"why", choice.why}};
}

}  // namespace host
