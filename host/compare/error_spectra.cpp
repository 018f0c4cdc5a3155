#include "host/compare/error_spectra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/compare/effort_residual.hpp"
#include "host/evidence/period_search.hpp"
#include "host/fourier.hpp"
#include "host/report/text_format.hpp"

namespace host {

Partition error_by_frequency(const sim::Drive& drive, const RecordSet& set) {
  constexpr double kEdges_Hz[] = {0.0, 15.0, 35.0, 75.0, 150.0, 300.0};
  Partition partition("frequency");
  for (std::size_t band = 0; band < std::size(kEdges_Hz); ++band) {
    const std::string span = band + 1 < std::size(kEdges_Hz)
                                 ? fmt::format("{:g}..{:g} Hz", kEdges_Hz[band], kEdges_Hz[band + 1])
                                 : fmt::format("above {:g} Hz", kEdges_Hz[band]);
    partition.define(static_cast<long>(band), span, "at frequencies " + span);
  }
  Prediction prediction;
  std::vector<double> error;
  for (const ComparedRecord& compared : set.records) {
    const PreparedRecord& prepared = compared.prepared;
    const ErrorFloor& floor = compared.floor;
    predict(drive, prepared, prediction, set.stride);
    for (std::size_t index = 0; index < prepared.windows.size(); index += set.stride) {
      const Window& window = prepared.windows[index];
      const std::size_t n = window.length;
      const auto spread = [&](const std::vector<double>& predicted, const std::vector<double>& measured, double unit) {
        error.resize(n);
        for (std::size_t k = 0; k < n; ++k)
          error[k] = (predicted[window.begin + 1 + k] - measured[window.begin + 1 + k]) / unit;
        const std::vector<std::complex<double>> lines = spectrum_of(error);
        for (std::size_t line = 0; line < lines.size(); ++line) {
          const double twice = line == 0 || 2 * line == n ? 1.0 : 2.0;  // includes the line of the negative frequency
          const double frequency_Hz = static_cast<double>(line) / (static_cast<double>(n) * prepared.period_s);
          const auto band = std::ranges::upper_bound(kEdges_Hz, frequency_Hz) - std::begin(kEdges_Hz) - 1;
          partition.add(static_cast<long>(band), twice * std::norm(lines[line]) / static_cast<double>(n), twice);
        }
      };
      if (!floor.x.empty()) spread(prediction.x, prepared.record->x, floor.x[index]);
      if (!floor.w.empty()) spread(prediction.w, prepared.record->w, floor.w[index]);
    }
  }
  return partition;
}

void append_error_orders(const sim::DriveDescription& model, const RecordSet& set, std::vector<ErrorRegion>& regions) {
  constexpr std::size_t kMostOrders = 4;
  constexpr double kLeastShare = 0.02;
  constexpr double kStepsAPeriod = 40.0;    // shorter periods come from encoder steps
  constexpr double kPeriodsOfTravel = 3.0;  // fewer periods are a trend
  constexpr double kLinesOfTravel = 2000.0;
  constexpr std::size_t kStride = 2;
  TravelSignal signal;
  for (const ComparedRecord& compared : set.records) {
    if (!compared.prepared.record->has_position()) return;
    const ResidualSamples samples = residual_samples(model, compared.prepared, kStride);
    signal.x.insert(signal.x.end(), samples.x.begin(), samples.x.end());
    signal.value.insert(signal.value.end(), samples.missing.begin(), samples.missing.end());
  }
  constexpr std::size_t kFewest = 100;
  if (signal.x.size() < kFewest) return;
  signal.weight.assign(signal.x.size(), 1.0);
  const auto [low, high] = std::ranges::minmax_element(signal.x);
  const double travel = *high - *low;
  if (!(travel > 0.0)) return;
  double square = 0.0;
  for (const double missing : signal.value) square += missing * missing / static_cast<double>(signal.value.size());
  if (!(square > 0.0)) return;
  const double shortest = std::max(kStepsAPeriod * model.data.encoder_resolution, travel / kLinesOfTravel);
  const double longest = travel / kPeriodsOfTravel;
  if (!(longest > shortest)) return;
  const double turn = 2.0 * std::numbers::pi * model.data.lead;
  double left = 1.0;
  for (const PeriodPeak& peak : find_periods(signal, shortest, longest, kMostOrders)) {
    const double share = std::min(peak.share, left);
    if (share < kLeastShare) continue;
    left -= share;
    const bool rotary = model.data.kind == sim::DriveKind::rotary;
    const std::string region = rotary ? fmt::format("order {:.2f}", turn / peak.period)
                                      : fmt::format("period {} m", format_value(peak.period, 4));
    const std::string words = rotary ? fmt::format("{:.2f} times a turn (every {} mm of travel)", turn / peak.period,
                                                   format_value(peak.period, 4))
                                     : fmt::format("every {} mm of travel", format_value(1000.0 * peak.period, 4));
    regions.push_back({"order", region, words, share, 0.0, std::sqrt(share * square)});
  }
  regions.push_back(
      {"order", "not periodic", "without a period along the travel", left, 0.0, std::sqrt(left * square)});
}

}  // namespace host
