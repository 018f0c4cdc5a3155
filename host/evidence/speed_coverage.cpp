#include "host/evidence/speed_coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace host {

namespace {

constexpr double kSlowest_mm_s = 0.5;
constexpr int kBinsPerDecade = 6;

/// A speed counts as constant if it changes by less than this part within a tenth of a second.
constexpr double kHeldWithin = 0.1;
constexpr double kHeldFor_s = 0.1;

std::size_t bin_of(double mm_s) {
  return static_cast<std::size_t>(std::max(0.0, kBinsPerDecade * std::log10(mm_s / kSlowest_mm_s)));
}

double low_end(std::size_t bin) { return kSlowest_mm_s * std::pow(10.0, static_cast<double>(bin) / kBinsPerDecade); }

}  // namespace

std::optional<SpeedGap> widest_speed_gap(const std::vector<const PreparedRecord*>& records,
                                         const sim::DataSheet& data) {
  const double mm_per_unit = data.kind == sim::DriveKind::rotary ? data.lead : 1e3;
  double top_mm_s = 0.0;
  for (const PreparedRecord* record : records)
    for (const double w : record->motion().w) top_mm_s = std::max(top_mm_s, mm_per_unit * std::abs(w));
  if (top_mm_s <= kSlowest_mm_s) return std::nullopt;
  std::vector<double> held_s(bin_of(top_mm_s) + 1, 0.0);
  for (const PreparedRecord* record : records) {
    const std::vector<double>& w = record->motion().w;
    const double period_s = record->period_s;
    const auto span = static_cast<std::size_t>(kHeldFor_s / period_s);
    for (std::size_t k = 0; k + span < w.size(); k += span) {
      const auto [low, high] = std::minmax_element(w.begin() + static_cast<std::ptrdiff_t>(k),
                                                   w.begin() + static_cast<std::ptrdiff_t>(k + span));
      const double mean_mm_s = 0.5 * mm_per_unit * std::abs(*low + *high);
      if (mm_per_unit * (*high - *low) > kHeldWithin * mean_mm_s || mean_mm_s < kSlowest_mm_s) continue;
      held_s[bin_of(mean_mm_s)] += kHeldFor_s;
    }
  }
  std::size_t begin = 0, widest_begin = 0, widest = 0;
  for (std::size_t bin = 0; bin < held_s.size(); ++bin) {
    if (held_s[bin] > 0.0) begin = bin + 1;
    if (bin + 1 - begin > widest) {
      widest = bin + 1 - begin;
      widest_begin = begin;
    }
  }
  const SpeedGap gap{low_end(widest_begin), std::min(low_end(widest_begin + widest), top_mm_s)};
  constexpr double kWorthSaying = 3.0;
  if (widest == 0 || gap.high_mm_s < kWorthSaying * gap.low_mm_s) return std::nullopt;
  return gap;
}

std::string speeds_to_record(const SpeedGap& gap) {
  return fmt::format(
      "No record holds a constant speed between {:.2g} and {:.2g} mm/s, so the shape of the friction curve there is "
      "uncertain. Record a few speeds in between, in both directions.",
      gap.low_mm_s, gap.high_mm_s);
}

}  // namespace host
