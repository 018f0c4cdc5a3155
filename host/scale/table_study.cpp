#include "host/scale/table_study.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "host/dense_solutions.hpp"
#include "host/infer/posterior.hpp"
#include "host/parallel.hpp"
#include "host/report/progress.hpp"
#include "host/scale/drive_fit.hpp"
#include "host/scale/table_effect.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd without(const VectorXd& y, const MatrixXd& columns) { return y - columns * least_norm_solution(columns, y); }

/// Number of most promising forms of one kind that are fitted in full.
constexpr std::size_t kTableForms = 3;
/// Largest number of effects, and of cyclic errors. No machine has as many.
constexpr std::size_t kMostTableEffects = 8, kMostCyclic = 3;

/// The result of adding or removing one term.
struct TableFit {
  TableTerm term;
  double log_evidence = 0.0;  ///< averaged over the forms, nats
};

std::size_t count_of(const std::vector<TableTerm>& terms, std::string_view kind) {
  return static_cast<std::size_t>(std::ranges::count(terms, kind, &TableTerm::kind));
}

/// The drive that gap and spring have in common; null if the terms include neither.
const TableDrive* drive_of(const std::vector<TableTerm>& terms) {
  const auto driven = std::ranges::find_if(terms, &TableTerm::is_driven);
  return driven == terms.end() ? nullptr : &driven->drive;
}

class TableSearch {
 public:
  TableSearch(const sim::DriveDescription& model, TableRows& rows, double usual)
      : model_(model),
        rows_(rows),
        usual_(usual),
        base_(table_base(rows)),
        evidence_(rows.y, rows.runs, table_memory(rows, usual), rows.noise_um, NoiseKind::drift_and_white) {
    const sim::Drive drive(model);
    const double to_mm = model.data.kind == sim::DriveKind::linear ? 1e3 : drive.lead;
    if (drive.inertia > 0.0)
      deceleration_ = 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb) / drive.inertia * to_mm;
  }

  /// All terms fitted together.
  EvidenceFit fit(const std::vector<TableTerm>& terms) const {
    const auto [columns, deviations] = known(terms);
    return with_prior(evidence_.fit(columns, deviations), terms);
  }
  EvidenceFit fit_from(const EvidenceFit& before, const std::vector<TableTerm>& terms) const {
    const auto [columns, deviations] = known(terms);
    return with_prior(evidence_.fit_from(before, columns, deviations), terms);
  }

  /// Fits with the noise and memory of a similar fit as start values.
  EvidenceFit fit_beside(const EvidenceFit& near, const std::vector<TableTerm>& terms) const {
    const auto [columns, deviations] = known(terms);
    return with_prior(evidence_.fit(columns, deviations, {.colour = near.colour, .sizes = near.sizes}), terms);
  }

  /// Fits the slopes of the terms, which are the effects of changes of the sizes.
  EvidenceFit fit_slopes(const EvidenceFit& near, const std::vector<TableTerm>& terms) const {
    const auto [columns, deviations] = known(terms, true);
    return evidence_.fit(columns, deviations, {.colour = near.colour, .sizes = near.sizes, .hold_sizes = true});
  }

  bool can_show(std::string_view kind) const {
    return kind == "compliance" || kind == "backlash" || !table_forms(kind, rows_).empty();
  }

  /// The best form of a kind beside the chosen terms; the log evidence is averaged over all forms.
  std::optional<TableFit> best_form(std::string_view kind, const std::vector<TableTerm>& chosen,
                                    const EvidenceFit& before) const {
    if (kind == "compliance" || kind == "backlash") return best_driven(kind, chosen, before);
    const std::vector<TableTerm> forms = table_forms(kind, rows_);
    if (forms.empty()) return {};
    std::vector<double> gains(forms.size(), -HUGE_VAL);
    for_each_in_parallel(forms.size(), [&](std::size_t f) {
      MatrixXd columns = forms[f].quick_columns(rows_);
      const VectorXd deviations = forms[f].deviations(columns, usual_);
      if (!(columns.cwiseAbs().maxCoeff() > 1e-9)) return;
      columns *= deviations.asDiagonal();
      std::vector<int> sign(static_cast<std::size_t>(columns.cols()), 0);
      sign.front() = forms[f].sign();
      gains[f] = evidence_.gains(before, columns, sign, VectorXd::Ones(1))(0);
    });
    std::vector<std::size_t> order(forms.size());
    for (std::size_t f = 0; f < order.size(); ++f) order[f] = f;
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t f) { return gains[f]; });
    if (!std::isfinite(gains[order.front()])) return {};
    std::vector<TableTerm> best;
    EvidenceFit best_fit;
    for (std::size_t k = 0; k < std::min(kTableForms, order.size()) && std::isfinite(gains[order[k]]); ++k) {
      std::vector<TableTerm> all = chosen;
      all.push_back(forms[order[k]]);
      EvidenceFit fit = fit_from(before, all);
      if ((!best.empty() && fit.log_evidence <= best_fit.log_evidence) || wrong_way(all, fit)) continue;
      best = std::move(all);
      best_fit = std::move(fit);
    }
    if (best.empty()) return {};
    refine(best, best_fit);
    if (rms_of_last(best, best_fit) < rows_.step_um / std::sqrt(12.0)) return {};
    const double spread = log_sum(gains) - gains[order.front()] - std::log(static_cast<double>(forms.size()));
    return TableFit{best.back(), best_fit.log_evidence + std::min(spread, 0.0)};
  }

  /// Changes the nonlinear parameters of the last term to maximise the evidence.
  void refine(std::vector<TableTerm>& terms, EvidenceFit& fit) const {
    TableTerm& term = terms.back();
    if (term.is_driven()) {
      settle_drive(terms, while_unknown(fit.colour), {term.drive});
      fit = fit_beside(fit, terms);
    } else if (term.kind == "encoder_cyclic_error" || (term.kind == "thermal_growth" && term.shape[0] > 0.0)) {
      const double travel = rows_.x.maxCoeff() - rows_.x.minCoeff();
      double step = term.kind == "thermal_growth" ? 0.5 : 0.1 * term.shape[0] / travel;  // relative
      for (int round = 0; round < 6; ++round, step *= 0.5)
        for (const double way : {1.0 + step, 1.0 / (1.0 + step)}) {
          std::vector<TableTerm> moved = terms;
          moved.back().shape[0] *= way;
          EvidenceFit again = fit_beside(fit, moved);
          if (again.log_evidence <= fit.log_evidence) continue;
          terms = std::move(moved);
          fit = std::move(again);
          break;
        }
    }
  }

  /// Gives all driven terms the drive that is most probable beside the other terms.
  void settle_drive(std::vector<TableTerm>& terms, const NoiseColour& colour, std::vector<TableDrive> starts) const {
    std::vector<TableTerm> others = terms;
    std::erase_if(others, [](const TableTerm& term) { return term.is_driven(); });
    const TableDrive drive = fit_drive(std::move(starts), rows_, evidence_, known(others).first, colour, deceleration_);
    for (TableTerm& term : terms)
      if (term.is_driven()) term.drive = drive;
  }

  /// Fits the drive again when all terms are known and the noise is their residual. A table keeps the error with which
  /// it comes to rest, so the rows of one rest are a single observation. Changes nothing if no term is driven.
  void settle_drive_last(std::vector<TableTerm>& terms, EvidenceFit& fit) const {
    if (const TableDrive* drive = drive_of(terms)) {
      settle_drive(terms, fit.colour, drives_of_equal_loss(*drive));
      fit = fit_beside(fit, terms);
    }
  }

  /// Fits the drive from all starts, after a gap or a spring was added or removed.
  void settle_drive_anew(std::vector<TableTerm>& terms, const NoiseColour& colour) const {
    const bool gap = count_of(terms, "backlash") > 0, spring = count_of(terms, "compliance") > 0;
    if (gap || spring) settle_drive(terms, while_unknown(colour), drive_starts(gap, spring, rows_, deceleration_));
  }

  double late_s(const EvidenceFit& fit) const { return -1e-3 * fit.factors(base_.cols() - 1); }

  /// Corrects the motion of the motor for the encoder errors among the terms, and notes the delay of the table's
  /// reading.
  void note_motor(const std::vector<TableTerm>& terms, const EvidenceFit& fit) {
    for (TableRecord& one : rows_.records) one.pusher = one.motor;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (terms[k].kind != "encoder_cyclic_error" || place_of(terms[k], rows_, model_) != "motor") continue;
      const VectorXd factors = fit.factors.segment(first_column(terms, k), 2);
      for (TableRecord& one : rows_.records)
        for (std::size_t sample = 0; sample < one.x.size(); ++sample) {
          const double at = 2.0 * std::numbers::pi * one.x[sample] / terms[k].shape[0];
          one.pusher[sample] += 1e-3 * (factors(0) * std::cos(at) + factors(1) * std::sin(at));
        }
    }
    rows_.differentiate_pusher();
    rows_.late_s = late_s(fit);
    base_ = table_base(rows_);
  }

  /// Index of the first column of a term.
  Index first_column(const std::vector<TableTerm>& terms, std::size_t which) const {
    Index first = base_.cols();
    for (std::size_t k = 0; k < which; ++k) first += terms[k].count(rows_);
    return first;
  }

  /// RMS of x2 - x that the last term explains, um; for a wave, including the part lost in the means of the rows. If it
  /// is smaller than the steps of the sensors, it is not an effect of the machine but a beat between the two grids.
  double rms_of_last(const std::vector<TableTerm>& terms, const EvidenceFit& fit) const {
    if (terms.back().kind == "encoder_cyclic_error") return fit.factors.tail(2).norm() / std::numbers::sqrt2;
    const MatrixXd own = terms.back().columns(rows_);
    return rms(without(own * fit.factors.tail(own.cols()), base_));
  }

  /// Before the other terms were known, a gap may have been taken for a spring, or a spring for a gap. Exchanges the
  /// last term if that is more probable; returns the probability of the exchanged one.
  std::optional<double> exchange_driven(std::vector<TableTerm>& terms, EvidenceFit& fit) const {
    std::vector<TableTerm> other = terms;
    other.back().kind = terms.back().kind == "backlash" ? "compliance" : "backlash";
    if (stands_in(model_, other.back().kind)) return {};
    settle_drive_anew(other, fit.colour);
    EvidenceFit again = fit_from(fit, other);
    refine(other, again);
    const double gain = again.log_evidence - fit.log_evidence;
    if (!(gain > 0.0) || wrong_way(other, again)) return {};
    terms = std::move(other);
    fit = std::move(again);
    return logistic(gain);
  }

  /// Covariance of all factors, for the intervals of the sizes.
  MatrixXd covariance_of(const std::vector<TableTerm>& terms, const EvidenceFit& fit) const {
    return factor_covariance(fit_slopes(fit, terms), base_.cols(), terms, rows_, usual_);
  }

  bool wrong_way(const std::vector<TableTerm>& terms, const EvidenceFit& fit) const {
    for (std::size_t k = 0; k < terms.size(); ++k)
      if (terms[k].sign() > 0 && fit.factors(first_column(terms, k)) < 0.0) return true;
    return false;
  }

 private:
  /// Bound for the correlation of the noise. More correlation comes from effects that no term explains yet, and does
  /// not show how sharp a reversal is.
  static NoiseColour while_unknown(const NoiseColour& colour) {
    constexpr double kMostAlike = 0.2;
    return {.drift = std::min(colour.from_row_to_row(), kMostAlike)};
  }

  /// The best fit with a gap or a spring added; if the other one is among the chosen terms, both share one drive.
  std::optional<TableFit> best_driven(std::string_view kind, const std::vector<TableTerm>& chosen,
                                      const EvidenceFit& before) const {
    std::vector<TableTerm> all = chosen;
    all.push_back({std::string(kind), {}, {}, deceleration_});
    settle_drive_anew(all, before.colour);
    EvidenceFit fit = fit_from(before, all);
    refine(all, fit);
    if (wrong_way(all, fit) || rms_of_last(all, fit) < rows_.step_um / std::sqrt(12.0)) return {};
    return TableFit{all.back(), fit.log_evidence};
  }

  /// The columns give the probability of a change of the drive; this adds the prior probability of the drive itself.
  EvidenceFit with_prior(EvidenceFit fit, const std::vector<TableTerm>& terms) const {
    if (const TableDrive* drive = drive_of(terms))
      fit.log_evidence -= 0.5 * prior_cost(*drive, shape_ranges(*drive, deceleration_));
    return fit;
  }

  std::pair<MatrixXd, VectorXd> known(const std::vector<TableTerm>& terms, bool slopes = false) const {
    MatrixXd columns = base_;
    VectorXd deviations(base_.cols());
    constexpr double kWide = 10.0;  // offsets and delays have a wide prior
    for (Index c = 0; c < base_.cols(); ++c) deviations(c) = kWide * usual_ / std::max(rms(base_.col(c)), 1e-12);
    for (const TableTerm& term : terms) {
      const MatrixXd own = slopes ? term.slopes(rows_) : term.columns(rows_);
      const VectorXd known_to = term.deviations(own, usual_);
      columns.conservativeResize(Eigen::NoChange, columns.cols() + own.cols());
      columns.rightCols(own.cols()) = own;
      deviations.conservativeResize(columns.cols());
      deviations.tail(own.cols()) = known_to;
    }
    return {std::move(columns), std::move(deviations)};
  }

  const sim::DriveDescription& model_;
  TableRows& rows_;
  double usual_;
  MatrixXd base_;
  Evidence evidence_;
  double deceleration_ = 0.0;
};

/// Residual of the rows for terms with these factors. The base is fitted again.
VectorXd left_on(const TableRows& rows, const std::vector<TableTerm>& terms, const VectorXd& factors, Index base) {
  VectorXd left = rows.y;
  Index first = base;
  for (const TableTerm& term : terms) {
    const MatrixXd columns = term.columns(rows);
    left -= columns * factors.segment(first, columns.cols());
    first += columns.cols();
  }
  return without(left, table_base(rows));
}

}  // namespace

const TableEffect* TableStudy::find(std::string_view kind) const {
  for (const TableEffect& effect : effects)
    if (effect.group.size() == 1 && effect.kind() == kind) return &effect;
  return nullptr;
}

std::optional<double> TableStudy::probability(std::string_view kind) const {
  if (find(kind) != nullptr) return find(kind)->probability;
  for (const auto& [name, odds] : absent_odds)
    if (name == kind) return odds;
  return {};
}

TableStudy study_table(const sim::DriveDescription& model, const std::vector<const Record*>& records) {
  TableStudy study;
  study.rows = table_rows(records, model);
  if (study.empty() || !(study.rows.way.minCoeff() < study.rows.way.maxCoeff())) return {};
  take_out_known(model, study.rows);
  study.noise_um = study.rows.noise_um;
  const double usual = std::max(rms(without(study.rows.y, table_base(study.rows))), study.noise_um);
  TableSearch search(model, study.rows, usual);
  const Index base = table_base(study.rows).cols();

  std::vector<TableTerm> chosen;
  std::vector<std::vector<std::string>> groups;
  std::vector<double> odds;
  search.note_motor(chosen, search.fit(chosen));
  EvidenceFit fit = search.fit(chosen);
  Progress progress("measuring the table against the motor", std::size(kTableKinds));
  while (chosen.size() < kMostTableEffects) {
    if (!chosen.empty()) progress.add_steps(std::size(kTableKinds));
    std::vector<TableFit> found;
    std::vector<std::pair<std::string, double>> denied;
    std::vector<double> logs = {std::log(kNothingMore) + fit.log_evidence};
    for (const std::string_view kind : kTableKinds) {
      progress.advance(1, kind);
      if (count_of(chosen, kind) >= (kind == "encoder_cyclic_error" ? kMostCyclic : 1) || stands_in(model, kind))
        continue;
      if (std::optional<TableFit> best = search.best_form(kind, chosen, fit)) {
        logs.push_back(std::log((1.0 - kNothingMore) / std::size(kTableKinds)) + best->log_evidence);
        found.push_back(*std::move(best));
      } else if (count_of(chosen, kind) == 0 && search.can_show(kind)) {
        denied.emplace_back(kind, 0.0);
      }
    }
    const std::vector<double> probable = posterior(logs);
    study.absent_odds = std::move(denied);
    std::vector<std::size_t> order(found.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      order[k] = k;
      if (count_of(chosen, found[k].term.kind) == 0)
        study.absent_odds.emplace_back(found[k].term.kind, probable[k + 1]);
    }
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t k) { return probable[k + 1]; });
    std::vector<std::string> group;
    double held = 0.0;
    constexpr std::size_t kMostAlike = 2;
    for (std::size_t k = 0; k < std::min(kMostAlike, order.size()) && held < kClaimed; ++k) {
      group.push_back(found[order[k]].term.kind);
      held += probable[order[k] + 1];
    }
    if (held < kClaimed) break;
    chosen.push_back(found[order.front()].term);
    if (chosen.back().is_driven())
      for (TableTerm& term : chosen)
        if (term.is_driven()) term.drive = chosen.back().drive;
    groups.push_back(std::move(group));
    odds.push_back(held);
    fit = search.fit_from(fit, chosen);
    // The first effects were found while the others were still unknown, so each is fitted again.
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      std::rotate(chosen.begin(), chosen.begin() + 1, chosen.end());
      std::rotate(groups.begin(), groups.begin() + 1, groups.end());
      std::rotate(odds.begin(), odds.begin() + 1, odds.end());
      fit = search.fit_from(fit, chosen);
      search.refine(chosen, fit);
      if (chosen.size() > 1 && chosen.back().is_driven() && std::ranges::count_if(chosen, &TableTerm::is_driven) == 1)
        if (const std::optional<double> probable_now = search.exchange_driven(chosen, fit)) {
          groups.back() = {chosen.back().kind};
          odds.back() = *probable_now;
        }
      search.note_motor(chosen, fit);
    }
  }
  fit = search.fit_from(fit, chosen);
  // Removes effects that are no longer needed beside the others or are too small, and repeats this after each removal.
  // An effect that is certain but too small to be named is set aside, because beside it another effect may also seem
  // too small that would explain its part as well.
  std::vector<std::vector<TableTerm>> others_of(chosen.size());
  std::vector<EvidenceFit> less_of(chosen.size());
  const auto left_without = [&](std::size_t k) {
    return rms(left_on(study.rows, others_of[k], less_of[k].factors, base));
  };
  const auto remove = [&](std::size_t k) {
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(k));
    odds.erase(odds.begin() + static_cast<std::ptrdiff_t>(k));
    chosen = others_of[k];
    fit = less_of[k];
  };
  const double before_um = rms(left_on(study.rows, {}, fit.factors, base));
  std::vector<TableEffect> small;
  for (bool settled = false; !settled;) {
    settled = true;
    for (std::size_t k = 0; settled && k < chosen.size(); ++k) {
      others_of[k] = chosen;
      others_of[k].erase(others_of[k].begin() + static_cast<std::ptrdiff_t>(k));
      if (chosen[k].is_driven()) search.settle_drive_anew(others_of[k], fit.colour);
      less_of[k] = search.fit(others_of[k]);
      const double prior = std::log((1.0 - kNothingMore) / std::size(kTableKinds) / kNothingMore);
      const double needed = logistic(fit.log_evidence - less_of[k].log_evidence + prior);
      settled = needed >= kClaimed && !search.wrong_way(chosen, fit);
      odds[k] = std::min(odds[k], needed);
      if (settled) continue;
      study.absent_odds.emplace_back(chosen[k].kind, needed);
      remove(k);
    }
    if (!settled || chosen.empty()) continue;
    const double left_um = rms(left_on(study.rows, chosen, fit.factors, base));
    std::size_t least = 0;
    for (std::size_t k = 1; k < chosen.size(); ++k)
      if (left_without(k) < left_without(least)) least = k;
    if (is_worth_naming(left_without(least), left_um, before_um)) continue;
    settled = false;
    small.push_back(table_effect(chosen[least], fit, search.covariance_of(chosen, fit),
                                 search.first_column(chosen, least), study.rows, model));
    small.back().group = {chosen[least].kind};
    small.back().probability = odds[least];
    small.back().before = left_without(least);
    small.back().after = left_um;
    remove(least);
  }
  search.settle_drive_last(chosen, fit);
  study.delay_s = search.late_s(fit);
  search.note_motor(chosen, fit);
  const MatrixXd covariance = search.covariance_of(chosen, fit);
  study.left = left_on(study.rows, chosen, fit.factors, base);
  study.left_um = rms(study.left);
  study.before_um = rms(left_on(study.rows, {}, fit.factors, base));
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    TableEffect effect = table_effect(chosen[k], fit, covariance, search.first_column(chosen, k), study.rows, model);
    // A kind that is itself in the model is not an alternative name for this effect.
    for (const std::string& kind : groups[k])
      if (kind == chosen[k].kind || count_of(chosen, kind) == 0) effect.group.push_back(kind);
    effect.probability = odds[k];
    effect.before = left_without(k);
    effect.after = study.left_um;
    effect.worth_naming = true;
    study.effects.push_back(std::move(effect));
  }
  std::ranges::move(small, std::back_inserter(study.effects));
  return study;
}

}  // namespace host
