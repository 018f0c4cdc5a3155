#include "host/axes/circle_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/axes/circle_figures.hpp"
#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/infer/evidence.hpp"
#include "host/infer/posterior.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using std::numbers::pi;
constexpr int kHats = 8;  ///< hat functions of the memory over the angle
constexpr double kUsualMemory_um = 5.0;
constexpr double kPlace_um = 1000.0;  ///< prior standard deviation of centre and radius
constexpr double kLeastNoise = 0.2;   ///< lower limit of the noise, relative to the rows' nominal noise of 1
constexpr double kCauseOdds = 0.25;   ///< prior probability of a cause
constexpr std::size_t kMostCauses = 10, kTried = 3;
constexpr double kWorthTrying = -3.0;  ///< smallest gain with which a cause is tried, nats
constexpr double kHopeless = 15.0;     ///< nats below the total: not an alternative
constexpr double kWorthSaying = 0.02;  ///< smallest probability of a reported alternative cause

using Causes = std::vector<CircleCause>;

bool is_friction(const CircleCause& one) { return one.kind == "reversal_spike" || one.kind == "stick_slip"; }

std::vector<RowRun> runs_of(const CircleRows& rows) {
  std::vector<RowRun> runs;
  for (const CircleBlock& block : rows.blocks()) runs.push_back({block.first, block.end});
  return runs;
}

/// Smooth functions of the angle for each sensor, once equal and once opposite in both directions, orthogonal to centre
/// and radius.
Memory memory_of(const CircleRows& rows, const MatrixXd& places) {
  Memory memory;
  memory.usual = kUsualMemory_um;
  memory.columns.resize(rows.deviation().size(), 0);
  const auto add = [&](bool is_outer, bool turns_over, const char* name) {
    MatrixXd hats = MatrixXd::Zero(rows.deviation().size(), kHats);
    for (const CircleBlock& block : rows.blocks()) {
      if (block.is_outer != is_outer) continue;
      const double factor = block.weight * (turns_over ? rows.passes()[block.pass].direction() : 1.0);
      for (Index row = block.first; row < block.end; ++row) {
        double at = rows.angle_rad()(row) / (2.0 * pi) * kHats;
        at -= kHats * std::floor(at / kHats);
        const auto left = static_cast<Index>(at) % kHats;
        const double part = at - std::floor(at);
        hats(row, left) = factor * (1.0 - part);
        hats(row, (left + 1) % kHats) = factor * part;
      }
    }
    hats -= places * symmetric_solution(gram(places), MatrixXd(places.transpose() * hats));
    memory.groups.push_back({name, memory.columns.cols(), kHats});
    MatrixXd all(hats.rows(), memory.columns.cols() + kHats);
    all << memory.columns, hats;
    memory.columns = all;
  };
  const bool both = std::ranges::any_of(rows.passes(), &CirclePass::is_ccw) &&
                    !std::ranges::all_of(rows.passes(), &CirclePass::is_ccw);
  for (const bool is_outer : {false, true}) {
    if (is_outer && !rows.has_outer()) continue;
    add(is_outer, false, "angle");
    if (both) add(is_outer, true, "angle by direction");
  }
  return memory;
}

/// Columns for centre and radius of every pass and sensor.
MatrixXd places_of(const CircleRows& rows) {
  MatrixXd places = MatrixXd::Zero(rows.deviation().size(), 3 * static_cast<Index>(rows.blocks().size()));
  Index at = 0;
  for (const CircleBlock& block : rows.blocks()) {
    for (Index row = block.first; row < block.end; ++row) {
      const double angle = rows.angle_rad()(row);
      places.block<1, 3>(row, at) << block.weight, block.weight * std::cos(angle), block.weight * std::sin(angle);
    }
    at += 3;
  }
  return places;
}

class CircleSearch {
 public:
  explicit CircleSearch(const CircleRows& rows)
      : rows_(rows),
        places_(places_of(rows)),
        plain_(plain_causes(rows)),
        bare_(rows.deviation(), runs_of(rows), bare_memory(rows), kLeastNoise),
        full_(rows.deviation(), runs_of(rows), memory_of(rows, places_), kLeastNoise) {}

  struct Result {
    Causes causes;
    EvidenceFit fit;
    std::vector<double> probability;
    std::vector<std::vector<std::pair<std::string, double>>> instead;
    Causes best;  ///< most probable of all sets that were tried
    EvidenceFit best_fit;
  };

  Result run() const {
    const Causes first = forward();
    Result result = judged(first, full_.fit(columns(first), deviations(first)));
    for (int round = 0; round < 4 && std::ranges::any_of(result.probability, [](double p) { return p <= 0.5; });
         ++round) {
      const Causes causes = result.best;
      EvidenceFit near = again(result.best_fit, causes), anew = full_.fit(columns(causes), deviations(causes));
      result = judged(causes, near.log_evidence > anew.log_evidence ? near : anew);
    }
    return result;
  }

 private:
  static Memory bare_memory(const CircleRows& rows) {
    Memory none;
    none.columns.resize(rows.deviation().size(), 0);
    return none;
  }

 public:
  MatrixXd columns(const Causes& causes) const {
    Index count = places_.cols();
    for (const CircleCause& one : causes) count += one.columns.cols();
    MatrixXd all(places_.rows(), count);
    all.leftCols(places_.cols()) = places_;
    Index at = places_.cols();
    for (const CircleCause& one : causes) {
      all.middleCols(at, one.columns.cols()) = one.columns;
      at += one.columns.cols();
    }
    return all;
  }
  VectorXd deviations(const Causes& causes) const {
    VectorXd all = VectorXd::Constant(columns_before(causes, causes.size()), kPlace_um);
    for (std::size_t i = 0; i < causes.size(); ++i)
      all.segment(columns_before(causes, i), causes[i].columns.cols()) = causes[i].deviations;
    return all;
  }
  /// Number of columns before this cause.
  Index columns_before(const Causes& causes, std::size_t at) const {
    Index count = places_.cols();
    for (std::size_t i = 0; i < at; ++i) count += causes[i].columns.cols();
    return count;
  }

 private:
  static double prior(const Causes& causes) {
    double sum = 0.0;
    for (const CircleCause& one : causes) sum += one.log_prior + std::log(kCauseOdds);
    return sum;
  }

  static bool is_wave(const CircleCause& one) { return one.period_mm || one.frequency_Hz; }

  /// Whether one contains the other: an axis that sticks has its reversal spikes by the same friction.
  static bool overlap(const CircleCause& a, const CircleCause& b) {
    return is_same(a, b) || (a.axis == b.axis && is_friction(a) && is_friction(b));
  }

  static bool is_same(const CircleCause& a, const CircleCause& b) {
    if (a.kind != b.kind || a.axis != b.axis) return false;
    const auto near = [](const std::optional<double>& one, const std::optional<double>& other) {
      return !one || !other || std::abs(*one - *other) < 0.1 * *other;
    };
    return near(a.period_mm, b.period_mm) && near(a.frequency_Hz, b.frequency_Hz);
  }

  /// All causes that could be added to `causes`, with their gain, the best first.
  std::vector<std::pair<double, CircleCause>> promising(const Evidence& evidence, const EvidenceFit& fit,
                                                        const Causes& causes, bool with_waves) const {
    std::vector<std::pair<double, CircleCause>> list;
    const auto add = [&](const CircleCause& one) {
      if (std::ranges::any_of(causes, [&](const CircleCause& has) { return overlap(has, one); })) return;
      const MatrixXd scaled = one.columns * one.deviations.asDiagonal();
      const std::vector<int> sign(static_cast<std::size_t>(scaled.cols()), 0);
      const double gain =
          evidence.gains(fit, scaled, sign, VectorXd::Ones(1))(0) + one.log_prior + std::log(kCauseOdds);
      if (gain > kWorthTrying) list.emplace_back(gain, one);
    };
    for (const CircleCause& one : plain_) add(one);
    const VectorXd left = rows_.deviation() - columns(causes) * fit.factors - fit.remembered;
    for (const char axis : {'x', 'y'}) {
      if (!with_waves) break;
      if (rows_.has_outer()) add(best_wave(rows_, left, WaveKind::cyclic_error, axis));
      const CircleCause ripple = best_wave(rows_, left, WaveKind::torque_ripple, axis);
      add(ripple);
      add(ripple_through_any_loop(rows_, axis, *ripple.period_mm));
      add(best_wave(rows_, left, WaveKind::vibration, axis));
    }
    std::ranges::stable_sort(list, [](const auto& a, const auto& b) { return a.first > b.first; });
    // Only the best of each kind.
    Causes seen;
    std::erase_if(list, [&](const auto& entry) {
      if (std::ranges::any_of(seen, [&](const CircleCause& one) {
            return one.kind == entry.second.kind && one.axis == entry.second.axis;
          }))
        return true;
      seen.push_back(entry.second);
      return false;
    });
    // Those that overlap a tried one are tried too: their gains at the same noise say little about which is better.
    std::vector<std::pair<double, CircleCause>> tried;
    for (const auto& entry : list)
      if (tried.size() < kTried ||
          std::ranges::any_of(tried, [&](const auto& one) { return overlap(one.second, entry.second); }))
        tried.push_back(entry);
    return tried;
  }

  /// Chooses the form of each axis' friction again. It was chosen with the noise of a fit without this friction, at
  /// which forms with few columns win.
  void reshape(Causes& causes, EvidenceFit& fit) const {
    for (std::size_t i = 0; i < causes.size(); ++i) {
      if (!is_friction(causes[i])) continue;
      double best = fit.log_evidence + prior(causes);
      for (const CircleCause& form : plain_) {
        if (!is_same(form, causes[i])) continue;
        Causes other = causes;
        other[i] = form;
        EvidenceFit tried =
            bare_.fit(columns(other), deviations(other),
                      {.colour = fit.colour, .sizes = bare_.no_memory(), .give_up = best - prior(other)});
        if (tried.log_evidence + prior(other) <= best) continue;
        best = tried.log_evidence + prior(other);
        causes = other;
        fit = std::move(tried);
      }
    }
  }

  /// Refines each wave's period or frequency, and the way through each gap, together with all other causes.
  void refine(Causes& causes, const EvidenceFit& fit) const {
    for (std::size_t i = 0; i < causes.size(); ++i) {
      if (causes[i].kind == "backlash")
        if (const double gap_um = fit.factors(columns_before(causes, i)); gap_um > 0.0)
          causes[i] = backlash_cause(rows_, causes[i].axis.front(), gap_um);
      if (!is_wave(causes[i])) continue;
      const VectorXd others =
          columns(causes) * fit.factors -
          causes[i].columns * fit.factors.segment(columns_before(causes, i), causes[i].columns.cols());
      causes[i] = nearby_wave(rows_, rows_.deviation() - others, causes[i]);
    }
  }

  /// Forward selection: adds causes one by one while each gains. Uses no memory, which would absorb them.
  Causes forward() const {
    Causes causes;
    EvidenceFit fit =
        bare_.fit(columns(causes), deviations(causes), {.colour = {.drift = 0.5}, .sizes = bare_.no_memory()});
    while (causes.size() < kMostCauses) {
      double best = fit.log_evidence + prior(causes);
      std::optional<Causes> next;
      EvidenceFit next_fit;
      for (const auto& [gain, one] : promising(bare_, fit, causes, true)) {
        Causes more = causes;
        more.push_back(one);
        EvidenceFit tried =
            bare_.fit(columns(more), deviations(more), {.colour = fit.colour, .sizes = bare_.no_memory()});
        if (tried.log_evidence + prior(more) <= best) continue;
        best = tried.log_evidence + prior(more);
        next = more;
        next_fit = std::move(tried);
      }
      if (!next) break;
      causes = *next;
      reshape(causes, next_fit);
      refine(causes, next_fit);
      fit = bare_.fit(columns(causes), deviations(causes), {.colour = next_fit.colour, .sizes = bare_.no_memory()});
    }
    return causes;
  }

  EvidenceFit again(const EvidenceFit& near, const Causes& causes) const {
    return full_.fit(columns(causes), deviations(causes), {.colour = near.colour, .sizes = near.sizes});
  }

  /// Probability of each cause against no cause and against its alternatives, with the memory.
  Result judged(const Causes& causes, const EvidenceFit& fit) const {
    Result result{causes, fit, {}, {}, causes, fit};
    const double all = result.fit.log_evidence + prior(causes);
    double best = all;
    for (std::size_t i = 0; i < causes.size(); ++i) {
      Causes rest = causes;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      const EvidenceFit without = again(result.fit, rest);
      std::vector<double> logs = {all, without.log_evidence + prior(rest)};
      std::vector<std::string> names = {"", "nothing"};
      std::vector<Causes> sets = {causes, rest};
      std::vector<EvidenceFit> fits = {result.fit, without};
      for (const auto& [gain, one] : promising(full_, without, rest, false)) {
        const bool is_hopeless = without.log_evidence + prior(rest) + gain < all - kHopeless;
        if (is_same(one, causes[i]) || (is_hopeless && !overlap(one, causes[i]))) continue;
        Causes other = rest;
        other.push_back(one);
        fits.push_back(again(without, other));
        logs.push_back(fits.back().log_evidence + prior(other));
        names.push_back(one.kind + " " + one.axis);
        sets.push_back(other);
      }
      const std::vector<double> probable = posterior(logs);
      result.probability.push_back(probable[0]);
      result.instead.emplace_back();
      for (std::size_t k = 1; k < logs.size(); ++k) {
        if (probable[k] > kWorthSaying) result.instead.back().emplace_back(names[k], probable[k]);
        if (logs[k] <= best) continue;
        best = logs[k];
        result.best = sets[k];
        result.best_fit = fits[k];
      }
    }
    return result;
  }

  const CircleRows& rows_;
  MatrixXd places_;
  Causes plain_;
  Evidence bare_, full_;
};

/// The signatures at every sample of every pass.
MatrixXd at_samples(const std::vector<CirclePass>& passes, const CircleCause& cause) {
  Index count = 0;
  for (const CirclePass& pass : passes) count += static_cast<Index>(pass.t_s.size());
  MatrixXd all(count, cause.columns.cols());
  for (Index c = 0; c < all.cols(); ++c) {
    Index row = 0;
    for (const CirclePass& pass : passes)
      for (std::size_t k = 0; k < pass.t_s.size(); ++k)
        all(row++, c) = cause.signatures[static_cast<std::size_t>(c)](pass, k);
  }
  return all;
}

double range_of(const VectorXd& values) { return values.maxCoeff() - values.minCoeff(); }

/// Size of a cause: the amplitude of a wave, the largest value of a spike, else its factor.
double amount_of(const CircleCause& cause, const VectorXd& factors, double um) {
  if (cause.period_mm || cause.frequency_Hz) return 0.5 * um;
  if (is_friction(cause)) return um;
  return factors(0) * cause.amount_per_um;
}

/// Mean residual, um, where a cause contributes most, less that where it contributes least: the error of its size by a
/// shape that differs from its signatures. The noise of the rows does not contain it, because it repeats at each turn.
/// `share`, `residual`: rows, um.
double shape_error_um(const CircleRows& rows, const CircleCause& cause, const VectorXd& share,
                      const VectorXd& residual) {
  constexpr double kEnd = 0.03;  // of the range, counted as most and least
  const double least = share.minCoeff(), most = share.maxCoeff();
  double error = 0.0;
  for (const bool is_most : {true, false}) {
    double sum = 0.0, weight = 0.0;
    for (const CircleBlock& block : rows.blocks()) {
      if (cause.outer_only && !block.is_outer) continue;
      for (Index row = block.first; row < block.end; ++row) {
        if ((is_most ? most - share(row) : share(row) - least) > kEnd * (most - least)) continue;
        sum += block.weight * block.weight * residual(row);
        weight += block.weight * block.weight;
      }
    }
    if (weight > 0.0) error += (is_most ? 1.0 : -1.0) * sum / weight;
  }
  return error;
}

/// What the rows leave open of a spike's height: its form is known only from row to row, and a straight line between
/// them is off by an eighth of the second difference. `share`: rows, um.
double spike_height_error_um(const CircleRows& rows, const VectorXd& share) {
  Index top = 0;
  share.cwiseAbs().maxCoeff(&top);
  for (const CircleBlock& block : rows.blocks())
    if (top > block.first && top + 1 < block.end)
      return std::abs(share(top - 1) - 2.0 * share(top) + share(top + 1)) / 8.0;
  return 0.0;
}

CircleFinding finding_of(const CircleRows& rows, const CircleSearch& search, const CircleSearch::Result& result,
                         std::size_t at, double rest_um, const VectorXd& residual_um) {
  CircleFinding found{result.causes[at], {}, 0.0, {}, 0.0, {}, result.probability[at], result.instead[at]};
  const Index first = search.columns_before(result.causes, at), count = found.cause.columns.cols();
  found.factors = result.fit.factors.segment(first, count);
  const MatrixXd samples = at_samples(rows.passes(), found.cause);
  const auto range = [&](const VectorXd& factors) { return range_of(samples * factors); };
  found.um = range(found.factors);
  found.amount = amount_of(found.cause, found.factors, found.um);
  // Covariance of the factors, and the slope of the range.
  MatrixXd picked = MatrixXd::Zero(result.fit.information.rows(), count);
  picked.middleRows(first, count).setIdentity();
  MatrixXd covariance = result.fit.information.solve(picked).middleRows(first, count);
  covariance = found.cause.deviations.asDiagonal() * covariance * found.cause.deviations.asDiagonal();
  VectorXd slope(count);
  for (Index c = 0; c < count; ++c) {
    const double step = std::max(std::sqrt(covariance(c, c)), 1e-6);
    VectorXd moved = found.factors;
    moved(c) += step;
    const double up = range(moved);
    moved(c) -= 2.0 * step;
    slope(c) = (up - range(moved)) / (2.0 * step);
  }
  const VectorXd share = (found.cause.columns * found.factors).cwiseQuotient(rows.weights());
  double variance = slope.dot(covariance * slope) + rest_um * rest_um +
                    std::pow(shape_error_um(rows, found.cause, share, residual_um), 2);
  if (is_friction(found.cause)) variance += std::pow(spike_height_error_um(rows, share), 2);
  const double reach = kNormal95 * std::sqrt(std::max(0.0, variance));
  found.ci95 = {std::max(0.0, found.um - reach), found.um + reach};
  return found;
}

/// Limit below which a cause is minor: one encoder step if no outer sensor measures it, or a twentieth of the total
/// deviation.
double least_um(const std::vector<CirclePass>& passes) {
  constexpr double kMinorShare = 0.05;
  double deviation = 0.0, step = 0.0;
  for (const CircleFigures& one : circle_figures(passes)) deviation = std::max(deviation, one.G_um);
  if (const auto both = bidirectional_figures(passes)) deviation = std::max(deviation, both->Gb_um);
  for (const CirclePass& pass : passes)
    if (pass.outer_um.empty()) step = std::max(step, pass.count_um);
  return std::max(kMinorShare * deviation, step);
}

}  // namespace

CircleDiagnosis diagnose_circle(std::vector<CirclePass> passes) {
  CircleDiagnosis diagnosis;
  diagnosis.passes = std::move(passes);
  const CircleRows rows(diagnosis.passes);
  const CircleSearch search(rows);
  const CircleSearch::Result result = search.run();
  const VectorXd rest = result.fit.remembered.cwiseQuotient(rows.weights());
  diagnosis.rest_um = std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size()));
  const VectorXd residual_um =
      (rows.deviation() - search.columns(result.causes) * result.fit.factors).cwiseQuotient(rows.weights());
  for (std::size_t i = 0; i < result.causes.size(); ++i) {
    CircleFinding found = finding_of(rows, search, result, i, diagnosis.rest_um, residual_um);
    if (found.probability <= 0.5) continue;
    (found.um < least_um(diagnosis.passes) ? diagnosis.minor : diagnosis.causes).push_back(std::move(found));
  }
  for (auto* const list : {&diagnosis.causes, &diagnosis.minor})
    std::ranges::stable_sort(*list, [](const auto& a, const auto& b) { return a.um > b.um; });
  diagnosis.unseen = unseen_causes(rows);
  diagnosis.figures = circle_figures(diagnosis.passes);
  diagnosis.both = bidirectional_figures(diagnosis.passes);
  return diagnosis;
}

void tell_turns(CircleDiagnosis& diagnosis, const sim::DriveDescription& model, const std::string& path) {
  if (model.name != "x" && model.name != "y")
    throw Failure(ExitCode::usage, fmt::format("{}: expected a model of axis x or y, not of \"{}\"", path, model.name));
  if (model.data.kind != sim::DriveKind::rotary) return;
  for (auto* const list : {&diagnosis.causes, &diagnosis.minor})
    for (CircleFinding& found : *list)
      if (found.cause.period_mm && found.cause.axis == model.name)
        found.period_turns = *found.cause.period_mm / (2.0 * std::numbers::pi * model.data.lead);
}

std::vector<double> share_along(const CircleFinding& finding, const CirclePass& pass) {
  std::vector<double> share;
  for (std::size_t k = 0; k < pass.t_s.size(); ++k) {
    double sum = 0.0;
    for (std::size_t c = 0; c < finding.cause.signatures.size(); ++c)
      sum += finding.factors(static_cast<Index>(c)) * finding.cause.signatures[c](pass, k);
    share.push_back(sum);
  }
  return share;
}

}  // namespace host
