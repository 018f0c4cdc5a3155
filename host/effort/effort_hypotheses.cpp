#include "host/effort/effort_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "host/dense_solutions.hpp"
#include "host/effort/effort_memory.hpp"
#include "host/effort/effort_waves.hpp"
#include "host/effort/second_mass_terms.hpp"
#include "host/infer/posterior.hpp"
#include "host/parallel.hpp"
#include "sim/second_mass.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Usual RMS of an effect over the rows: this part of the Coulomb level, times one of kTails. The prior has heavy
/// tails, since the weight of an arm can be fifty times usual cogging.
constexpr double kUsual = 0.3;
constexpr double kTails[] = {0.3, 1.0, 5.0, 25.0};
constexpr Index kTailCount = 4;
/// Prior standard deviation of a base parameter: about three times its least-squares value.
constexpr double kBaseKnownTo = 3.0;
/// Kinds whose approximate log evidence is this many nats below the best are not fitted, because e^-30 does not change
/// the odds.
constexpr double kOutOfReach = 30.0;
constexpr std::size_t kFormsFitted = 6;  // of each ranking
constexpr std::size_t kMostFitted = 8, kMostWavesWeighed = 24;
constexpr std::size_t kStarts = 4;  // starts from which the form of one kind is refined

double rms_of(const VectorXd& values) { return std::sqrt(values.squaredNorm() / static_cast<double>(values.size())); }

/// About a dozen parameters need no more rows, and the time grows with their number times the square of the memory's
/// columns.
constexpr std::size_t kMostRows = 2500;

/// A form of an effect before it is fitted.
struct Form {
  std::string kind;
  MatrixXd columns;  ///< each with RMS 1
  double log_unit;   ///< change of the log evidence by the unit of the residual (EffortTerm::acting)
  std::function<EffortTerm()> term;
  std::vector<int> sign;
  double log_prior = 0.0;  ///< log of its prior probability among all forms of its kind
};

struct Weighed {
  const Form* form;
  double scale;
  double log_gain;  ///< approximate gain of log evidence, including log_prior
};

/// The columns of a term, scaled to RMS 1; empty if one of them is zero.
std::optional<Form> form_of(std::string kind, const MatrixXd& columns, std::vector<int> sign, double acting,
                            std::function<EffortTerm()> term) {
  const double log_unit = static_cast<double>(columns.rows()) * std::log(acting);
  Form form{std::move(kind), columns, log_unit, std::move(term), std::move(sign)};
  for (Index c = 0; c < columns.cols(); ++c) {
    const double size = rms_of(columns.col(c));
    if (!(size > 0.0) || !std::isfinite(size)) return {};
    form.columns.col(c) /= size;
  }
  return form;
}

double log_unit(const std::vector<EffortTerm>& terms, const Evidence& evidence) {
  double sum = 0.0;
  for (const EffortTerm& term : terms) sum += std::log(term.acting);
  return static_cast<double>(evidence.rows().size()) * sum;
}

/// Whether the wave has at most a dozen periods over the travel, or at most four per turn.
bool is_slow(const Wave& wave, const EffortRows& rows, double turn) {
  constexpr double kMostWaves = 12.0, kMostOrders = 4.0;
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff();
  return wave.order * travel / wave.period <= kMostWaves || (wave.period == turn && wave.order <= kMostOrders);
}

/// The waves with the largest gain in plain least squares.
std::vector<std::size_t> most_promising(const std::vector<Wave>& waves, const WaveColumns& columns_of,
                                        const VectorXd& left) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t k = 0; k < waves.size(); ++k) {
    const MatrixXd columns = columns_of(waves[k]);
    const VectorXd pull = columns.transpose() * left;
    ranked.emplace_back(-pull.dot(symmetric_solution(gram(columns), pull)), k);
  }
  std::ranges::sort(ranked);
  ranked.resize(std::min(ranked.size(), kMostWavesWeighed));
  std::vector<std::size_t> best;
  for (const auto& [gain, wave] : ranked) best.push_back(wave);
  return best;
}

}  // namespace

EffortHypotheses::EffortHypotheses(const sim::DriveDescription& model, const EffortRows& rows,
                                   const std::vector<EffortTerm>& base, const VectorXd& explained, double coulomb,
                                   const std::vector<std::string>& absent)
    : model_(model),
      rows_(rows),
      thin_(thinned(rows, std::max<std::size_t>(1, (rows.size() + kMostRows / 2) / kMostRows))),
      second_masses_(second_mass_terms(model, rows, absent)),
      coulomb_(coulomb),
      evidence_(thin_.rows.effort, runs_of(thin_.rows), effort_memory(thin_.rows, thin_.of(explained), coulomb),
                std::max(rows.noise, 1e-9 * coulomb)) {
  const auto rows_count = static_cast<Index>(thin_.rows.size());
  base_.columns.resize(rows_count, 0);
  std::vector<double> deviations;
  const double size = rms_of(thin_.rows.effort);
  MatrixXd all(rows_count, 0);
  for (const EffortTerm& term : base) {
    if (!(term.columns.cwiseAbs().maxCoeff() > 0.0)) continue;  // the inertia is zero at steady speeds
    all.conservativeResize(Eigen::NoChange, all.cols() + term.columns.cols());
    all.rightCols(term.columns.cols()) = thin_.of(term.columns);
    deviations.resize(static_cast<std::size_t>(all.cols()), term.deviation);
  }
  const VectorXd factors = least_norm_solution(all, thin_.rows.effort);
  for (Index c = 0; c < all.cols(); ++c)
    if (double& deviation = deviations[static_cast<std::size_t>(c)]; !(deviation > 0.0))
      deviation = kBaseKnownTo * std::max(std::abs(factors(c)), 0.05 * size / std::max(rms_of(all.col(c)), 1e-300));
  base_.columns = all;
  base_.deviations = Eigen::Map<const VectorXd>(deviations.data(), static_cast<Index>(deviations.size()));
}

void EffortHypotheses::Known::add(const VectorXd& column, double deviation) {
  columns.conservativeResize(column.size(), columns.cols() + 1);
  columns.rightCols(1) = column;
  deviations.conservativeResize(columns.cols());
  deviations(columns.cols() - 1) = deviation;
}

EffortHypotheses::Known EffortHypotheses::known_with(const std::vector<EffortTerm>& chosen) const {
  Known known = base_;
  // Effects that were found have the widest prior.
  for (const EffortTerm& term : chosen) {
    const MatrixXd columns = thin_.of(term.columns);
    for (Index c = 0; c < columns.cols(); ++c)
      known.add(columns.col(c), kTails[kTailCount - 1] * kUsual * coulomb_ / std::max(rms_of(columns.col(c)), 1e-300));
  }
  return known;
}

NextEffects EffortHypotheses::next(const std::vector<EffortTerm>& chosen, const VectorXd& explained,
                                   const std::vector<std::string>& excluded, const PlainFit& plain_fit) const {
  sim::DriveDescription held = model_;
  for (const EffortTerm& term : chosen)
    if (held.find(term.kind) == nullptr) held.effects.push_back({term.kind, {}, {}, {}});
  const std::vector<EffortTerm> terms = shaped_terms(held, rows_, explained);
  const Known known = known_with(chosen);
  NextEffects found;
  found.fit = evidence_.fit(known.columns, known.deviations);
  constexpr int kAgain = 3;  // the iteration of the sizes may converge slowly
  for (int again = 0; again < kAgain; ++again) {
    EvidenceFit further = evidence_.fit_from(found.fit, known.columns, known.deviations);
    const double gained = further.log_evidence - found.fit.log_evidence;
    if (gained > 0.0) found.fit = std::move(further);
    if (gained < 0.1) break;
  }
  const EvidenceFit& now = found.fit;
  const EvidenceFit bare = evidence_.fit(known.columns, known.deviations,
                                         {.colour = now.colour, .sizes = evidence_.no_memory(), .hold_sizes = true});

  // All forms, grouped by kind.
  std::map<std::string, std::vector<Form>> forms;
  std::map<std::string, std::size_t> counts;
  const auto is_excluded = [&](const std::string& kind) { return std::ranges::find(excluded, kind) != excluded.end(); };
  const auto weigh = [&](const EffortTerm& term) {
    if (is_excluded(term.kind)) return;
    std::optional<Form> form =
        form_of(term.kind, thin_.of(term.columns), term.sign, term.acting, [&term] { return term; });
    ++counts[term.kind];
    if (form) forms[term.kind].push_back(*std::move(form));
  };
  std::ranges::for_each(terms, weigh);
  if (std::ranges::none_of(chosen, [](const EffortTerm& term) { return sim::is_second_mass(term.kind); }))
    std::ranges::for_each(second_masses_, weigh);
  for (auto& [kind, list] : forms)
    for (Form& form : list) form.log_prior = -std::log(static_cast<double>(counts[kind]));
  if (rows_.has_position) {
    const VectorXd one = VectorXd::Ones(rows_.w.size());
    const VectorXd direction = rows_.w.unaryExpr([](double w) { return w > 0.0 ? 1.0 : -1.0; });
    const VectorXd left = thin_.of(rows_.effort - explained);
    const double turn = model_.data.turn();
    const auto weigh_waves = [&](const std::string& kind, const std::vector<Wave>& waves, const WaveColumns& columns_of,
                                 const std::function<EffortTerm(const Wave&)>& term_of) {
      const std::vector<double> priors = log_priors(waves, model_.data);
      for (const std::size_t k : most_promising(waves, columns_of, left)) {
        std::optional<Form> form =
            form_of(kind, columns_of(waves[k]), {0, 0}, 1.0, [term_of, wave = waves[k]] { return term_of(wave); });
        if (!form) continue;
        form->log_prior = priors[k];
        forms[kind].push_back(*std::move(form));
      }
    };
    const auto slow_waves = [&](double longest) {
      std::vector<Wave> waves = waves_over(model_.data, rows_, longest);
      std::erase_if(waves, [&](const Wave& wave) { return !is_slow(wave, rows_, turn); });
      return waves;
    };
    if (!rows_.steady && !is_excluded(kNoName))
      weigh_waves(
          kNoName, slow_waves(1.0), [this](const Wave& wave) { return varying_inertia_columns(thin_.rows, wave); },
          [this](const Wave& wave) {
            return EffortTerm{kNoName,
                              varying_inertia_columns(rows_, wave),
                              {0, 0},
                              [](const VectorXd&, sim::DriveDescription&) { return true; },
                              {}};
          });
    for (const auto& [kind, weight, longest] : {std::tuple<std::string, const VectorXd*, double>{"cogging", &one, 1.0},
                                                {"torque_ripple", &explained, 1.0},
                                                {"position_dependent_friction", &direction, 2.0}}) {
      if (is_excluded(kind) || (kind == "position_dependent_friction" && held.find("coulomb") == nullptr)) continue;
      // Friction varies slowly along the travel, or with the pitch of the screw.
      const std::vector<Wave> waves =
          kind == "position_dependent_friction" ? slow_waves(longest) : waves_over(model_.data, rows_, longest);
      weigh_waves(
          kind, waves,
          [this, thin_weight = VectorXd(thin_.of(*weight))](const Wave& wave) {
            return wave_columns(thin_.rows, thin_weight, wave);
          },
          [this, kind = kind, weight = *weight](const Wave& wave) {
            return wave_term(
                model_, rows_, kind,
                [&rows = rows_, weight](const Wave& other) { return wave_columns(rows, weight, other); }, wave);
          });
    }
    // If the speed hardly changes, an encoder error and a torque along the travel have the same wave. An encoder error
    // of a disc has once per turn as its lowest order; a grating has many periods over the travel. So waves with a few
    // periods over the travel are not tried as encoder errors.
    const std::string misread = "encoder_cyclic_error";
    if (!rows_.steady && !rows_.by_speed && !is_excluded(misread)) {
      std::vector<Wave> waves = waves_over(model_.data, rows_, 1.0);
      std::erase_if(waves, [&](const Wave& wave) { return wave.period != turn && is_slow(wave, rows_, turn); });
      const auto columns_on = [&model = model_](const EffortRows& rows) {
        return [&model, &rows](const Wave& wave) { return encoder_error_columns(model, rows, wave); };
      };
      weigh_waves(misread, waves, columns_on(thin_.rows), [this, misread, columns_on](const Wave& wave) {
        return wave_term(model_, rows_, misread, columns_on(rows_), wave);
      });
    }
  }

  // Approximate evidence of every form at several sizes, with the present memory and without a memory.
  VectorXd scales(kTailCount);
  for (Index s = 0; s < kTailCount; ++s) scales(s) = kTails[s] * kUsual * coulomb_;
  struct Fitted {
    double log_odds, train;
    EffortTerm term;
  };
  struct Kind {
    std::string name;
    std::vector<Weighed> ranked[2];  ///< by gain with the present memory, and without a memory
    double best = -HUGE_VAL;
    std::vector<Fitted> fitted;
  };
  std::vector<Kind> kinds;
  std::mutex better;
  for (const auto& [name, list] : forms) kinds.push_back({name, {}, -HUGE_VAL, {}});
  for_each_in_parallel(kinds.size(), [&](std::size_t k) {
    Kind& kind = kinds[k];
    for (const bool without : {false, true}) {
      std::vector<Weighed>& ranked = kind.ranked[without ? 1 : 0];
      for (const Form& form : forms.at(kind.name)) {
        const VectorXd gains = evidence_.gains(without ? bare : now, form.columns, form.sign, scales);
        for (Index s = 0; s < kTailCount; ++s)
          if (std::isfinite(gains(s))) ranked.push_back({&form, scales(s), gains(s) + form.log_unit + form.log_prior});
      }
      std::ranges::stable_sort(ranked, std::greater(), &Weighed::log_gain);
      if (!ranked.empty()) kind.best = std::max(kind.best, ranked.front().log_gain);
    }
  });
  std::ranges::stable_sort(kinds, std::greater(), &Kind::best);
  std::size_t in_reach = kinds.size();
  while (in_reach > kMostFitted && kinds[in_reach - 1].best < kinds.front().best - kOutOfReach) --in_reach;

  // Fits the best forms of each kind in either ranking. The leaders come first. The fits of the others end early if the
  // best of their kind is out of reach; the margin covers changes in later rounds.
  struct Trial {
    std::size_t kind;
    const Weighed* weighed;
    double spread = 0.0;  ///< distance from the best form of its ranking, nats
  };
  std::vector<Trial> leaders, others;
  for (std::size_t k = 0; k < in_reach; ++k) {
    for (const std::vector<Weighed>& ranked : kinds[k].ranked) {
      std::vector<const Form*> of_ranking;
      for (const Weighed& weighed : ranked) {
        if (of_ranking.size() == kFormsFitted) break;
        if (std::ranges::find(of_ranking, weighed.form) != of_ranking.end()) continue;
        of_ranking.push_back(weighed.form);
        const bool leads = of_ranking.size() == 1;
        Trial trial{k, &weighed};
        if (leads) {
          std::vector<double> gains;
          for (const Weighed& other : ranked) gains.push_back(other.log_gain - weighed.log_gain);
          trial.spread = log_sum(gains);
        }
        const auto is_same = [&](const Trial& other) {
          return other.weighed->form == weighed.form && other.weighed->scale == weighed.scale;
        };
        const auto leader = std::ranges::find_if(leaders, is_same);
        if (leads && leader != leaders.end()) {
          leader->spread = std::max(leader->spread, trial.spread);
        } else if (leads) {
          leaders.push_back(trial);
        } else if (leader == leaders.end() && std::ranges::none_of(others, is_same)) {
          others.push_back(trial);
        }
      }
    }
  }
  const auto fit_trials = [&](const std::vector<Trial>& trials, const std::vector<double>& give_up) {
    std::vector<double> reached(in_reach, -HUGE_VAL);
    for_each_in_parallel(trials.size(), [&](std::size_t index) {
      const auto& [k, weighed, spread] = trials[index];
      const Index width = weighed->form->columns.cols();
      MatrixXd columns(known.columns.rows(), known.columns.cols() + width);
      columns << known.columns, weighed->form->columns;
      VectorXd deviations(known.deviations.size() + width);
      deviations << known.deviations, VectorXd::Constant(width, weighed->scale);
      const EvidenceFit fit = evidence_.fit_from(now, columns, deviations, give_up[k] - weighed->form->log_unit);
      for (Index c = 0; c < width; ++c)
        if (weighed->form->sign[static_cast<std::size_t>(c)] > 0 && fit.factors(known.columns.cols() + c) < 0.0) return;
      const double log_evidence = fit.log_evidence + weighed->form->log_unit;
      const double log_odds = log_evidence - now.log_evidence + spread + weighed->form->log_prior -
                              std::log(static_cast<double>(kTailCount));
      EffortTerm term = weighed->form->term();
      const std::optional<double> train = plain_fit(term);
      if (!train) return;
      const std::lock_guard lock(better);
      reached[k] = std::max(reached[k], log_evidence - 2.0 * kOutOfReach);
      kinds[k].fitted.push_back({log_odds, *train, std::move(term)});
    });
    return reached;
  };
  fit_trials(others, fit_trials(leaders, std::vector<double>(in_reach, -HUGE_VAL)));
  // Kinds that are out of reach are listed with their approximate gain.
  for (std::size_t k = in_reach; k < kinds.size(); ++k)
    for (const std::vector<Weighed>& ranked : kinds[k].ranked) {
      if (ranked.empty()) continue;
      const double log_odds = ranked.front().log_gain - std::log(static_cast<double>(kTailCount));
      kinds[k].fitted.push_back({log_odds, 1.0, ranked.front().form->term()});
    }
  std::erase_if(kinds, [](const Kind& kind) { return kind.fitted.empty(); });
  found.log_nothing = std::log(kNothingMore);
  for (Kind& kind : kinds) {
    std::vector<Fitted>& fitted = kind.fitted;
    std::ranges::stable_sort(fitted, std::greater(), &Fitted::log_odds);
    const double log_odds = fitted.front().log_odds;
    NextEffect effect{.term = std::move(fitted.front().term),
                      .others = {},
                      .log_odds = log_odds,
                      .log_weight = log_odds + std::log((1.0 - kNothingMore) / static_cast<double>(forms.size()))};
    std::ranges::stable_sort(fitted.begin() + 1, fitted.end(), {}, &Fitted::train);
    if (effect.term.neighbours)
      for (std::size_t other = 1; other < std::min(fitted.size(), kStarts); ++other)
        effect.others.push_back(std::move(fitted[other].term));
    found.effects.push_back(std::move(effect));
  }
  renew_probabilities(found);
  // Rounding errors must not decide between effects that are identical in these rows.
  std::ranges::sort(found.effects, {}, [](const NextEffect& effect) {
    constexpr double kSame = 1e-3;  // nats
    return std::pair(-std::round(effect.log_odds / kSame), effect.term.kind);
  });
  return found;
}

VectorXd EffortHypotheses::weights(const EvidenceFit& fit) const {
  return thin_.spread((fit.noise * fit.noise * fit.weights).cwiseMin(1.0), rows_.w.size());
}

double EffortHypotheses::log_evidence(const std::vector<EffortTerm>& chosen) const {
  const Known known = known_with(chosen);
  return evidence_.fit(known.columns, known.deviations).log_evidence + log_unit(chosen, evidence_);
}

double EffortHypotheses::memory_log_odds(const EvidenceFit& fit, const std::vector<EffortTerm>& chosen) const {
  const Known known = known_with(chosen);
  return fit.log_evidence - evidence_
                                .fit(known.columns, known.deviations,
                                     {.colour = fit.colour, .sizes = evidence_.no_memory(), .hold_sizes = true})
                                .log_evidence;
}

}  // namespace host
