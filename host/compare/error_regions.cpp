#include "host/compare/error_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/compare/error_partition.hpp"
#include "host/compare/error_spectra.hpp"
#include "host/evidence/regime.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/record_origin.hpp"

namespace host {

namespace {

/// One predicted sample with the mean over its channels of (error/noise floor)^2.
struct ErrorRow {
  std::size_t record;
  std::size_t row;
  double square;
};

/// A step of 1, 2 or 5 times a power of ten that divides `span` into about `count` parts.
double round_step(double span, double count) {
  const double raw = span / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * 0.999) return factor * power;
  return 10.0 * power;
}

std::string number(double value) { return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value); }

/// Assigns a row to its bin of equal width. The names of the bins have round edges.
void add_to_bin(Partition& partition, double value, double step, double square,
                const std::function<std::pair<std::string, std::string>(const std::string&, const std::string&)>& name,
                long offset = 0) {
  const long bin = std::lround(std::floor(value / step));
  if (!partition.has(offset + bin)) {
    auto [region, words] = name(number(static_cast<double>(bin) * step), number(static_cast<double>(bin + 1) * step));
    partition.define(offset + bin, std::move(region), std::move(words));
  }
  partition.add(offset + bin, square);
}

std::vector<ErrorRow> rows_of(const sim::Drive& drive, const RecordSet& set) {
  std::vector<ErrorRow> rows;
  Prediction prediction;
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    const PreparedRecord& prepared = set.records[r].prepared;
    const ErrorFloor& floor = set.records[r].floor;
    predict(drive, prepared, prediction, set.stride);
    const double channels = (floor.x.empty() ? 0.0 : 1.0) + (floor.w.empty() ? 0.0 : 1.0);
    for (std::size_t index = 0; index < prepared.windows.size(); index += set.stride) {
      const Window& window = prepared.windows[index];
      for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k) {
        double square = 0.0;
        if (!floor.x.empty()) square += std::pow((prediction.x[k] - prepared.record->x[k]) / floor.x[index], 2);
        if (!floor.w.empty()) square += std::pow((prediction.w[k] - prepared.record->w[k]) / floor.w[index], 2);
        rows.push_back({r, k, square / channels});
      }
    }
  }
  return rows;
}

std::string regime_words(Regime regime, const sim::DataSheet& data) {
  switch (regime) {
    case Regime::standstill:
      return "while the axis stands";
    case Regime::reversal: {
      const double micrometres = reversal_travel(data) * (data.kind == sim::DriveKind::rotary ? 1e3 : 1e6);
      return fmt::format("in the first {:.0f} µm after a reversal", micrometres);
    }
    case Regime::low_speed:
      return "at low speed";
    case Regime::constant_speed:
      return "at constant speed";
    case Regime::acceleration:
      return "while the axis accelerates";
    case Regime::braking:
      return "while the axis brakes";
    case Regime::saturated_command:
      return "while the command is at its limit";
  }
  return {};
}

Partition by_regime(const std::vector<ErrorRow>& rows, const RecordSet& set, const sim::DataSheet& data) {
  Partition partition("regime");
  std::vector<std::vector<Regime>> regimes;
  for (const ComparedRecord& compared : set.records) regimes.push_back(regimes_of(compared.prepared, data));
  for (const Regime regime : kRegimes)
    partition.define(static_cast<long>(regime), std::string(regime_name(regime)), regime_words(regime, data));
  for (const ErrorRow& row : rows) partition.add(static_cast<long>(regimes[row.record][row.row]), row.square);
  return partition;
}

Partition by_direction(const std::vector<ErrorRow>& rows, const RecordSet& set) {
  Partition partition("direction");
  partition.define(0, "forward", "in forward motion");
  partition.define(1, "backward", "in backward motion");
  partition.define(2, "standing", "while the axis stands");
  for (const ErrorRow& row : rows) {
    const SmoothedMotion& motion = set.records[row.record].prepared.motion();
    const double w = motion.w[row.row];
    partition.add(motion.standing[row.row] || w == 0.0 ? 2 : w > 0.0 ? 0 : 1, row.square);
  }
  return partition;
}

Partition by_speed(const std::vector<ErrorRow>& rows, const RecordSet& set, const DriveUnits& units) {
  Partition partition("speed");
  double top = 0.0;
  for (const ComparedRecord& compared : set.records)
    for (const double w : compared.prepared.motion().w) top = std::max(top, std::abs(w));
  if (!(top > 0.0)) return partition;
  const double step = round_step(top, 12.0);
  for (const ErrorRow& row : rows)
    add_to_bin(partition, std::abs(set.records[row.record].prepared.motion().w[row.row]), step, row.square,
               [&](const std::string& from, const std::string& to) {
                 return std::pair(fmt::format("{}..{} {}", from, to, units.speed),
                                  fmt::format("at speeds between {} and {} {}", from, to, units.speed));
               });
  return partition;
}

Partition by_position(const std::vector<ErrorRow>& rows, const RecordSet& set, const DriveUnits& units) {
  Partition partition("position");
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const ComparedRecord& compared : set.records) {
    if (!compared.prepared.record->has_position()) return partition;
    const auto [least, most] = std::ranges::minmax_element(compared.prepared.motion().x);
    low = std::min(low, *least);
    high = std::max(high, *most);
  }
  if (!(high > low)) return partition;
  const double step = round_step(high - low, 12.0);
  for (const ErrorRow& row : rows)
    add_to_bin(partition, set.records[row.record].prepared.motion().x[row.row], step, row.square,
               [&](const std::string& from, const std::string& to) {
                 return std::pair(fmt::format("{}..{} {}", from, to, units.travel),
                                  fmt::format("between x = {} and {} {}", from, to, units.travel));
               });
  return partition;
}

/// The values with indices begin to end - 1.
struct Stretch {
  std::size_t begin = 0, end = 0;
};

/// The consecutive values with the largest sum (Kadane's algorithm); empty if no value is positive. A range from
/// `begin` may include k if `joins(begin, k)`.
template <typename Joins>
Stretch largest_stretch(const std::vector<double>& values, const Joins& joins) {
  Stretch best;
  double sum = 0.0, most = 0.0;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (sum <= 0.0 || !joins(begin, k)) {
      sum = 0.0;
      begin = k;
    }
    sum += values[k];
    if (sum > most) {
      most = sum;
      best = {begin, k + 1};
    }
  }
  return best;
}

/// The interval of travel with the most excess error, found in the same way as the interval of time in by_event. Left
/// out if it covers most of the travel.
Partition by_place(const std::vector<ErrorRow>& rows, const RecordSet& set, const DriveUnits& units) {
  constexpr std::size_t kBins = 200;
  Partition partition("place");
  std::vector<double> travel;
  for (const ErrorRow& row : rows) {
    const PreparedRecord& prepared = set.records[row.record].prepared;
    if (!prepared.record->has_position()) return partition;
    travel.push_back(prepared.motion().x[row.row]);
  }
  if (travel.empty()) return partition;
  const double low = std::ranges::min(travel), high = std::ranges::max(travel);
  if (!(high > low)) return partition;
  const double width = (high - low) / kBins;
  const auto bin_of = [&](double x) { return std::min(kBins - 1, static_cast<std::size_t>((x - low) / width)); };
  std::vector<double> excess(kBins);
  double mean = 0.0;
  for (const ErrorRow& row : rows) mean += std::sqrt(row.square) / static_cast<double>(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) excess[bin_of(travel[k])] += std::sqrt(rows[k].square) - 2.0 * mean;
  const Stretch worst = largest_stretch(excess, [](std::size_t, std::size_t) { return true; });
  if (worst.end == 0 || worst.end - worst.begin > kBins / 2) return partition;
  const double from = low + static_cast<double>(worst.begin) * width, to = low + static_cast<double>(worst.end) * width;
  const std::string span = fmt::format("x = {:.4g} to {:.4g} {}", from, to, units.travel);
  partition.define(0, span, "where the axis passes " + span);
  partition.define(1, "elsewhere", "everywhere but at " + span);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t bin = bin_of(travel[k]);
    partition.add(bin >= worst.begin && bin < worst.end ? 0 : 1, rows[k].square);
  }
  return partition;
}

Partition by_time(const std::vector<ErrorRow>& rows, const RecordSet& set) {
  Partition partition("time");
  double longest = 0.0;
  for (const ComparedRecord& compared : set.records)
    longest = std::max(longest, compared.prepared.record->t_s.back() - compared.prepared.record->t_s.front());
  const double step = round_step(longest, 12.0);
  constexpr long kRecordOffset = 1000;
  for (const ErrorRow& row : rows) {
    const PreparedRecord& prepared = set.records[row.record].prepared;
    add_to_bin(
        partition, prepared.record->t_s[row.row] - prepared.record->t_s.front(), step, row.square,
        [&](const std::string& from, const std::string& to) {
          return std::pair(
              fmt::format("{}..{} s of {}", from, to, file_name(*prepared.record)),
              fmt::format("from {} s to {} s after the start of {}", from, to, file_name(*prepared.record)));
        },
        kRecordOffset * static_cast<long>(row.record));
  }
  return partition;
}

/// Partition by the duration of the rest before a motion; only the start of the motion counts.
Partition by_rest(const std::vector<ErrorRow>& rows, const RecordSet& set) {
  constexpr double kStart_s = 0.2;  // the friction that has grown at rest is overcome in this time
  constexpr double kEdges_s[] = {0.0, 0.1, 0.3, 1.0, 3.0};
  Partition partition("rest");
  partition.define(0, "standing", "while the axis stands");
  partition.define(1, "in motion", "in motion, long after any rest");
  for (std::size_t edge = 0; edge < std::size(kEdges_s); ++edge) {
    const std::string span = edge + 1 < std::size(kEdges_s)
                                 ? fmt::format("{}..{} s", kEdges_s[edge], kEdges_s[edge + 1])
                                 : fmt::format("more than {} s", kEdges_s[edge]);
    partition.define(static_cast<long>(2 + edge), "after a rest of " + span, "when it starts after a rest of " + span);
  }
  std::vector<std::vector<long>> ranks;
  for (const ComparedRecord& compared : set.records) {
    const std::vector<bool>& standing = compared.prepared.motion().standing;
    std::vector<long> rank(standing.size(), 1);
    double rest_s = 0.0, moved_s = kStart_s;
    for (std::size_t k = 0; k < standing.size(); ++k) {
      if (standing[k]) {
        rest_s = moved_s > 0.0 ? compared.prepared.period_s : rest_s + compared.prepared.period_s;
        moved_s = 0.0;
        rank[k] = 0;
        continue;
      }
      moved_s += compared.prepared.period_s;
      if (rest_s <= 0.0 || moved_s > kStart_s) continue;
      const auto edge = std::ranges::upper_bound(kEdges_s, rest_s) - std::begin(kEdges_s);
      rank[k] = 1 + static_cast<long>(edge);
    }
    ranks.push_back(std::move(rank));
  }
  for (const ErrorRow& row : rows) partition.add(ranks[row.record][row.row], row.square);
  return partition;
}

/// The interval of time with the largest sum of excess error, where the excess of a window is its error over twice the
/// mean (Kadane's algorithm).
Partition by_event(const std::vector<ErrorRow>& rows, const RecordSet& set) {
  Partition partition("event");
  if (rows.empty()) return partition;
  double mean = 0.0;
  for (const ErrorRow& row : rows) mean += row.square / static_cast<double>(rows.size());
  std::vector<double> excess(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) excess[k] = rows[k].square - 2.0 * mean;
  const Stretch worst =
      largest_stretch(excess, [&](std::size_t begin, std::size_t k) { return rows[begin].record == rows[k].record; });
  if (worst.end == 0) return partition;
  const PreparedRecord& prepared = set.records[rows[worst.begin].record].prepared;
  const double from_s = prepared.record->t_s[rows[worst.begin].row];
  const double to_s = prepared.record->t_s[rows[worst.end - 1].row];
  const std::string span = fmt::format("t = {:.2f} s to {:.2f} s of {}", from_s, to_s, file_name(*prepared.record));
  partition.define(0, span, "from " + span);
  partition.define(1, "elsewhere", "everywhere but " + span);
  for (std::size_t k = 0; k < rows.size(); ++k)
    partition.add(k >= worst.begin && k < worst.end ? 0 : 1, rows[k].square);
  return partition;
}

}  // namespace

std::vector<ErrorRegion> error_regions(const sim::DriveDescription& model, const RecordSet& set) {
  const sim::Drive drive(model);
  const DriveUnits units = units_of(model.data.kind);
  const std::vector<ErrorRow> rows = rows_of(drive, set);
  std::vector<ErrorRegion> regions;
  by_regime(rows, set, model.data).append_to(regions);
  by_direction(rows, set).append_to(regions);
  by_speed(rows, set, units).append_to(regions);
  by_position(rows, set, units).append_to(regions);
  by_place(rows, set, units).append_to(regions);
  append_error_orders(model, set, regions);
  by_time(rows, set).append_to(regions);
  by_rest(rows, set).append_to(regions);
  error_by_frequency(drive, set).append_to(regions);
  by_event(rows, set).append_to(regions);
  return regions;
}

const ErrorRegion* worst_region(const std::vector<ErrorRegion>& regions) {
  constexpr double kLeastShare = 0.3;  // of the error; a smaller share does not locate the failure
  constexpr double kStretchShare = 0.5;
  constexpr double kEventPortion = 0.05;
  constexpr double kOrderPortion = 0.05;  // probability assumed for one line of a spectrum
  const ErrorRegion* worst = nullptr;
  double most = 0.0;
  for (const ErrorRegion& region : regions) {
    if (region.partition == "frequency") continue;  // errors grow over a window, so low frequencies always dominate
    const bool order = region.partition == "order";
    if (order ? region.region == "not periodic" : !(region.rms > 1.0)) continue;
    const double share = order ? region.share : region.prevalence;
    const double portion = order ? kOrderPortion : region.portion;
    // The interval is the best of all intervals, so it must contain most of the error; an interval of time must also be
    // short.
    if (region.partition == "event" && (share < kStretchShare || portion > kEventPortion)) continue;
    if (region.partition == "place" && share < kStretchShare) continue;
    if (share < kLeastShare || portion <= 0.0 || portion >= std::min(share, region.share)) continue;
    const double surprise = share * std::log(share / portion);
    if (surprise > most) {
      most = surprise;
      worst = &region;
    }
  }
  return worst;
}

std::string where_it_fails(const std::vector<ErrorRegion>& regions) {
  const ErrorRegion* worst = worst_region(regions);
  if (worst == nullptr) return "the error is spread evenly: no part of the motion stands out";
  if (worst->partition == "order")
    return fmt::format("the residual repeats {} ({:.0f} % of its square)", worst->words, 100.0 * worst->share);
  return fmt::format("the model fails {} ({:.0f} % of the squared error in {:.2g} % of the samples)", worst->words,
                     100.0 * worst->share, 100.0 * worst->portion);
}

nlohmann::json error_regions_json(const std::vector<ErrorRegion>& regions) {
  nlohmann::json rows = nlohmann::json::array();
  for (const ErrorRegion& region : regions) {
    nlohmann::json row = {
        {"partition", region.partition}, {"region", region.region}, {"share", region.share}, {"rms", region.rms}};
    if (region.partition != "order") row["portion"] = region.portion;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace host
